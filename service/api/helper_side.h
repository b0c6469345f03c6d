// The child's side of the helpers: reads lines, answers each with a line of JSON. A fault is
// {"error": {"code": 65, "where": "/lights/0", "message": "..."}}.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

// Each line a scenario: {"name", "seed", "hash", "variants", "lights", "techniques", "notes", "estimate"}; of one that
// is wrong {"faults": [{"code", "where", "message"}, ...]}.
void examine_lines(const std::vector<std::filesystem::path>& data, std::istream& in, std::ostream& out);

// The first line a scenario, without an answer of its own, each further one "X Y": bench::PixelCurves of that pixel.
void curve_lines(const std::vector<std::filesystem::path>& data, const std::string& light, std::size_t variant,
                 std::istream& in, std::ostream& out);

}  // namespace shadowbench::service

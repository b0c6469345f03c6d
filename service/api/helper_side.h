// The helper process's side: it reads lines and answers each with a line of JSON. The answer to a line that fails is
// {"error": {"code": 65, "where": "/lights/0", "message": "..."}}. Answers name no folder of the server.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::service {

// Each line is a scenario or, to check a recommendation, a scenario, a tab and a recommend::Request as JSON. JSON on
// one line has no tabs. The answer is {"name", "seed", "hash", "variants", "lights", "techniques", "notes",
// "estimate"}, or {"faults": [{"code", "where", "message"}, ...]} for a wrong scenario.
// Faults of a request have places in "/recommend".
// A line of files_mark and a request is answered with the scenario_around() these data files (new_files.h).
inline constexpr std::string_view files_mark = "files\t";
// `pace`: bench::measure_pace(), by which the seconds of estimates are multiplied. The server measures it once, so that
// every process of it gives the same estimate.
void examine_lines(const std::vector<std::filesystem::path>& data, double pace, std::istream& in, std::ostream& out);

// The first line is a scenario and gets no answer. Each further line is "X Y"; its answer is the bench::PixelCurves of
// that pixel.
void curve_lines(const std::vector<std::filesystem::path>& data, const std::string& light, std::size_t variant,
                 std::istream& in, std::ostream& out);

}  // namespace shadowbench::service

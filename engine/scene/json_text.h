// JSON as people write it.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::scene {

// With a space after every colon and comma. Bytes that are not UTF-8 become U+FFFD.
std::string in_one_line(const nlohmann::ordered_json& value);

// The same, but objects and arrays that would make a line longer than 100 have a line for each member.
std::string in_lines(const nlohmann::ordered_json& value);

}  // namespace shadowbench::scene

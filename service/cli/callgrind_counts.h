// What callgrind counted for a program that dumps its counts under names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace shadowbench::service {

// Reads the dumps <prefix>.1, <prefix>.2, ... that client requests with a name caused: the name -> instructions. Throws
// base::Error{bad_input}, place the file, for one that is no such dump.
std::map<std::string, std::uint64_t> callgrind_counts(const std::filesystem::path& prefix);

}  // namespace shadowbench::service

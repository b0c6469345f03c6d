// Reads the instruction counts that callgrind dumped for a program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace shadowbench::service {

// Reads the dumps <prefix>.1, <prefix>.2, ..., each caused by a client request with a name: name -> instructions.
// Throws base::Error{bad_input}, place the file, for a file that is not such a dump.
std::map<std::string, std::uint64_t> callgrind_counts(const std::filesystem::path& prefix);

}  // namespace shadowbench::service

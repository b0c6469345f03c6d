// Copies and checks a state folder. A server may be using it meanwhile.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace shadowbench::service {

// Copies the jobs and their results at one moment to a new folder, which a server can use as its state folder. Jobs
// that ran at that moment wait in the copy. The folder appears complete or not at all. Returns the number of jobs.
// Throws Error{usage} where `to` is neither new nor empty, or an interrupted back-up stands beside it; Error{io}.
std::size_t back_up(const std::filesystem::path& state, const std::filesystem::path& to);

// Compares the database with the folders of results, and both with their checksums: a line for each fault. Changes
// nothing, and needs no room on the disk. Of a database that cannot be read one line says so, and the results are
// checked. Throws Error{io} where there is none.
std::vector<std::string> check_state(const std::filesystem::path& state);

}  // namespace shadowbench::service

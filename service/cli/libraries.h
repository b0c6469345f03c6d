// The libraries of techniques that a command loads.
#pragma once

#include <string>
#include <vector>

#include "results/result.h"
#include "service/cli/commands.h"

namespace shadowbench::service {

// Adds their techniques to the registry; one that is there is not read again. A library that cannot be used gets a row
// that fails with the reason. `memory_limit`: GiB that a process of its own may reserve, at least 1; 0: no limit beyond
// that of this process. Throws Error: no_such_file or io; bad_input if not even such a row can be made.
void load_libraries(const LibraryArguments& libraries, double memory_limit = 0.0);

// The shared libraries of a folder, by name. Throws Error{no_such_file}.
std::vector<std::string> libraries_in(const std::string& folder);

// Of all that are loaded; empty: none is.
std::string hash_of_libraries();

// The options that load the same again, wherever the command runs.
std::vector<std::string> library_arguments(const LibraryArguments& libraries);

struct UnusableLibrary {
    std::string file, reason;
};

// Takes out the libraries, loaded before, whose row fails with a reason, and notes them as unusable: a process that
// gets library_arguments() then makes the same row without opening the file, which may take as long as it wants.
std::vector<UnusableLibrary> part_unusable(LibraryArguments& libraries);

// Whether every technique of a result came from where the registry has it now.
bool same_libraries(const results::Result& result);

}  // namespace shadowbench::service

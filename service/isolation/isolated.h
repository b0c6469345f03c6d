// Techniques from outside whose maps live in processes of their own, so that what such a technique does wrong, even a
// crash or an endless loop, is a fault of its map. The lines of memory that a lookup reads cannot be seen from here, so
// lookups are timed without a floor.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "techniques/external/library.h"

namespace shadowbench::service {

struct IsolationOptions {
    std::string program;         // this one, which runs `technique-host FILE HASH`
    double call_seconds = 60.0;  // that one call may take
    std::size_t memory = 0;      // bytes that a process may reserve, for itself and its map; 0: no limit
};

// As techniques::open_library(), in another process. Later processes refuse the file if it has changed since.
techniques::OpenLibrary open_isolated(const std::filesystem::path& file, const IsolationOptions& options);

}  // namespace shadowbench::service

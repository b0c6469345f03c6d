// Scenarios around data files, as `new` makes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/data_file.h"

namespace shadowbench::service {

// The types of techniques that fit what the files hold. For opaque surfaces, those that count a single surface at its
// own depth. For others, those whose promises are not for opaque scenes only and that do not approximate.
std::vector<std::string_view> fitting_techniques(std::span<const scene::DataFile> files);

struct NamedFile {
    std::string name;  // as scenarios name it: from its data folder
    std::uint64_t bytes = 0;
};

struct DataFiles {
    std::vector<NamedFile> files;  // by name
    bool more = false;             // there are more than are listed, or than were looked at
};

// The files of the folders, and of the folders in them, that `new` reads. Names that are not UTF-8 and files outside
// the folders, to which a link leads, are left out, and so is the folder `apart`, such as the server's state.
DataFiles data_files(const std::vector<std::filesystem::path>& folders, std::size_t most,
                     const std::filesystem::path& apart = {});

// `request`: {"files": [NAME, ...], "up": "y" or "z"}, of which only files are required. The scenario around these
// files of the folders, as JSON on one line. Throws Error: bad_input, with the place in the request or the file; and as
// read_data_file() and new_scenario() do.
std::string scenario_around(const std::string& request, const std::vector<std::filesystem::path>& folders);

}  // namespace shadowbench::service

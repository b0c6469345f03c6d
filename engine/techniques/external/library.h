// Opens a shared library of techniques: shadowbench_technique.h.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "techniques/external/description.h"

namespace shadowbench::techniques {

struct OpenLibrary {
    Library library;
    std::vector<Outside> techniques;  // called in this process
};

// The name and the hash of a file. Throws Error: no_such_file or io.
Library identify(const std::filesystem::path& file);

// Opens it for the rest of the process. Throws Error, place `file`: no_such_file or io; bad_input, with the reason, for
// a file that is no library of techniques of this version, or that describes one in a way that no row can have.
OpenLibrary open_library(const std::filesystem::path& file);

// The id of the row that stands for a library that cannot be used: the name of its file without "lib" and endings, in
// the letters of an id.
std::string id_of_file(const std::filesystem::path& file);

}  // namespace shadowbench::techniques

// Adds the techniques of a library to the registry.
#pragma once

#include <filesystem>
#include <functional>

#include "techniques/external/library.h"

namespace shadowbench::techniques {

// Opens a library, as open_library() does.
using Opener = std::function<OpenLibrary(const std::filesystem::path& file)>;

// Adds a row for each technique; none if the registry has those of this file. A library that `open` refuses, or whose
// technique has an id of the registry, gets one row that fails with the reason: see make_broken_row(). Throws Error,
// place `file`: no_such_file or io; bad_input with the reason if that row's id, of the file's name, is taken too.
void load_library(const std::filesystem::path& file, const Opener& open = open_library);

}  // namespace shadowbench::techniques

// A whole file, as text.
#pragma once

#include <filesystem>
#include <string>

namespace shadowbench::base {

// Pipes too. Throws Error, place the file: no_such_file, io (a folder, no permission, a failed read).
std::string read_text(const std::filesystem::path& file);

}  // namespace shadowbench::base

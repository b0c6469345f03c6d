// A whole file.
#pragma once

#include <filesystem>
#include <string>

namespace shadowbench::base {

// Pipes too. Throws Error, place the file: no_such_file, io (a folder, no permission, a failed read).
std::string read_bytes(const std::filesystem::path& file);

// Without the byte-order mark of UTF-8; that of another encoding is bad_input.
std::string read_text(const std::filesystem::path& file);

}  // namespace shadowbench::base

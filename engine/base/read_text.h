// Reads a whole file.
#pragma once

#include <filesystem>
#include <string>

namespace shadowbench::base {

// Reads files and pipes. Throws Error, place the file: no_such_file, or io (a folder, no permission, a failed read).
std::string read_bytes(const std::filesystem::path& file);

// Drops the byte-order mark of UTF-8. The mark of UTF-16 or UTF-32 is bad_input.
std::string read_text(const std::filesystem::path& file);

}  // namespace shadowbench::base

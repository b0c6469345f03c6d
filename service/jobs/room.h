// Whether the server's storage takes what jobs write. Space that is free is no answer where there are quotas, or where
// a file system has become read-only: only trying is.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shadowbench::service {

// The least that is asked for.
inline constexpr std::uintmax_t least_room = std::uintmax_t{64} << 10;

// Writes least_room bytes into a file of the folder that nobody sees, reserves `bytes` in all (where the file system
// can), puts them onto the disk and gives them back. A kill in between may leave a file whose name is_room_file()
// knows.
bool has_room(const std::filesystem::path& folder, std::uintmax_t bytes);
bool is_room_file(const std::filesystem::path& file);

// Bytes on the disk of all files in a folder, as far as they can be seen.
std::uintmax_t bytes_in(const std::filesystem::path& folder);

}  // namespace shadowbench::service

// Finds out whether the server can write to its storage. The free space does not show quotas or a file system that has
// become read-only, so it tries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace shadowbench::service {

// The least number of bytes that is tried.
inline constexpr std::uintmax_t least_room = std::uintmax_t{64} << 10;

// Whether `bytes` can be written to the folder: writes least_room bytes to an unlinked file, reserves the rest (where
// the file system can), syncs the file and frees it. A kill in between may leave a file, which is_room_file()
// recognises.
bool has_room(const std::filesystem::path& folder, std::uintmax_t bytes);
bool is_room_file(const std::filesystem::path& file);

// Free bytes of the file system of a folder; nothing where it does not say.
std::optional<std::uintmax_t> free_bytes(const std::filesystem::path& folder);

// Bytes on the disk of all readable files in a folder.
std::uintmax_t bytes_in(const std::filesystem::path& folder);

}  // namespace shadowbench::service

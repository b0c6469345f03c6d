// Where a glTF file says that its buffers and images are: in data URIs, or in files in its own folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::scene {

bool is_data_uri(std::string_view uri);

// The bytes of a data URI in base 64; absent if it is none or is damaged.
std::optional<std::vector<char>> data_of_uri(std::string_view uri);

// The file of a relative URI. Absolute names, names with "..", links out of the folder of `gltf`, and addresses in a
// network are bad input. Throws Error, place `where`.
std::filesystem::path file_of_uri(const std::filesystem::path& gltf, const std::string& uri, const std::string& where);

}  // namespace shadowbench::scene

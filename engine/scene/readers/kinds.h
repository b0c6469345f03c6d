// Tells apart the kinds of content that share an extension.
#pragma once

#include <filesystem>

namespace shadowbench::scene {

// Whether any part of an image that open_image() opens is deep. Throws what open_image() throws.
bool is_deep_image(const std::filesystem::path& file);

// Whether the header of a .dds file says that it is a volume texture. Throws Error: no_such_file, io, or bad_input if
// the file ends before its header does.
bool is_dds_volume(const std::filesystem::path& file);

// Whether the header of a .ply file states vertices, but neither faces nor triangle strips. False for what is no PLY
// file, and for a file that cannot be read.
bool is_point_cloud(const std::filesystem::path& file);

}  // namespace shadowbench::scene

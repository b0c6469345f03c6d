// All that the program does with OpenImageIO, as the functions of a shared library that is opened when the first of
// them is called. Debian's OpenImageIO depends on some 240 libraries (OpenCV, FFmpeg, GDAL): to load them takes 0.3 s
// and 100 MiB, which every command and every job of a server would pay.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/deep_samples.h"
#include "render/image.h"
#include "results/program.h"
#include "scene/readers/files.h"
#include "scene/readers/kinds.h"

namespace shadowbench::service {

// The functions of the same names in scene/readers and render, which say what they do. They throw what those throw.
struct Images {
    results::Program build;  // of the library; another one's structs may differ
    bool (*is_deep_image)(const std::filesystem::path& file);
    scene::DeepImage (*read_deep_image)(const std::filesystem::path& file, const scene::DeepChoice& choice);
    scene::AlphaTexture (*read_alpha)(const std::filesystem::path& file);
    std::optional<scene::AlphaTexture> (*read_alpha_channel)(const std::filesystem::path& file);
    std::string (*encode_exr)(const render::Image& image);
    std::string (*encode_png)(const render::Image& image);
    std::vector<base::Vec3f> (*colour_map)(const std::vector<float>& values, int width, int height);
    void (*write_deep_exr)(const std::filesystem::path& file, int width, int height,
                           std::span<const render::DeepBlock> blocks, const std::string& text);
};

// What the library exports.
using ImagesOf = const Images*();
inline constexpr const char* images_symbol = "shadowbench_images";

// The library beside the program, or where it is installed. In a child of a server of the same build, on the same
// machine, the one that the server holds.
std::filesystem::path images_library();

// Holds the library's file open for the children of this process, so that they open the one that fits this program even
// when another one replaces it. Where there is no library, those who need it fail. From now on their errors name it
// without its folder, which clients of a server do not learn.
void hold_images();

}  // namespace shadowbench::service

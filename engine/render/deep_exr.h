// Deep samples -> a deep OpenEXR file.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "render/deep_samples.h"

namespace shadowbench::render {

// Writes an image of width x height pixels that the blocks cover, each once: all of the file, or nothing. Row y of the
// map is row y of the image. Channels, all float: Z and ZBack (planar depth from the light), A; of coloured samples
// also AR, AG and AB, each to be composited alone, and A is their mean for programs that see one alpha. `text` stands
// as the image's description. The same samples give the same bytes. Throws Error{io}.
void write_deep_exr(const std::filesystem::path& file, int width, int height, std::span<const DeepBlock> blocks,
                    const std::string& text);

}  // namespace shadowbench::render

// Writes deep samples as a deep OpenEXR file.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "render/deep_samples.h"

namespace shadowbench::render {

// Writes an image of width x height pixels, each covered by one block: the whole file or nothing. Row y of the map is
// row y of the image. The channels are floats: Z and ZBack (planar depth from the light) and A. Coloured samples also
// have AR, AG and AB, each to be composited separately; A is their mean, for programs that read one alpha. `text`
// becomes the image's description. The same samples give the same bytes. Throws Error{io}.
void write_deep_exr(const std::filesystem::path& file, int width, int height, std::span<const DeepBlock> blocks,
                    const std::string& text);

}  // namespace shadowbench::render

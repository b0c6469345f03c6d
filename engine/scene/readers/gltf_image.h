// The images of a glTF file, of which only alpha is read.
#pragma once

#include <cstddef>
#include <optional>

#include "scene/readers/gltf_model.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// Absent if the image has no alpha channel, so that it is opaque. Throws Error: no_such_file, io, bad_input.
std::optional<AlphaTexture> read_gltf_image(const GltfModel& model, std::size_t image);

}  // namespace shadowbench::scene

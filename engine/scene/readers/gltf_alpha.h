// The opacity of a glTF file's materials as the one alpha texture that a mesh has. Every material gets a part of it: as
// many texels of its own texture as its triangles reach, or one texel for a constant. glTF 2.0, section 3.9.4: OPAQUE
// is 1, BLEND the alpha of texture and factor, MASK 1 from a cutoff on and 0 below. The cutoff is applied to texels,
// before they are interpolated.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/readers/files.h"
#include "scene/readers/gltf_model.h"

namespace shadowbench::scene {

inline constexpr std::uint64_t most_gltf_texels = std::uint64_t{1} << 28;       // of all materials together
inline constexpr std::uint64_t most_gltf_image_bytes = std::uint64_t{1} << 32;  // of images in views, together
inline constexpr std::uint32_t no_material = 0xffffffff;

// `materials` has one entry for each triangle. The mesh has texture coordinates as glTF files do, (0, 0) at the top
// left of the image; afterwards they are as in a Mesh. Leaves the mesh without a texture if all of it is opaque.
void add_gltf_alpha(const GltfModel& model, const std::vector<std::uint32_t>& materials, MeshFile& file);

}  // namespace shadowbench::scene

// Reads the arrays of a glTF file. Nothing is allocated before the file is known to be long enough for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene/readers/gltf_model.h"

namespace shadowbench::scene {

// Elements without bytes, which are 0, at most.
inline constexpr std::uint64_t most_gltf_zeros = std::uint64_t{1} << 20;

// Throws Error{bad_input} if the file is too short for the elements, or too few of them have bytes.
void check_gltf_accessor(const GltfModel& model, std::size_t accessor);

// Three components, each finite and at most max_coordinate. Appends them.
void add_gltf_points(const GltfModel& model, std::size_t accessor, std::vector<base::Vec3f>& to);
// Two components, each finite.
std::vector<base::Vec2f> read_gltf_uvs(const GltfModel& model, std::size_t accessor);

// One component, a whole number that is not negative. Reads a block of them at a time: number 0, and going on, are
// cheap.
class GltfIndices {
public:
    // Keeps a reference to the model.
    GltfIndices(const GltfModel& model, std::size_t accessor);

    std::uint32_t operator[](std::uint64_t number);

private:
    void load(std::uint64_t first);

    const GltfModel& model_;
    std::size_t accessor_;
    std::uint32_t first_ = 0;
    std::uint64_t begin_ = 0;          // of those that are held
    std::vector<std::uint32_t> held_;  // all, if some are replaced by others
};

// All bytes of a view.
std::vector<char> read_gltf_view(const GltfModel& model, std::size_t view);

}  // namespace shadowbench::scene

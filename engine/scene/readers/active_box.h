// What a sparse grid gives to a dense one: two visitors of its tree.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "scene/readers/grid_axes.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// The box of the active voxels, and their number.
struct ActiveBox {
    std::array<std::int64_t, 3> lower, upper;  // both inclusive
    std::uint64_t count = 0;

    ActiveBox() {
        lower.fill(std::numeric_limits<std::int64_t>::max());
        upper.fill(std::numeric_limits<std::int64_t>::min());
    }
    void tile(const Vec3i& corner, std::int32_t side, float, bool active) {
        if (!active) return;
        count += static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side);
        for (std::size_t a = 0; a < 3; ++a) {
            const std::int64_t from = corner[static_cast<int>(a)];
            lower[a] = std::min(lower[a], from);
            upper[a] = std::max(upper[a], from + side - 1);
        }
    }

    double voxels() const {
        double product = 1.0;
        for (std::size_t a = 0; a < 3; ++a) product *= static_cast<double>(upper[a] - lower[a] + 1);
        return product;
    }
};

// Visits a tree in the same way, and writes the values inside a box to their places among the densities of that box.
struct BoxFilling {
    static constexpr std::int32_t leaf_side = 8;  // voxels

    const ActiveBox& box;
    const TurnedSteps steps;
    std::vector<float>& density;

    void tile(const Vec3i& corner, std::int32_t side, float value, bool) {
        fill(corner, side, [value](const Place&) { return value; });
    }
    // All values of a leaf, z fastest.
    void leaf(const Vec3i& corner, const float* values) {
        const Place first{corner.x - box.lower[0], corner.y - box.lower[1], corner.z - box.lower[2]};
        fill(corner, leaf_side, [&](const Place& at) {
            return values[((at[0] - first[0]) * leaf_side + at[1] - first[1]) * leaf_side + at[2] - first[2]];
        });
    }

private:
    using Place = std::array<std::int64_t, 3>;  // in the box

    template <class Value>
    void fill(const Vec3i& corner, std::int32_t side, const Value& value) {
        Place from{}, to{};
        for (std::size_t a = 0; a < 3; ++a) {
            const std::int64_t first = corner[static_cast<int>(a)];
            from[a] = std::max(first, box.lower[a]) - box.lower[a];
            to[a] = std::min(first + side - 1, box.upper[a]) - box.lower[a];
            if (from[a] > to[a]) return;
        }
        for (std::int64_t k = from[2]; k <= to[2]; ++k)
            for (std::int64_t j = from[1]; j <= to[1]; ++j)
                for (std::int64_t i = from[0]; i <= to[0]; ++i)
                    density[static_cast<std::size_t>(steps.first + i * steps.step[0] + j * steps.step[1] +
                                                     k * steps.step[2])] = value(Place{i, j, k});
    }
};

}  // namespace shadowbench::scene

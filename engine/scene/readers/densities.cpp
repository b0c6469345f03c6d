#include "scene/readers/densities.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace shadowbench::scene {

void clamp_negatives(std::vector<float>& density, ReadNotes& notes) {
    std::size_t count = 0;
    float least = 0.0f;
    for (float& value : density) {
        if (!(value < 0.0f)) continue;
        ++count;
        least = std::min(least, value);
        value = 0.0f;
    }
    if (count > 0)
        notes.lines.push_back(
            fmt::format("{} of {} densities are below 0, the least {}: taken as 0", count, density.size(), least));
}

std::string negative_refused(float density) {
    return fmt::format("the density {} is below 0, and \"negative\" is \"refuse\": \"clamp\" takes it as 0", density);
}

}  // namespace shadowbench::scene

#include "scene/readers/densities.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"

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

void check_densities(GridVolume& volume, Negative negative, const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& message) {
        throw base::Error(base::ErrorCode::bad_input, file.string(), message);
    };
    for (const float density : volume.density) {
        if (!(std::abs(density) <= static_cast<float>(max_coordinate)))
            refuse(fmt::format("the grid has the density {}, which is not a finite number of at most {}", density,
                               max_coordinate));
        if (density < 0.0f && negative == Negative::refuse) refuse(negative_refused(density));
    }
    clamp_negatives(volume.density, volume.notes);
}

std::string negative_refused(float density) {
    return fmt::format("the density {} is below 0, and \"negative\" is \"refuse\": \"clamp\" takes it as 0", density);
}

}  // namespace shadowbench::scene

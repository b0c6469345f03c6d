#include "scene/readers/pbrt_media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/densities.h"
#include "scene/readers/grid_axes.h"
#include "scene/readers/read_mesh.h"

namespace shadowbench::scene {
namespace {

// In nanometres: about where red, green and blue light is.
constexpr std::array wavelengths{610.0, 550.0, 465.0};

// Of pairs of a wavelength and a value: straight lines between them, and the outer values beyond.
double value_at(const PbrtStatement& statement, const std::vector<double>& pairs, double wavelength) {
    for (std::size_t i = 2; i < pairs.size(); i += 2)
        if (!(pairs[i] > pairs[i - 2])) statement.fail("the wavelengths of a spectrum do not grow");
    if (wavelength <= pairs[0]) return pairs[1];
    for (std::size_t i = 2; i < pairs.size(); i += 2)
        if (wavelength <= pairs[i])
            return std::lerp(pairs[i - 1], pairs[i + 1], (wavelength - pairs[i - 2]) / (pairs[i] - pairs[i - 2]));
    return pairs.back();
}

// Empty for a spectrum that is a name or a file.
std::optional<Vec3d> spectrum(const PbrtStatement& statement, std::string_view name, const Vec3d& otherwise) {
    const PbrtParameter* const given = statement.find(name);
    if (!given) return otherwise;
    const std::vector<double>& numbers = given->numbers;
    if (given->type == "blackbody" || !given->texts.empty()) return std::nullopt;
    Vec3d value;
    if (given->type == "spectrum" && numbers.size() >= 2 && numbers.size() % 2 == 0)
        for (int i = 0; i < 3; ++i) value[i] = value_at(statement, numbers, wavelengths[static_cast<std::size_t>(i)]);
    else if ((given->type == "rgb" || given->type == "color") && numbers.size() == 3)
        value = {numbers[0], numbers[1], numbers[2]};
    else if (given->type == "float" && numbers.size() == 1)
        value = Vec3d(numbers[0]);
    else
        statement.fail(fmt::format("\"{}\" is neither three numbers of rgb nor a spectrum of pairs", name));
    for (int i = 0; i < 3; ++i)
        if (!(value[i] >= 0.0 && value[i] <= max_coordinate))
            statement.fail(fmt::format("\"{}\" is {}, where 0 to {} are read", name, value[i], max_coordinate));
    return value;
}

Vec3d corner(const PbrtStatement& statement, const char* name, double otherwise) {
    const PbrtParameter* const given = statement.find(name);
    if (!given) return Vec3d(otherwise);
    if (given->numbers.size() != 3) statement.fail(fmt::format("\"{}\" needs three numbers", name));
    return {given->numbers[0], given->numbers[1], given->numbers[2]};
}

Vec3i grid_size(const PbrtStatement& statement, std::size_t values, std::uint64_t most_voxels) {
    Vec3i size;
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr std::array names{"nx", "ny", "nz"};
        const double side = statement.number(names[static_cast<std::size_t>(axis)], 1.0);
        if (!(side >= 1.0 && side <= 1e9) || side != std::floor(side))
            statement.fail(fmt::format("{} voxels along an axis", side));
        size[axis] = static_cast<int>(side);
        voxels *= side;
    }
    if (voxels > static_cast<double>(most_voxels))
        statement.fail(fmt::format("{} voxels; the limit of all media is {}", voxels, most_voxels));
    if (voxels != static_cast<double>(values))
        statement.fail(fmt::format("{} values of \"density\" for {} x {} x {} voxels", values, size.x, size.y, size.z));
    return size;
}

// Between the outer centres of its voxels and its faces, pbrt's grid falls to half its density. This one keeps it.
void read_grid(const PbrtStatement& statement, const Matrix& place, std::uint64_t most_voxels,
               PbrtMediumSource& medium) {
    const PbrtParameter* const density = statement.find("density");
    if (!density) statement.fail("a grid needs \"density\"");
    if (density->type != "float" || !density->texts.empty()) {
        medium.lost = "grids whose densities are colours or a texture";
        return;
    }
    const Vec3i size = grid_size(statement, density->numbers.size(), most_voxels);
    const Vec3d p0 = corner(statement, "p0", 0.0), p1 = corner(statement, "p1", 1.0);
    std::array<Vec3d, 3> steps;
    Vec3d first;
    for (int axis = 0; axis < 3; ++axis) {
        const double lower = std::min(p0[axis], p1[axis]), edge = (std::max(p0[axis], p1[axis]) - lower) / size[axis];
        Vec3d along(0, 0, 0);
        along[axis] = edge;
        first[axis] = lower + 0.5 * edge;
        const Vec3d step = transform_direction(place, along);
        steps[static_cast<std::size_t>(axis)] = step;
        if (!std::isfinite(step.length()) || !(step.length() > 0.0)) statement.fail("a grid's box has no volume");
    }
    const std::optional<GridAxes> axes = find_axes(steps, size);
    if (!axes) {
        medium.lost = "grids of media that are turned by other than right angles";
        return;
    }
    GridVolume volume;
    volume.size = turned(size, *axes);
    volume.density.resize(density->numbers.size());
    TurnedPlaces places(size, *axes);
    for (const double value : density->numbers) {
        const double scaled = value * medium.mean();
        if (!(std::abs(scaled) <= max_coordinate)) statement.fail(fmt::format("a density of {}", value));
        volume.density[places.next()] = static_cast<float>(scaled);
    }
    clamp_negatives(volume.density, volume.notes);
    set_box(volume, *axes, steps, transform_point(place, first));
    if (const std::optional<std::string> fault = box_fault(volume.lower, volume.upper)) statement.fail(*fault);
    volume.notes.lines.push_back("it fills its own box: the shapes whose inside it is do not cut it");
    medium.grid = std::move(volume);
}

}  // namespace

PbrtMediumSource read_pbrt_medium_source(const PbrtStatement& statement, const Matrix& place,
                                         std::uint64_t most_voxels) {
    PbrtMediumSource medium;
    medium.name = statement.texts[0];
    const std::string type = statement.text("type", "");
    const bool grid = type == "uniformgrid" || type == "heterogeneous";
    if (!grid && type != "homogeneous") {
        medium.lost = is_word(type) ? fmt::format("media of the type {}", type) : "media of another type";
        return medium;
    }
    const bool third = type == "heterogeneous";  // as version 3 of pbrt calls a grid
    const auto absorbed = spectrum(statement, "sigma_a", third ? Vec3d(0.0011, 0.0024, 0.014) : Vec3d(1.0));
    const auto scattered = spectrum(statement, "sigma_s", third ? Vec3d(2.55, 3.21, 3.77) : Vec3d(1.0));
    if (!absorbed || !scattered || statement.find("preset")) {
        medium.lost = "media whose extinction is the name of a spectrum or of a material";
        return medium;
    }
    const double scale = statement.number("scale", 1.0);
    medium.extinction = (*absorbed + *scattered) * scale;
    if (!(scale >= 0.0) || !(medium.mean() <= max_coordinate))
        statement.fail(fmt::format("a medium's \"scale\" of {}", scale));
    if (grid) read_grid(statement, place, most_voxels, medium);
    return medium;
}

}  // namespace shadowbench::scene

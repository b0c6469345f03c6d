// Readers of hair; errors as in files.h. Each says whether the file holds the width of its strands.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace shadowbench::scene {

// The lines between the points of a file that does not say: straight, or uniform cubic B-splines with these points as
// their control points.
enum class CurveBasis { linear, bspline };

struct HairFile {
    Hair hair;
    bool has_radii = false;  // in the file; without them, and without a radius given, all radii are 0
    std::vector<PassedOver> passed_over = {};
};

inline constexpr std::array<std::string_view, 4> hair_extensions{".tfx", ".hair", ".txt", ".pbrt"};

// Whether a file holds strands in the format of Mitsuba, rather than Cem Yuksel's. Throws what FileReader throws.
bool is_mitsuba_hair(const std::filesystem::path& file);

// Strands for Mitsuba. Text: a point a line, as x y z or, with its half-width, x y z radius; empty lines divide
// strands. Or the binary form of Mitsuba 0.6, without widths, which begins with BINARY_HAIR. `radius` > 0 overrides the
// file.
HairFile read_mitsuba_hair(const std::filesystem::path& file, float radius, CurveBasis basis = CurveBasis::linear);

// Chooses the format by the extension, one of hair_extensions, and the first bytes. `basis` is for is_mitsuba_hair().
HairFile read_strands(const std::filesystem::path& file, float radius, CurveBasis basis = CurveBasis::linear);

}  // namespace shadowbench::scene

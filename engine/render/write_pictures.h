// A rendering on disk, and for people.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "render/render.h"

namespace shadowbench::render {

// Grows when a name or meaning in images.json changes.
inline constexpr int images_schema_version = 1;

// What images.json holds: the camera, the reference, and of each technique its errors and the names of its files. The
// same rendering gives the same bytes.
nlohmann::ordered_json to_json(const Rendering& rendering);

// A line a technique: errors of the shaded picture and of the shadow component.
std::string to_table(const Rendering& rendering);

// Writes images.json and, as EXR (linear, half) and as PNG (sRGB), reference.shaded, reference.shadow and of every
// technique <label>.shaded, .shadow (average visibility), .difference (|shaded - reference| times four) and .heat
// (|shadow - reference| with its legend); light_<index>.through of every light. All or nothing. Throws Error{io}.
void write_pictures(const std::filesystem::path& folder, const Rendering& rendering);

}  // namespace shadowbench::render

// Writes a rendering to disk, and shows it as a table.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "render/render.h"

namespace shadowbench::render {

// Increased when a key of images.json changes its name or meaning.
inline constexpr int images_schema_version = 1;

// The content of images.json: the camera, the reference, and for each technique its errors and the names of its files.
// The same rendering gives the same bytes.
nlohmann::ordered_json to_json(const Rendering& rendering);

// One line per technique: errors of the shaded picture and of the shadow component.
std::string to_table(const Rendering& rendering);

// Writes images.json and pictures, each as EXR (linear, half) and PNG (sRGB): reference.shaded and reference.shadow;
// for every technique <label>.shaded, .shadow (average visibility), .difference (|shaded - reference| times four) and
// .heat
// (|shadow - reference| with its legend); light_<index>.through for every light. The PNG files of shaded pictures have
// the exposure of the reference, and grey where nothing is seen. All files or none. Throws Error{io}.
void write_pictures(const std::filesystem::path& folder, const Rendering& rendering);

}  // namespace shadowbench::render

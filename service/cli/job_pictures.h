// The pictures that come with a result: what render draws of the scenario's first variant.
#pragma once

#include <filesystem>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "bench/progress.h"
#include "bench/run.h"

namespace shadowbench::service {

// The folder of pictures in a folder of results.
std::filesystem::path pictures_folder(const std::filesystem::path& results);

// Whether the scene has objects for a camera to see; a deep image has none. Takes a document without sweeps.
bool has_view(const nlohmann::json& variant);

// Draws a scenario that was measured, and so is valid, into a folder. Returns the error that prevents only the
// pictures, such as an empty view or one that needs too much memory; then the folder is as before. Throws other errors.
std::optional<base::Error> draw_pictures(const nlohmann::json& document, const bench::RunOptions& run,
                                         const std::filesystem::path& folder, const bench::ProgressCallback& progress);

}  // namespace shadowbench::service

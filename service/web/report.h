// Writes a result as an offline page.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// A self-contained page of a result (result.json of `run`), with the pictures that images.json in the folder `images`
// lists, if `render` wrote one. Missing pictures are left out. Throws Error{bad_input} for an images.json that `render`
// did not write; io.
std::string report_html(const nlohmann::json& result, const std::filesystem::path& images);

}  // namespace shadowbench::service

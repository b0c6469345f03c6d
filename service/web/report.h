#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// A page of one result that needs no server: styles, scripts and pictures are in it. `images` is a folder that `render`
// wrote; it may be missing.
std::string report_html(const nlohmann::json& result, const std::filesystem::path& images);

}  // namespace shadowbench::service

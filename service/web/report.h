// A result as an offline page.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// A self-contained page of a result (result.json of `run`), with the pictures that images.json in `images` names, if
// that is there (what `render` writes). A picture that is missing is left out. Throws Error{bad_input}: images.json is
// no such file; io.
std::string report_html(const nlohmann::json& result, const std::filesystem::path& images);

}  // namespace shadowbench::service

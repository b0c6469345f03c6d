// Writes a page as one file that contains its scripts, styles and data and loads nothing. Internal to service/web.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// Text in which an HTML parser finds no tag and no end of an attribute.
std::string escaped_html(std::string_view text);

// The HTML. `script` is the path of an asset; it finds `data` as JSON in the element with the id "data".
std::string document(std::string_view title, std::string_view script, const nlohmann::json& data);

}  // namespace shadowbench::service

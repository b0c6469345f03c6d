#include "service/web/report.h"

#include <nlohmann/json.hpp>

namespace shadowbench::service {

std::string report_html(const nlohmann::json& result, const std::filesystem::path&) {
    std::string name;
    for (const char c : result.value("name", "")) name += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    return "<!doctype html><html lang=\"en\"><title>shadowbench</title><h1>" + name + "</h1></html>\n";
}

}  // namespace shadowbench::service

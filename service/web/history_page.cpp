#include "service/web/history_page.h"

#include <nlohmann/json.hpp>

#include "service/web/document.h"

namespace shadowbench::service {

std::string history_html(const nlohmann::json& history) {
    return document("History · shadowbench", "/assets/history.js", history);
}

}  // namespace shadowbench::service

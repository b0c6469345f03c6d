// Writes the history of many results as an offline page.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// A self-contained page of {"cells": [{"title", "measures": [{"name", "unit", "points": [{"run", "commit", "value",
// "low", "high"}], "drift": null | {"from", "to", "ratio", "since"}}]}], "runs": [{"started", "commit", "file"}]}.
// "run" and "since" are the times at which runs started.
std::string history_html(const nlohmann::json& history);

}  // namespace shadowbench::service

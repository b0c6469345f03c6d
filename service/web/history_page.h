// The history of many results as an offline page.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::service {

// A self-contained page of {"cells": [{"title", "measures": [{"name", "unit", "points": [{"run", "commit", "value",
// "low", "high"}], "drift": null | {"from", "to", "ratio", "since"}}]}], "runs": [{"started", "commit", "file"}]}; a
// run is named by when it started, "since" too.
std::string history_html(const nlohmann::json& history);

}  // namespace shadowbench::service

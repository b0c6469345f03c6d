// Checks what an exploration is asked against its scenario, before any work is done.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/run.h"
#include "recommend/request.h"
#include "scene/scene.h"

namespace shadowbench::recommend {

// The document without the sweeps over what is explored: the samples a pixel and the techniques.
nlohmann::json without_explored_sweeps(nlohmann::json document);

// The index of the light of this name or number; empty: the only one. Throws Error{usage}, place "--light".
std::size_t chosen_light(const std::vector<std::string>& lights, const std::string& name);

// Makes the checks that Trials makes before it works: the document and its files, the light and what it sees, and
// whether a technique can serve the scene. The seconds are those of the truth and the budget; the sides, samples and
// bytes are the scenario's own. Throws Error: bad_input, place: a JSON pointer into the document, or `where` and the
// pointer into the request from there; no_such_file, io.
bench::Validated check(const nlohmann::json& document, const bench::RunOptions& options, const Request& request,
                       const std::string& where);

}  // namespace shadowbench::recommend

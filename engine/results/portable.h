// What of a result holds on any machine: for baselines that are committed.
//
// Two runs of one build differ in times alone. Between machines, Embree differs too: it picks its code by the
// processor, and rounds differently. What a camera sees comes from it, so do the answers of shadow rays; all else is
// the same, but for the last bits of what the C library's functions of double precision give (errors agree to 1e-12).
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::results {

// Asks at probes where the document has a camera, and takes no more time than a run has to.
void make_portable_document(nlohmann::json& document);

// Removes times, machine and build, the comparison with Embree, the cells that store no function (their answers are
// Embree's), and what is large and says little. What is left has the form of a result.
void make_portable_result(nlohmann::ordered_json& result);

}  // namespace shadowbench::results

// Reduces a result to the values that every machine reproduces, for baselines that are committed.
//
// Two runs of one build differ only in times. Between machines, the answers of Embree differ too: it chooses its code
// by the processor, and rounds differently. Camera receivers and the answers of shadow rays come from Embree. All other
// values agree, except for the last bits of the C library's functions of double precision: errors agree to 1e-12.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::results {

// Replaces a camera by probe receivers, and asks for the shortest timing that a run accepts.
void make_portable_document(nlohmann::json& document);

// Removes times, machine and build, the comparison with Embree, the cells that store no function (Embree gives their
// answers), the marks of the bytes front and the node histograms. The rest has the form of a result.
void make_portable_result(nlohmann::ordered_json& result);

}  // namespace shadowbench::results

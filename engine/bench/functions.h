// Techniques held to given functions of depth: no scene, no light rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "curves/curve.h"
#include "document/technique_choice.h"
#include "results/result.h"

namespace shadowbench::bench {

struct FunctionTimes {
    results::Sample build_ns_per_vertex;  // one thread, the whole map, per vertex that goes in
    results::Sample lookup_random_ns, lookup_coherent_ns;
};

struct FunctionResult {
    std::string technique, parameters, parameters_json;
    std::uint64_t functions = 0, vertices_in = 0, nodes_out = 0;
    std::size_t bytes = 0;
    double error_max = 0.0, error_rms = 0.0;      // over the functions, of each one's largest error (exact)
    std::optional<double> tolerance;              // the promised largest error; nothing when none is promised
    std::optional<std::uint64_t> over_tolerance;  // functions whose error is larger
    double rise_max = 0.0, outside_max = 0.0;     // by how much functions rise with depth, and leave [0, 1], at most
    std::uint64_t broken = 0;                     // functions that do so though the technique promises that none does
    std::optional<FunctionTimes> times;           // nothing when a promise is broken
    std::vector<curves::Curve> stored;            // the functions as the technique holds them
};

// One map of all functions a technique, checked and then timed: repetitions interleaved. No function, or a technique
// that cannot take functions, is Error{bad_input} or {usage}.
std::vector<FunctionResult> measure_functions(std::span<const curves::Curve> functions,
                                              std::span<const document::TechniqueChoice> techniques, int repetitions);

nlohmann::ordered_json to_json(const FunctionResult& result);
std::string to_table(std::span<const FunctionResult> results);

}  // namespace shadowbench::bench

// Measures techniques on given functions of depth, without a scene or light rays.
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
    results::Sample build_ns_per_vertex;  // one thread, the whole map, per input vertex
    results::Sample lookup_random_ns, lookup_coherent_ns;
};

struct FunctionResult {
    std::string technique, parameters, parameters_json;
    std::uint64_t functions = 0, vertices_in = 0, nodes_out = 0;
    std::size_t bytes = 0;
    double error_max = 0.0, error_rms = 0.0;          // over the functions, of the largest error of each (exact)
    std::optional<double> tolerance;                  // the promised largest error; absent if none is promised
    std::optional<std::uint64_t> over_tolerance;      // functions whose error is larger
    std::optional<results::FewestNodes> over_fewest;  // absent without a tolerance
    double rise_max = 0.0, outside_max = 0.0;         // largest rise of a function with depth, and distance from [0, 1]
    std::uint64_t broken = 0;                         // functions that rise or leave [0, 1] against the promise
    std::optional<FunctionTimes> times;               // absent if a promise is broken
    std::vector<curves::Curve> stored;                // the functions as the technique holds them
};

// Builds one map of all functions for each technique, checks it, then times it; repetitions are interleaved. Throws
// Error{bad_input} if there is no function, and Error{usage} for a technique that cannot take functions.
std::vector<FunctionResult> measure_functions(std::span<const curves::Curve> functions,
                                              std::span<const document::TechniqueChoice> techniques, int repetitions);

nlohmann::ordered_json to_json(const FunctionResult& result);
std::string to_table(std::span<const FunctionResult> results);

}  // namespace shadowbench::bench

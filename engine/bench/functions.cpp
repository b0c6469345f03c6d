#include "bench/functions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "bench/clock.h"
#include "bench/node_ratio.h"
#include "curves/norms.h"

namespace shadowbench::bench {
namespace {

using base::Error;
using base::ErrorCode;
using curves::Curve;
using techniques::Map;
using techniques::Query;

constexpr double rounding = 1e-6;         // of stored floats
constexpr std::size_t lookups = 1 << 16;  // in one timed pass
constexpr double shortest_build = 0.002;  // seconds of a timed pass; shorter builds are repeated within it

std::unique_ptr<Map> build(const document::TechniqueChoice& technique, std::span<const Curve> functions) {
    return technique.row->from_curves(technique.values, functions);
}

// The layout of the map that from_curves makes.
rays::MapLayout layout_of(std::span<const Curve> functions) {
    rays::MapLayout layout;
    layout.width = static_cast<int>(functions.size());
    return layout;
}

std::vector<float> depths_of(const Curve& function) {
    std::vector<float> depths;
    for (const curves::Vertex& vertex : function) depths.push_back(vertex.z);
    return depths;
}

// The largest rise from any depth to a deeper one, and the largest distance from [0, 1]; infinite if a value is NaN.
struct Shape {
    double rise = 0.0, outside = 0.0;
};

Shape shape_of(const Curve& function) {
    Shape shape;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double least = infinity;
    for (const curves::Vertex& vertex : function) {
        const double value = vertex.value;
        if (std::isnan(value)) return {infinity, infinity};
        shape.rise = std::max(shape.rise, value - least);
        shape.outside = std::max({shape.outside, -value, value - 1.0});
        least = std::min(least, value);
    }
    return shape;
}

void check(const Map& map, const techniques::Promises& promises, std::span<const Curve> functions,
           FunctionResult& result) {
    std::vector<double> errors;
    std::uint64_t over = 0;
    for (std::size_t i = 0; i < functions.size(); ++i) {
        Curve& stored = result.stored.emplace_back();
        map.stored(static_cast<int>(i), 0, 0, depths_of(functions[i]), stored);
        errors.push_back(curves::distance(stored, functions[i], 0.0, 0.0).max);
        over += !(errors.back() <= result.tolerance.value_or(0.0) + rounding);
        const Shape shape = shape_of(stored);
        result.rise_max = std::max(result.rise_max, shape.rise);
        result.outside_max = std::max(result.outside_max, shape.outside);
        result.broken +=
            (promises.monotone && shape.rise > rounding) || (promises.unit_range && shape.outside > rounding);
    }
    const metrics::ErrorNorms norms = metrics::error_norms(errors);
    result.error_max = norms.max;
    result.error_rms = norms.rms;
    if (!result.tolerance) return;
    result.over_tolerance = over;
    NodesBesideFewest nodes;
    compare_nodes(functions, result.stored, *result.tolerance, nodes);
    result.over_fewest = over_fewest({&nodes, 1}, functions.size());
}

// Queries spread evenly over the functions, and in each over its depths and a little beyond, front to back.
std::vector<Query> coherent_queries(std::span<const Curve> functions) {
    const std::size_t per_function = (lookups + functions.size() - 1) / functions.size();
    std::vector<Query> queries;
    for (std::size_t i = 0; i < functions.size(); ++i) {
        const Curve& f = functions[i];
        const double low = f.empty() ? 0.0 : f.front().z, high = f.empty() ? 1.0 : f.back().z;
        const double margin = 0.05 * (high - low);
        for (std::size_t k = 0; k < per_function; ++k) {
            const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(per_function);
            const double z = low - margin + at * (high - low + 2.0 * margin);
            queries.push_back({static_cast<float>(i) + 0.5f, 0.5f, static_cast<float>(z), 1.0f});
        }
    }
    return queries;
}

void shuffle(std::vector<Query>& queries) {
    base::Random random(base::hash(queries.size()));
    for (std::size_t i = queries.size(); i > 1; --i) std::swap(queries[i - 1], queries[random.below(i)]);
}

double build_seconds(const document::TechniqueChoice& technique, std::span<const Curve> functions) {
    int builds = 0;
    double seconds = 0.0;
    do {
        const Stopwatch stopwatch;
        const std::unique_ptr<Map> map = build(technique, functions);
        seconds += stopwatch.seconds();
        ++builds;
    } while (seconds < shortest_build);
    return seconds / builds;
}

double lookup_ns(const Map& map, std::span<const Query> queries, std::vector<float>& out) {
    out.resize(queries.size());
    const Stopwatch stopwatch;
    map.lookup(queries, out);
    return 1e9 * stopwatch.seconds() / static_cast<double>(queries.size());
}

FunctionResult describe(const document::TechniqueChoice& technique, std::span<const Curve> functions, const Map& map) {
    FunctionResult result;
    result.technique = technique.row->id;
    result.parameters = techniques::to_string(technique.values, technique.row->parameters, false);
    result.parameters_json = techniques::to_json(technique.values).dump();
    result.functions = functions.size();
    for (const Curve& function : functions) result.vertices_in += function.size();
    result.nodes_out = map.nodes().total;
    result.bytes = map.bytes();
    const double bound = technique.row->error_bound(technique.values, layout_of(functions));
    if (std::isfinite(bound)) result.tolerance = bound;
    check(map, techniques::promises(*technique.row, technique.values), functions, result);
    return result;
}

struct Timed {
    std::size_t index;
    std::unique_ptr<Map> map;
    std::vector<double> build, random, coherent;
};

bool keeps_promises(const FunctionResult& result) {
    return result.broken == 0 && result.over_tolerance.value_or(0) == 0;
}

void time_all(std::span<const Curve> functions, std::span<const document::TechniqueChoice> techniques, int repetitions,
              std::vector<Timed>& timed) {
    const base::ThreadLimit one_thread(1);
    const std::vector<Query> coherent = coherent_queries(functions);
    std::vector<Query> random = coherent;
    shuffle(random);
    double vertices = 0.0;
    for (const Curve& function : functions) vertices += static_cast<double>(function.size());
    std::vector<float> out;
    const auto warm_ns = [&](const Map& map, std::span<const Query> queries) {
        lookup_ns(map, queries, out);  // untimed: the build has filled the cache
        return lookup_ns(map, queries, out);
    };
    for (int r = 0; r < repetitions; ++r)
        for (Timed& technique : timed) {
            technique.build.push_back(1e9 * build_seconds(techniques[technique.index], functions) /
                                      std::max(vertices, 1.0));
            technique.coherent.push_back(warm_ns(*technique.map, coherent));
            technique.random.push_back(warm_ns(*technique.map, random));
        }
}

}  // namespace

std::vector<FunctionResult> measure_functions(std::span<const Curve> functions,
                                              std::span<const document::TechniqueChoice> techniques, int repetitions) {
    if (functions.empty()) throw Error(ErrorCode::bad_input, "", "there are no functions");
    std::vector<FunctionResult> results;
    std::vector<Timed> timed;
    for (std::size_t i = 0; i < techniques.size(); ++i) {
        std::unique_ptr<Map> map = build(techniques[i], functions);
        results.push_back(describe(techniques[i], functions, *map));
        if (keeps_promises(results.back())) timed.push_back({i, std::move(map), {}, {}, {}});
    }
    time_all(functions, techniques, repetitions, timed);
    for (Timed& technique : timed)
        results[technique.index].times = FunctionTimes{results::summarise(std::move(technique.build)),
                                                       results::summarise(std::move(technique.random)),
                                                       results::summarise(std::move(technique.coherent))};
    return results;
}

}  // namespace shadowbench::bench

// Lokovic and Veach, Deep Shadow Maps, 2000: section 3.4, the searches of a function's segment.
#include "claims/lokovic_search.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/lookup_timing.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"
#include "curves/curve.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/footprint.h"
#include "techniques/deep/segment_search.h"

namespace shadowbench::claims::lokovic {
namespace {

// The functions of a map, laid out for all searches alike: each pixel has its pointer beside the place of its function.
struct Pixel {
    std::uint32_t begin, nodes;
    std::uint32_t last = 0;  // the segment used last
};
struct Functions {
    explicit Functions(const techniques::DeepLevel& level) : floats(level.floats) {
        for (std::size_t p = 0; p + 1 < level.offsets.size(); ++p) pixels.push_back({level.offsets[p], level.nodes(p)});
    }
    std::vector<Pixel> pixels;
    std::vector<float> floats;  // of each function all depths, then all values; with padding
};

// An evaluation of one function, as lookups make them.
struct Evaluation {
    std::uint32_t pixel;
    float z;
};

// Those of lookups in image order, by each one's footprint.
std::vector<Evaluation> evaluations_of(std::span<const techniques::Query> queries, const techniques::DeepLevel& level) {
    std::vector<Evaluation> all;
    for (const techniques::Query& query : queries)
        techniques::for_each_pixel(level.width, level.height, 0, techniques::Kernel::box, query,
                                   [&](int x, int y, double) {
                                       const std::size_t p = level.pixel(x, y);
                                       if (level.nodes(p) > 0) all.push_back({static_cast<std::uint32_t>(p), query.z});
                                   });
    return all;
}

// Over all evaluations. The searches find the same segments; roundings of values are the compiler's.
struct Sums {
    float values = 0.0f;
    std::uint64_t segments = 0;
};

// Nanoseconds of an evaluation. `search` gets the pixel, its depths and z, and returns the first depth that is not
// less.
template <class Search>
double pass(Functions& functions, std::span<const Evaluation> evaluations, const Search& search, Sums& sums) {
    sums = {};
    const bench::Stopwatch stopwatch;
    for (const Evaluation& one : evaluations) {
        Pixel& pixel = functions.pixels[one.pixel];
        const float *depths = functions.floats.data() + pixel.begin, *values = depths + pixel.nodes;
        const std::uint32_t next = search(pixel, depths, one.z);
        sums.segments += next;
        if (next == 0)
            sums.values += values[0];
        else if (next == pixel.nodes)
            sums.values += values[next - 1];
        else
            sums.values += curves::join({depths[next - 1], values[next - 1]}, {depths[next], values[next]}, one.z);
    }
    return 1e9 * stopwatch.seconds() / static_cast<double>(evaluations.size());
}

enum Way { linear, binary, pointer, table };
constexpr const char* way_names[] = {"a linear search from the first segment", "a binary search",
                                     "the pointer of each pixel", "a table of the pixels used last"};

struct Searched {
    std::array<Sums, std::size(way_names)> sums;
    Turns ns;
};

Searched time_searches(Functions& functions, std::span<const Evaluation> evaluations) {
    Searched found;
    techniques::CachedSearch cached(evaluations.size());
    std::vector<std::function<double()>> ways(std::size(way_names));
    const auto make = [&](Way way, auto search) {
        ways[way] = [&functions, evaluations, search, &sums = found.sums[way]] {
            return pass(functions, evaluations, search, sums);
        };
    };
    make(linear,
         [](Pixel& pixel, const float* depths, float z) { return techniques::LinearSearch()(depths, pixel.nodes, z); });
    make(binary,
         [](Pixel& pixel, const float* depths, float z) { return techniques::BinarySearch()(depths, pixel.nodes, z); });
    make(pointer,
         [](Pixel& pixel, const float* depths, float z) { return search_from(pixel.last, depths, pixel.nodes, z); });
    make(table, [&cached](Pixel& pixel, const float* depths, float z) { return cached(depths, pixel.nodes, z); });
    const Compared compared[] = {{pointer, linear}, {pointer, binary}, {table, linear}, {table, binary}};
    found.ns = take_turns(ways, compared, lookup_rounds);
    return found;
}

}  // namespace

void searches(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const SeededLight light(
        context, ball_scene,
        {"rays.samples_per_pixel=256", R"(receivers.footprint={"share":0.0078125})", set_techniques(published_deep())},
        {"rays.samples_per_pixel=64"});
    const std::vector<bench::Maps> maps = light.build(0);
    const techniques::DeepLevel& level = techniques::levels(*maps.front().parts.front())[0];
    const bench::QuerySet image = light.queries();
    const bench::QuerySet asked = bench::pick(image.asked(), bench::choose_runs(image.queries.size(), 32768));
    Functions functions(level);
    const Searched found = time_searches(functions, evaluations_of(asked.queries, level));
    for (const Sums& sums : found.sums)
        if (sums.segments != found.sums.front().segments)
            throw base::Error(base::ErrorCode::internal, "section 3.4", "the searches find different segments");
    std::vector<Judged> reduced;
    std::vector<Value> values;
    std::string text;
    for (const Way way : {pointer, table}) {
        const Value of_linear = found.ns.ratio(way, linear), of_binary = found.ns.ratio(way, binary);
        for (const Value& one : {of_linear, of_binary}) reduced.push_back(judge_less(one, exactly(1.0)));
        values.insert(values.end(), {of_linear, of_binary});
        text +=
            fmt::format("{}{}: {} times the time of {}, {} times that of {}", text.empty() ? "" : "; ", way_names[way],
                        to_text(of_linear), way_names[linear], to_text(of_binary), way_names[binary]);
    }
    context.report->claims.push_back(
        {"section 3.4",
         "a search from the segment that a pixel used last reduces the average cost of evaluating a function", text,
         in_readings(reduced),
         "Evaluations of single functions in the order of lookups in image order, in figure 6's map of 256 x 256 "
         "pixels. The paper names both other searches and leaves open which one the cost is compared with. Two "
         "readings of where the pointers are: beside each pixel, as the paper stores them, and in a table for each "
         "batch of lookups, as in this program, whose threads share nothing.",
         std::move(values)});
}

}  // namespace shadowbench::claims::lokovic

// Salvi et al. 2010, section 3.2: "streaming compression algorithms must not rearrange node positions", since nodes
// would drift over many insertions. Tests it on the compression of deep shadow maps, which moves nodes, and on AVSM,
// which only removes them.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/salvi.h"
#include "claims/salvi_streams.h"
#include "claims/salvi_view.h"
#include "claims/texel.h"
#include "curves/compress_published.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "rays/light_view.h"

namespace shadowbench::claims::salvi {
namespace {

using curves::Curve;
using curves::Vertex;

constexpr float tolerance = 0.01f;  // table 1's threshold of deep shadow maps
constexpr int nodes = 12;
constexpr double rounding = 1e-4;  // of products of a hundred floats
constexpr int scenes = 3;
constexpr std::size_t rays_a_scene = 8;

// The segments of a ray in an order of insertion, as numbers in the tile.
using Order = std::vector<std::uint32_t>;

Order random_order(const rays::LightRays& tile, std::size_t ray, std::uint64_t seed) {
    Order order(tile.begin[ray + 1] - tile.begin[ray]);
    std::iota(order.begin(), order.end(), tile.begin[ray]);
    base::Random random(base::hash(seed, tile.tile, ray));
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random.below(k)]);
    return order;
}

Curve exact_curve(const rays::LightRays& one) {
    curves::SweepScratch scratch;
    Curve exact;
    curves::visibility(one, 0, 1, 1e-5, scratch, exact);
    return exact;
}

// The published compression after every insertion.
Curve streamed_deep(const rays::LightRays& tile, std::span<const std::uint32_t> order) {
    Curve curve;
    for (const std::uint32_t s : order)
        curve = curves::compress_published(
            with_medium(std::move(curve), {tile.z_front[s], tile.back(s), tile.transmittance[s]}), tolerance);
    return curve;
}

Curve streamed_avsm(const rays::LightRays& one, const rays::MapLayout& captured) {
    rays::MapLayout layout;
    layout.z_min = captured.z_min;
    layout.z_max = captured.z_max;
    layout.media = true;
    const techniques::Technique& row = techniques::find("avsm", "");
    const nlohmann::json parameters = {{"nodes", nodes}, {"order", "captured"}, {"cells", "sample"}};
    const rays::LightView view;
    const auto map = row.create(techniques::read_parameters(row.parameters, parameters, ""));
    map->begin({layout, view, nullptr});
    map->add(one);
    map->finish();
    Curve stored;
    map->stored(0, 0, 0, {}, stored);
    return stored;
}

double error(const Curve& curve, const Curve& exact) {
    return curves::distance(curve, exact, 0.0, 0.0).max;
}

// The largest rise from any depth to a deeper one.
double rise(const Curve& curve) {
    float most = 0.0f, least = 1.0f;
    for (const Vertex& v : curve) {
        most = std::max(most, v.value - least);
        least = std::min(least, v.value);
    }
    return most;
}

// Whether the nodes lie at ends of segments, or at the far plane.
bool at_segment_ends(const Curve& curve, const rays::LightRays& one, float far_plane) {
    return std::all_of(curve.begin(), curve.end(), [&](const Vertex& v) {
        return v.z == far_plane || std::count(one.z_front.begin(), one.z_front.end(), v.z) > 0 ||
               std::count(one.z_back.begin(), one.z_back.end(), v.z) > 0;
    });
}

struct Drift {
    std::vector<double> once, streamed, factor;  // errors of the deep map's compression
    std::vector<double> rise_once, rise_streamed;
    std::vector<double> behind;                      // of the streamed one, behind everything: below 0 is too dark
    std::vector<double> avsm_sorted, avsm_streamed;  // errors
    bool avsm_kept = true;                           // its curves fall and its nodes have not moved
    std::vector<double> avsm_behind;                 // of both, how far off behind everything
    bool avsm_lit = true;                            // all light arrives at its first node
};

void add_ray(const rays::LightRays& tile, std::size_t ray, const rays::MapLayout& layout, Drift& out) {
    const Order order = random_order(tile, ray, 1);
    Order by_depth = order;
    std::sort(by_depth.begin(), by_depth.end());
    const rays::LightRays one = one_ray(tile, order);
    const Curve exact = exact_curve(one), once = curves::compress_published(exact, tolerance),
                streamed = streamed_deep(tile, order);
    out.once.push_back(error(once, exact));
    out.streamed.push_back(error(streamed, exact));
    out.factor.push_back(out.streamed.back() / out.once.back());
    out.rise_once.push_back(rise(once));
    out.rise_streamed.push_back(rise(streamed));
    out.behind.push_back(static_cast<double>(streamed.back().value) - exact.back().value);
    const Curve sorted = streamed_avsm(one_ray(tile, by_depth), layout), avsm = streamed_avsm(one, layout);
    out.avsm_sorted.push_back(error(sorted, exact));
    out.avsm_streamed.push_back(error(avsm, exact));
    out.avsm_kept = out.avsm_kept && curves::is_visibility(avsm) && at_segment_ends(avsm, one, layout.z_max);
    for (const Curve* stored : {&sorted, &avsm}) {
        out.avsm_behind.push_back(std::abs(static_cast<double>(stored->back().value) - exact.back().value));
        out.avsm_lit = out.avsm_lit && stored->front().value == 1.0f;
    }
}

// The errors of one ray after each insertion.
Plot growth_plot(const rays::LightRays& tile, std::size_t ray, const rays::MapLayout& layout) {
    const Order order = random_order(tile, ray, 1);
    Plot plot{"salvi2010_drift",
              "Largest error of a streamed curve",
              "segments inserted",
              "largest error",
              false,
              true,
              {{"deep map's compression, tolerance 0.01", {}, true}, {"AVSM 12", {}, true}}};
    for (std::size_t k = 4; k <= order.size(); k += 4) {
        const std::span<const std::uint32_t> inserted = std::span(order).first(k);
        const rays::LightRays one = one_ray(tile, inserted);
        const Curve exact = exact_curve(one);
        plot.series[0].points.emplace_back(static_cast<double>(k), error(streamed_deep(tile, inserted), exact));
        plot.series[1].points.emplace_back(static_cast<double>(k), error(streamed_avsm(one, layout), exact));
    }
    return plot;
}

// The largest over texels: what can happen has happened at one of them.
Value most_of(const std::vector<double>& values) {
    return exactly(*std::max_element(values.begin(), values.end()));
}

void claims_of(const Drift& drift, PaperReport& report) {
    const Value once = median_of(drift.once), streamed = median_of(drift.streamed), factor = median_of(drift.factor),
                rise_once = most_of(drift.rise_once), rise_streamed = most_of(drift.rise_streamed);
    const auto [darkest, brightest] = std::minmax_element(drift.behind.begin(), drift.behind.end());
    const Value behind = largest(absolute(exactly(*darkest)), absolute(exactly(*brightest)));
    report.claims.push_back(
        {"section 3.2",
         "compression as of deep shadow maps can drift if it is streamed, to curves that are not monotonic and too "
         "dark or bright",
         fmt::format("largest error {} streamed, {} at once: {} times; of all curves one rises by up to {} streamed, "
                     "{} at once; behind all smoke they are off by {:.2g} to {:.2g}, at once by at most {:.2g}",
                     to_text(streamed), to_text(once), to_text(factor), to_text(rise_streamed), to_text(rise_once),
                     *darkest, *brightest, tolerance),
         both(judge_growth(factor), both(judge_less(rise_once, rise_streamed), judge_less(exactly(tolerance), behind))),
         fmt::format("Tolerance {}, compressed after each insertion in random order, over {} texels of figure 7. That "
                     "errors grow is judged by the median; that curves can rise, and can be too dark or bright by more "
                     "than the tolerance, by the largest of all texels.",
                     tolerance, drift.once.size()),
         {streamed, once, factor, rise_streamed, rise_once, behind}});
    const Value in_order = median_of(drift.avsm_sorted), random = median_of(drift.avsm_streamed);
    report.claims.push_back(
        {"section 3.2",
         "AVSM only removes nodes, so its curves stay monotonic",
         fmt::format("largest error of {} nodes {} sorted, {} in random order; {}", nodes, to_text(in_order),
                     to_text(random), drift.avsm_kept ? "all nodes at ends of segments, no rise" : "nodes moved"),
         by_construction(drift.avsm_kept),
         "The compression removes nodes and changes no depth; the order only decides which nodes.",
         {in_order, random}});
    const Value ends = most_of(drift.avsm_behind);
    report.claims.push_back(
        {"section 3.2.1",
         "the first and the last node stay, which show the transition into a volume and its shadow on what lies behind",
         fmt::format("all light arrives at {} first node; behind all smoke curves of {} nodes are off by at most {}",
                     drift.avsm_lit ? "every" : "not every", nodes, to_text(ends)),
         by_construction(drift.avsm_lit && ends.value < rounding),
         "Their area is not defined, so they are never removed. In the texels above, sorted and in random order.",
         {ends}});
}

}  // namespace

void drift(const Context& context) {
    Drift measured;
    for (int k = 0; k < scenes; ++k) {
        const View view(with_size(with_seeds(context.document(columns), k), context), context);
        const std::vector<RayPlace> places = choose_rays(view.tiles(), view.layout(), {282, three_drops}, rays_a_scene);
        for (const RayPlace& place : places) add_ray(view.tiles()[place.tile], place.ray, view.layout(), measured);
        const RayPlace& first = places.front();
        if (k == 0) context.report->plots.push_back(growth_plot(view.tiles()[first.tile], first.ray, view.layout()));
    }
    claims_of(measured, *context.report);
}

}  // namespace shadowbench::claims::salvi

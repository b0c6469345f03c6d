// Lokovic and Veach, Deep Shadow Maps, 2000: section 5.3, anisotropic filters.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/polygon_area.h"
#include "claims/seeded_light.h"
#include "metrics/statistics.h"
#include "techniques/deep/probes.h"

namespace shadowbench::claims::lokovic {
namespace {

using techniques::Footprint;
using techniques::Query;

constexpr int most_probes[] = {0, 1, 2, 4, 8, 16};
constexpr std::size_t same_area = 0, long_axis = 1, most = std::size(most_probes) - 1;  // places in that list

std::string name_of(int probes) {
    if (probes == 0) return "one square of the same area";
    if (probes == 1) return "one square as wide as the long axis";
    return fmt::format("up to {} probes", probes);
}

int probes_taken(const Footprint& footprint, int at_most) {
    techniques::Probes probes;
    return at_most > 0 && techniques::probes_of(footprint, at_most, probes) ? probes.count : 1;
}

// The queries whose footprints are at least twice as long as wide, asked for a square of the same area.
bench::QuerySet long_footprints(const bench::QuerySet& all) {
    bench::QuerySet chosen;
    for (std::size_t i = 0; i < all.queries.size(); ++i) {
        const Footprint& f = all.footprints[i];
        if (probes_taken(f, 1000) < 2) continue;
        const double area = std::abs(static_cast<double>(f.ux) * f.vy - static_cast<double>(f.uy) * f.vx);
        if (!(area > 0.0)) continue;
        Query q = all.queries[i];
        q.width = static_cast<float>(std::sqrt(area));
        chosen.queries.push_back(q);
        chosen.footprints.push_back(f);
    }
    return chosen;
}

// The pixels that a parallelogram covers, as queries of single pixels, with their covered areas.
struct Covered {
    std::vector<Query> pixels;
    std::vector<double> areas;
    std::vector<std::size_t> end;  // of each parallelogram
};

void add_covered(const Query& q, const Footprint& f, const rays::MapLayout& layout, Covered& out) {
    Polygon corners;
    for (const auto& [s, t] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
        corners.push_back({q.x + s * f.ux + t * f.vx, q.y + s * f.uy + t * f.vy});
    const auto range = [&](int axis, int size) {
        const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
                                                     [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        const double side = size;
        return std::pair{static_cast<int>(std::clamp((*low)[axis], 0.0, side)),
                         static_cast<int>(std::ceil(std::clamp((*high)[axis], 0.0, side)))};
    };
    const auto [x0, x1] = range(0, layout.width);
    const auto [y0, y1] = range(1, layout.height);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const double area = area_inside(corners, x, y);
            if (!(area > 0.0)) continue;
            out.pixels.push_back({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, q.z, 0.0f});
            out.areas.push_back(area);
        }
    out.end.push_back(out.pixels.size());
}

// The exact means of the map's functions over the parallelograms, inside the map.
std::vector<double> exact_means(const bench::Maps& map, const Covered& covered) {
    const std::vector<float> values = bench::lookup_all(map, covered.pixels);
    std::vector<double> means;
    std::size_t i = 0;
    for (const std::size_t end : covered.end) {
        double sum = 0.0, area = 0.0;
        for (; i < end; ++i) {
            sum += covered.areas[i] * values[i];
            area += covered.areas[i];
        }
        means.push_back(sum / area);
    }
    return means;
}

double rms_error(const bench::Maps& map, const bench::QuerySet& asked, const std::vector<double>& truth) {
    const std::vector<float> answers = bench::lookup_all(map, asked.asked());
    std::vector<double> errors(answers.size());
    for (std::size_t i = 0; i < answers.size(); ++i) errors[i] = answers[i] - truth[i];
    return metrics::error_norms(errors).rms;
}

// Of each map, the first left out.
Turns times_of(const std::vector<bench::Maps>& maps, const bench::QuerySet& asked) {
    std::vector<TimedLookups> all;
    for (std::size_t m = 1; m < maps.size(); ++m) all.push_back({&maps[m], asked.asked()});
    const Compared compared[] = {{most, same_area}};
    return lookup_turns(all, compared);
}

struct Measured {
    std::size_t footprints = 0;
    std::vector<double> probes;  // a lookup
    Turns ns;
    std::vector<Value> error;
};

Measured measure_footprints(const Context& context) {
    std::string list = R"({"type":"deep","tolerance":0})";
    for (const int probes : most_probes)
        list += fmt::format(R"(,{{"type":"deep","mip":"nearest","probes":{}}})", probes);
    // Seen from low above the ground, in a small picture: the pixels are long and several map pixels wide.
    const SeededLight light(context, ball_scene,
                            {"rays.samples_per_pixel=64", "rays.resolution=128", "receivers.position=[-1.5,0.9,8.2]",
                             "receivers.resolution=[96,72]", set_techniques(list)},
                            {"rays.resolution=64", "receivers.resolution=[48,36]"});
    const bench::QuerySet asked = long_footprints(light.queries());
    Covered covered;
    for (std::size_t i = 0; i < asked.queries.size(); ++i)
        add_covered(asked.queries[i], asked.footprints[i], light.layout(), covered);
    Measured measured{asked.queries.size(), {}, {}, {}};
    std::vector<std::vector<double>> errors(std::size(most_probes));
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const std::vector<bench::Maps> maps = light.build(seed);
        const std::vector<double> truth = exact_means(maps[0], covered);
        for (std::size_t m = 0; m < errors.size(); ++m) errors[m].push_back(rms_error(maps[m + 1], asked, truth));
        if (seed == 0) measured.ns = times_of(maps, asked);
    }
    for (std::size_t m = 0; m < errors.size(); ++m) {
        double taken = 0.0;
        for (const Footprint& footprint : asked.footprints) taken += probes_taken(footprint, most_probes[m]);
        measured.probes.push_back(taken / static_cast<double>(asked.queries.size()));
        measured.error.push_back(mean_of(errors[m]));
    }
    return measured;
}

}  // namespace

void footprints(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    const Measured found = measure_footprints(context);
    Table table{
        fmt::format("Section 5.3: filtering over {} pixels of a picture that are at least twice as long as wide "
                    "in a map of 128 x 128 pixels, with mip levels, against the exact mean of the uncompressed "
                    "functions over the parallelogram; errors are means over three seeds of the light rays",
                    found.footprints),
        {"filter", "probes a lookup", "ns a lookup", "error rms"},
        {}};
    for (std::size_t m = 0; m < std::size(most_probes); ++m)
        table.rows.push_back({name_of(most_probes[m]), fmt::format("{:.3g}", found.probes[m]),
                              to_text(found.ns.time(m)), to_text(found.error[m])});
    report.tables.push_back(std::move(table));
    const Value &anisotropic = found.error[most], &wide = found.error[long_axis], &square = found.error[same_area];
    const Value slower = found.ns.ratio(most, same_area);
    report.claims.push_back(
        {"section 5.3",
         "mip-mapped deep shadows are filtered just like mip-mapped textures, including anisotropic filters",
         fmt::format(
             "error rms {} with up to 16 probes along the long axis, {} with one square as wide as that axis, {} "
             "with one of the same area; {} times the time of that one",
             to_text(anisotropic), to_text(wide), to_text(square), to_text(slower)),
         both(judge_less(anisotropic, wide), judge_less(anisotropic, square)),
         "The claim holds if anisotropic filters do for deep maps what they do for textures: follow a long footprint "
         "more closely than any single square.",
         {anisotropic, wide, square, slower}});
}

}  // namespace shadowbench::claims::lokovic

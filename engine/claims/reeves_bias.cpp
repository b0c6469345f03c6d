// Reeves, Salesin, Cook 1987: figure 9.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/vec.h"
#include "claims/intervals.h"
#include "claims/reeves.h"
#include "claims/seen.h"

namespace shadowbench::claims::reeves {
namespace {

constexpr std::uint64_t repeats = 4;  // with the cells of the map at other places
constexpr int reach = 10;             // pixels: the filter of a lookup reaches less far

struct Bias {
    const char *low, *high;
};
constexpr Bias biases[] = {
    {"0", "0"}, {"0.2", "0.3"}, {"0.3", "0.4"}, {"3", "4"}};  // the last is ten times that of figure 9
constexpr std::size_t settings = std::size(biases);

// One setting of the bias in each repeat. A soft shadow's boundary is where half of the light arrives.
struct Effects {
    std::vector<double> false_shadow;  // mean over lit surfaces away from edges of shadows
    std::vector<double> lost;          // share of the sphere's own shadow by which its boundary moves inwards
    std::vector<double> lost_cast;     // the same, of the shadow on the plane
    std::vector<double> wrong;         // share of the picture at boundaries that is lit, not shadowed, or the reverse
    std::vector<double> mean;          // of all that is seen: visibility less the truth
};

struct Sphere {
    base::Vec3d centre{0, 0, 0};
    double radius = 0.0;

    bool holds(const base::Vec3d& place) const { return (place - centre).length() < 1.01 * radius; }
};

Sphere sphere_of(const nlohmann::json& document) {
    const nlohmann::json& object = document.at("scene").at("objects").at(0);
    Sphere found;
    for (int axis = 0; axis < 3; ++axis) found.centre[axis] = object.at("centre").at(axis).get<double>();
    found.radius = object.at("radius").get<double>();
    return found;
}

std::string techniques() {
    std::string list;
    for (const Bias& bias : biases)
        list +=
            fmt::format(R"({}{{"type":"pcf","num_samples":16,"res_factor":3,"region":"pixel","bias0":{},"bias1":{}}})",
                        list.empty() ? "" : ",", bias.low, bias.high);
    return "techniques=[" + list + "]";
}

enum class Ground : unsigned char { unseen, lit, shadowed };

// Whether no pixel within reach is in shadow.
bool away_from_shadows(const std::vector<Ground>& ground, base::Vec2i size, std::uint32_t pixel) {
    const int x = static_cast<int>(pixel) % size.x, y = static_cast<int>(pixel) / size.x;
    for (int j = std::max(0, y - reach); j <= std::min(size.y - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(size.x - 1, x + reach); ++i)
            if (ground[static_cast<std::size_t>(j) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(i)] ==
                Ground::shadowed)
                return false;
    return true;
}

void measure(const Seen& seen, const Sphere& ball, std::vector<Effects>& effects) {
    const std::size_t queries = seen.queries().size();
    const bench::Truth truth = seen.truth(seen.queries());  // of points: 0 or 1
    std::vector<Ground> ground(static_cast<std::size_t>(seen.size().x) * static_cast<std::size_t>(seen.size().y));
    std::vector<bool> own(queries);
    double own_shadow = 0.0, cast_shadow = 0.0;
    for (std::size_t q = 0; q < queries; ++q) {
        ground[seen.pixel(q)] = truth.value[q] > 0.5 ? Ground::lit : Ground::shadowed;
        own[q] = ball.holds(seen.place(q));
        (own[q] ? own_shadow : cast_shadow) += 1.0 - truth.value[q];
    }
    std::vector<bool> inner(queries);
    for (std::size_t q = 0; q < queries; ++q) inner[q] = away_from_shadows(ground, seen.size(), seen.pixel(q));
    for (std::size_t setting = 0; setting < settings; ++setting) {
        const std::span<const float> visibility = seen.visibility(setting);
        double dark = 0.0, lit = 0.0, own_lost = 0.0, cast_lost = 0.0, wrong = 0.0, sum = 0.0;
        for (std::size_t q = 0; q < queries; ++q) {
            const double off = static_cast<double>(visibility[q]) - truth.value[q];
            sum += off;
            if (inner[q]) {
                dark -= off;
                lit += 1.0;
                continue;
            }
            const double lost = (visibility[q] > 0.5f ? 1.0 : 0.0) - truth.value[q];
            (own[q] ? own_lost : cast_lost) += lost;
            wrong += std::abs(lost);
        }
        effects[setting].false_shadow.push_back(dark / lit);
        effects[setting].lost.push_back(own_lost / own_shadow);
        effects[setting].lost_cast.push_back(cast_lost / cast_shadow);
        effects[setting].wrong.push_back(wrong / static_cast<double>(queries));
        effects[setting].mean.push_back(sum / static_cast<double>(queries));
    }
}

std::vector<double> less(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> difference;
    for (std::size_t i = 0; i < a.size(); ++i) difference.push_back(a[i] - b[i]);
    return difference;
}

std::string percent(const Value& share) {
    return to_text(100.0 * share) + " %";
}

void add_claims(const std::vector<Effects>& effects, PaperReport& report) {
    const Value none = mean_of(effects[0].false_shadow), some = mean_of(effects[1].false_shadow),
                more = mean_of(effects[2].false_shadow);
    report.claims.push_back(
        {"section 4.2, figure 9",
         "increasing Bias eliminates the Moire patterns of incorrect self-shadowing",
         fmt::format("false shadow on lit surfaces: {}, {}, {} with bias 0, 0.2 to 0.3, 0.3 to 0.4", percent(none),
                     percent(some), percent(more)),
         judge_much_less(more, none),
         "Over the lit surfaces that no edge of a shadow is near, in a world of 100 units as in the paper.",
         {none, some, more}});
    const Value least = mean_of(effects[1].lost), most = mean_of(effects[2].lost), large = mean_of(effects[3].lost),
                further = mean_of(less(effects[2].lost, effects[1].lost));
    const auto cast = [&](std::size_t setting) { return percent(mean_of(effects[setting].lost_cast)); };
    report.claims.push_back(
        {"section 4.2, figure 9",
         "increasing Bias moves the boundary of the shadow away from its true position",
         fmt::format("with bias 0.2 to 0.3, 0.3 to 0.4, 3 to 4 the sphere's own shadow loses {}, {}, {} of its area "
                     "(above 0: its boundary lies inwards of the true position), the shadow on the plane {}, {}, {}",
                     percent(least), percent(most), percent(large), cast(1), cast(2), cast(3)),
         both(judge_less(exactly(0.0), further), judge_less(exactly(0.0), large)),
         "Judged on the sphere, where surfaces lie within the bias of each other, by two things: that its boundary "
         "moves inwards from the first of these to the second, and that the last moves it beyond its true position. A "
         "boundary is where half of the light arrives. Below 0 the shadow is too large: where light grazes a surface, "
         "the filter still meets the surface itself.",
         {least, most, large}});
    const Value wrong = mean_of(effects[2].wrong), wrong_before = mean_of(effects[1].wrong);
    report.claims.push_back(
        {"section 4.2, figure 9",
         "a Bias of 0.3 to 0.4 is small enough to avoid noticeable problems from the moved boundary",
         fmt::format("{} of the picture is on the wrong side of a boundary; with a bias of 0.2 to 0.3 it is {}",
                     percent(wrong), percent(wrong_before)),
         judge_unnoticed(wrong),
         "Lost and false shadow both count, also where the filter's noise makes them. The share is the mean difference "
         "of two pictures that show only where half of the light arrives, as grey levels are.",
         {wrong, wrong_before}});
}

}  // namespace

// Everything is judged by the visibility of points: the footprints of the truth are points. The bias is a length of the
// world, and self-shadowing depends on the size of pixels and cells: both are the paper's, 1024 across.
void bias(const Context& context) {
    const nlohmann::json document =
        context.document(sphere, {"receivers.resolution=[1024,768]", "receivers.filter_width=1e-6",
                                  "receivers.bias=0.002", "reference.samples_per_pixel=1", techniques()});
    note_document(context, sphere, document);
    const Sphere ball = sphere_of(document);
    std::vector<Effects> effects(settings);
    for (std::uint64_t repeat = 0; repeat < repeats; ++repeat)
        measure(Seen(with_moved_map(document, repeat), context.data), ball, effects);
    Table table{"Figure 9: what the bias does; means over four places of the map's cells",
                {"bias", "false shadow on lit surfaces", "area that the sphere's own shadow loses",
                 "area that the shadow on the plane loses", "share of the picture on the wrong side of a boundary",
                 "mean error"},
                {}};
    for (std::size_t setting = 0; setting < settings; ++setting)
        table.rows.push_back({fmt::format("{} to {}", biases[setting].low, biases[setting].high),
                              percent(mean_of(effects[setting].false_shadow)), percent(mean_of(effects[setting].lost)),
                              percent(mean_of(effects[setting].lost_cast)),
                              percent(mean_of(effects[setting].wrong)), to_text(mean_of(effects[setting].mean))});
    context.report->tables.push_back(std::move(table));
    add_claims(effects, *context.report);
}

}  // namespace shadowbench::claims::reeves

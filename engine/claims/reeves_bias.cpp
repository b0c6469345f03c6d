// Reeves, Salesin, Cook 1987: figure 9.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
    std::vector<double> lost;          // share of the shadow's area by which its boundary moves inwards
    std::vector<double> moved;         // the same, of the picture's area
    std::vector<double> mean;          // of all that is seen: visibility less the truth
};

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

void measure(const Seen& seen, std::vector<Effects>& effects) {
    const std::size_t queries = seen.queries().size();
    const bench::Truth truth = seen.truth(seen.queries());  // of points: 0 or 1
    std::vector<Ground> ground(static_cast<std::size_t>(seen.size().x) * static_cast<std::size_t>(seen.size().y));
    double shadow = 0.0;
    for (std::size_t q = 0; q < queries; ++q) {
        ground[seen.pixel(q)] = truth.value[q] > 0.5 ? Ground::lit : Ground::shadowed;
        shadow += 1.0 - truth.value[q];
    }
    std::vector<bool> inner(queries);
    for (std::size_t q = 0; q < queries; ++q) inner[q] = away_from_shadows(ground, seen.size(), seen.pixel(q));
    for (std::size_t setting = 0; setting < settings; ++setting) {
        const std::span<const float> visibility = seen.visibility(setting);
        double dark = 0.0, lit = 0.0, lost = 0.0, sum = 0.0;
        for (std::size_t q = 0; q < queries; ++q) {
            const double off = static_cast<double>(visibility[q]) - truth.value[q];
            sum += off;
            lost += inner[q] ? 0.0 : (visibility[q] > 0.5f ? 1.0 : 0.0) - truth.value[q];
            dark += inner[q] ? -off : 0.0;
            lit += inner[q] ? 1.0 : 0.0;
        }
        effects[setting].false_shadow.push_back(dark / lit);
        effects[setting].lost.push_back(lost / shadow);
        effects[setting].moved.push_back(lost / static_cast<double>(queries));
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
    report.claims.push_back(
        {"section 4.2, figure 9",
         "increasing Bias moves the boundary of the shadow away from its true position",
         fmt::format("shadows lose {}, {}, {} of their area with bias 0.2 to 0.3, 0.3 to 0.4, 3 to 4", percent(least),
                     percent(most), percent(large)),
         both(judge_less(exactly(0.0), further), judge_less(exactly(0.0), large)),
         "The boundary is where half of the light arrives. Below 0 the shadow is too large: where light grazes a "
         "surface, the filter still meets the surface itself.",
         {least, most, large}});
    const Value moved = mean_of(effects[2].moved);
    report.claims.push_back(
        {"section 4.2, figure 9",
         "a Bias of 0.3 to 0.4 is small enough to avoid noticeable problems from the moved boundary",
         fmt::format("the shadow loses {} of the picture's area", percent(moved)),
         judge_unnoticed(moved),
         "That share of the picture is lit instead of shadowed.",
         {moved}});
}

}  // namespace

// Everything is judged by the visibility of points: the footprints of the truth are points. The bias is a length of the
// world, and self-shadowing depends on the size of pixels and cells: both are the paper's, 1024 across.
void bias(const Context& context) {
    const nlohmann::json document =
        context.document(sphere, {"receivers.resolution=[1024,768]", "receivers.filter_width=1e-6",
                                  "receivers.bias=0.002", "reference.samples_per_pixel=1", techniques()});
    note_document(context, sphere, document);
    std::vector<Effects> effects(settings);
    for (std::uint64_t repeat = 0; repeat < repeats; ++repeat)
        measure(Seen(with_moved_map(document, repeat), context.data), effects);
    Table table{"Figure 9: what the bias does; means over four places of the map's cells",
                {"bias", "false shadow on lit surfaces", "area that shadows lose at their boundaries", "mean error"},
                {}};
    for (std::size_t setting = 0; setting < settings; ++setting)
        table.rows.push_back({fmt::format("{} to {}", biases[setting].low, biases[setting].high),
                              percent(mean_of(effects[setting].false_shadow)), percent(mean_of(effects[setting].lost)),
                              to_text(mean_of(effects[setting].mean))});
    context.report->tables.push_back(std::move(table));
    add_claims(effects, *context.report);
}

}  // namespace shadowbench::claims::reeves

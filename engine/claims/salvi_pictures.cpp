// Salvi et al. 2010, section 5.1, figures 3 and 5: pictures that are hard to tell apart.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/salvi.h"
#include "claims/salvi_columns.h"
#include "claims/salvi_view.h"

namespace shadowbench::claims::salvi {
namespace {

// AVSM with 12 nodes beside a deep shadow map of tolerance 0.002, in a scene of opaque things and smoke.
void figure_3(const Context& context) {
    SeededDifferences to_deep, to_all, eight;
    std::vector<double> largest, mean;  // of curves of 8 nodes
    for (int k = 0; k < seeds; ++k) {
        nlohmann::json document = with_size(with_seeds(context.document(level), k), context);
        document["techniques"] =
            nlohmann::json::parse(R"([{"type":"avsm","cells":"sample","nodes":12,"filter":"bilinear"},)"
                                  R"({"type":"avsm","cells":"sample","nodes":8,"filter":"bilinear"},)"
                                  R"({"type":"deep","tolerance":0.002},)"
                                  R"({"type":"uncompressed","filter":"bilinear"}])");
        const View view(document, context);
        const render::Image twelve = view.picture("avsm", {"nodes=12"}), truth = view.picture("uncompressed");
        to_deep.add(view.difference(twelve, view.picture("deep")));
        to_all.add(view.difference(twelve, truth));
        eight.add(view.difference(view.picture("avsm", {"nodes=8"}), truth));
        document["techniques"] = nlohmann::json::parse(R"([{"type":"avsm","cells":"sample","nodes":8}])");
        const MapErrors curves = map_errors(document, context);
        largest.push_back(curves.rms.front());
        mean.push_back(curves.mean.front());
    }
    const char* place = "section 5.1, figure 3";
    PaperReport& report = *context.report;
    report.claims.push_back(
        {place, "there is little perceptible difference between AVSM 12 and a deep shadow map of tolerance 0.002",
         "the pictures differ by " + to_deep.text(), to_deep.unnoticed(),
         "Smoke between opaque things in place of the game's level; both maps are filtered alike. Judged by the rms "
         "and by 99 % of the pixels.",
         to_deep.values()});
    report.claims.push_back({place, "the results for sampling the uncompressed data also look identical",
                             "AVSM 12 differs from the uncompressed map by " + to_all.text(), to_all.unnoticed(),
                             "In the same scenes, by the same two readings.", to_all.values()});
    const Value at_worst = median_of(largest), on_average = median_of(mean);
    report.claims.push_back(
        {place,
         "even with 8 nodes, AVSM very closely approximates the true transmittance curves",
         fmt::format("over all texels: largest distance of each curve, rms {}; mean distance over depth {}",
                     to_text(at_worst), to_text(on_average)),
         in_readings({judge_fit(at_worst), judge_fit(on_average)}),
         "In the same scenes. The paper inspects curves and names no measure: read by the largest and by the mean "
         "distance.",
         {at_worst, on_average}});
    report.claims.push_back({place, "8 nodes result in acceptable visual quality",
                             "AVSM 8 differs from the uncompressed map by " + eight.text(), not_comparable(),
                             "In the same scenes. The paper does not say what it accepts.", eight.values()});
}

// Hair in smoke, whose opacity the paper does not give.
struct Hair {
    const char* name;
    double opacity;  // in times that of the scenario
};
constexpr Hair thin = {"estimated hair", 1.0}, opaque = {"hair three times as opaque", 3.0};

struct HairPictures {
    Value twelve, osm, fom, over;  // rms; AVSM 12 over the better of the others

    Judged judged() const {
        return both(both(judge_unnoticed(twelve), judge_much_less(over, exactly(1.0))),
                    both(judge_less(exactly(grey_level), osm), judge_less(exactly(grey_level), fom)));
    }
    std::string text() const {
        return fmt::format("rms {} against {} (OSM 32) and {} (FOM 16), AVSM 12 over the better of the others {}",
                           to_text(twelve), to_text(osm), to_text(fom), to_text(over));
    }
};

HairPictures hair_pictures(const Context& context, const Hair& hair) {
    std::vector<double> nodes, slices, terms, ratio;
    for (int k = 0; k < seeds; ++k) {
        nlohmann::json document =
            with_size(with_opacity(with_seeds(context.document(hair_in_smoke), k), hair.opacity), context);
        document["techniques"] =
            nlohmann::json::parse(R"([{"type":"avsm","cells":"sample","nodes":12,"filter":"bilinear"},)"
                                  R"({"type":"opacity","cells":"sample","slices":32,"filter":"bilinear"},)"
                                  R"({"type":"fourier","cells":"sample","terms":16,"filter":"bilinear"},)"
                                  R"({"type":"uncompressed","filter":"bilinear"}])");
        if (k == 0) note_document(context, hair_in_smoke, document);
        const View view(document, context);
        const render::Image truth = view.picture("uncompressed");
        const auto rms = [&](const char* technique) { return view.difference(view.picture(technique), truth).rms; };
        nodes.push_back(rms("avsm"));
        slices.push_back(rms("opacity"));
        terms.push_back(rms("fourier"));
        ratio.push_back(nodes.back() / std::min(slices.back(), terms.back()));
    }
    return {median_of(nodes), median_of(slices), median_of(terms), median_of(ratio)};
}

void figure_5(const Context& context) {
    std::vector<Judged> readings;
    std::vector<Value> values;
    std::string text;
    for (const Hair& hair : {thin, opaque}) {
        const HairPictures found = hair_pictures(context, hair);
        readings.push_back(found.judged());
        values.insert(values.end(), {found.twelve, found.osm, found.fom, found.over});
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", hair.name, found.text());
    }
    context.report->claims.push_back(
        {"figure 5 (caption)",
         "with hair in smoke AVSM 12 and uncompressed are nearly identical, and OSM 32 and FOM 16 show substantial "
         "artifacts",
         fmt::format("differences from the uncompressed picture, where a grey level is {:.3g}: {}", grey_level, text),
         in_readings(readings),
         "Artifacts are substantial only if they exceed a grey level, too. Slices smear a step over their interval, "
         "and a series rings at it, the more so the more opaque a hair is. The paper does not say how opaque its hair "
         "is, so both are readings. The paper's FOM had less than optimal depth bounds; here its bounds are those of "
         "all casters in the map.",
         values});
}

}  // namespace

void pictures(const Context& context) {
    figure_3(context);
    figure_5(context);
}

}  // namespace shadowbench::claims::salvi

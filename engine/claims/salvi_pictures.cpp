// Salvi et al. 2010, section 5.1, figures 3 and 5: pictures that are hard to tell apart.
#include <algorithm>
#include <iterator>
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
    std::vector<double> largest, mean, complex;  // of curves of 8 nodes, and the number of their texels
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
        const ComplexCurves curves = complex_curves(view, view.contender("avsm", {"nodes=8"}), 8 / 2);
        largest.push_back(curves.rms);
        mean.push_back(curves.mean);
        complex.push_back(static_cast<double>(curves.texels));
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
    const Value at_worst = median_of(largest), on_average = median_of(mean), texels = median_of(complex);
    report.claims.push_back(
        {place,
         "even with 8 nodes, AVSM very closely approximates the true transmittance curves",
         fmt::format("over {} texels of more than 8 nodes, two a segment: largest distance of each curve, rms {}; mean "
                     "distance over depth {}",
                     to_text(texels), to_text(at_worst), to_text(on_average)),
         in_readings({judge_fit(at_worst), judge_fit(on_average)}),
         "In the same scenes. Texels of 8 nodes and fewer do not count: nothing is removed there. The paper inspects "
         "curves and names no measure: read by the largest and by the mean distance.",
         {texels, at_worst, on_average}});
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

// The paper's FOM had "less-than-optimal depth bounds", and it does not say how much less.
struct Bounds {
    const char* name;
    double times_the_range;  // of all casters
};
constexpr Bounds tight = {"bounds of all casters", 1.0}, loose = {"bounds twice as far apart", 2.0};

// Differences from the uncompressed picture.
struct HairPictures {
    SeededDifferences twelve;
    Value osm;  // rms
    struct Fom {
        const char* bounds;
        Value rms, over;  // AVSM 12 over the better of the others
    };
    std::vector<Fom> foms;

    // "Nearly identical" is read by the rms and by 99 % of the pixels; FOM has these bounds or those.
    void add_readings(std::vector<Judged>& readings) const {
        for (const Value& near : {median_of(twelve.rms), median_of(twelve.most)})
            for (const Fom& fom : foms)
                readings.push_back(both(both(judge_unnoticed(near), judge_much_less(fom.over, exactly(1.0))),
                                        both(judge_visible(osm), judge_visible(fom.rms))));
    }
    void add_values(std::vector<Value>& values) const {
        const std::vector<Value> of_twelve = twelve.values();
        values.insert(values.end(), of_twelve.begin(), of_twelve.end());
        values.push_back(osm);
        for (const Fom& fom : foms) values.insert(values.end(), {fom.rms, fom.over});
    }
    std::string text() const {
        std::string result = fmt::format("AVSM 12 {}; OSM 32 rms {}", twelve.text(), to_text(osm));
        for (const Fom& fom : foms)
            result += fmt::format("; FOM 16 with {} rms {}, AVSM 12 over the better of the others {}", fom.bounds,
                                  to_text(fom.rms), to_text(fom.over));
        return result;
    }
};

HairPictures hair_pictures(const Context& context, const Hair& hair) {
    constexpr Bounds all_bounds[] = {tight, loose};
    HairPictures found;
    std::vector<double> slices, terms[std::size(all_bounds)], ratio[std::size(all_bounds)];
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
        found.twelve.add(view.difference(view.picture("avsm"), truth));
        slices.push_back(view.difference(view.picture("opacity"), truth).rms);
        for (std::size_t b = 0; b < std::size(all_bounds); ++b) {
            const bench::Maps fom = view.build_within(view.contender("fourier"), all_bounds[b].times_the_range);
            terms[b].push_back(view.difference(view.picture(fom), truth).rms);
            ratio[b].push_back(found.twelve.rms.back() / std::min(slices.back(), terms[b].back()));
        }
    }
    found.osm = median_of(slices);
    for (std::size_t b = 0; b < std::size(all_bounds); ++b)
        found.foms.push_back({all_bounds[b].name, median_of(terms[b]), median_of(ratio[b])});
    return found;
}

void figure_5(const Context& context) {
    std::vector<Judged> readings;
    std::vector<Value> values;
    std::string text;
    for (const Hair& hair : {thin, opaque}) {
        const HairPictures found = hair_pictures(context, hair);
        found.add_readings(readings);
        found.add_values(values);
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", hair.name, found.text());
    }
    context.report->claims.push_back(
        {"figure 5 (caption)",
         "with hair in smoke AVSM 12 and uncompressed are nearly identical, and OSM 32 and FOM 16 show substantial "
         "artifacts",
         fmt::format("differences from the uncompressed picture, where a grey level is {:.3g}: {}", grey_level, text),
         in_readings(readings),
         "Artifacts are substantial if they are visible and much larger than the differences of AVSM. Slices smear a "
         "step over their interval, and a series rings at it, the more so the more opaque a hair is. Eight readings: "
         "the paper does not say how opaque its hair is, nor how much less than optimal the depth bounds of its FOM "
         "were, and \"nearly identical\" is read by the rms and by 99 % of the pixels.",
         values});
}

// Filters of three texels across, in place of the kernel that the paper does not name.
void kernel(const Context& context) {
    const results::Result result = context.run(
        hair_in_smoke,
        {R"(techniques=[{"type":"avsm","cells":"sample","nodes":12,"filter":"bilinear"},)"
         R"({"type":"avsm","cells":"sample","nodes":12,"filter":"footprint"}])",
         "receivers.filter_width=3", "reference.samples_per_pixel=64", "reference.queries=1024"},
        {"rays.resolution=128"});
    const results::LightResult& light = light_of(result);
    const Value bilinear = error_of(cell_of(light, "avsm", {"filter=bilinear"})),
                wider = error_of(cell_of(light, "avsm", {"filter=footprint"}));
    context.report->claims.push_back(
        {"figure 5 (caption)",
         "a filtering kernel of higher quality than the bilinear one substantially improves the shadow quality",
         fmt::format("AVSM 12: error rms against the exact light over 3 x 3 texels {} bilinear, {} as their mean",
                     to_text(bilinear), to_text(wider)),
         not_comparable(), "The paper names neither the kernel nor what it filters out, and shows no picture of it.",
         {bilinear, wider}});
}

}  // namespace

void pictures(const Context& context) {
    figure_3(context);
    figure_5(context);
    kernel(context);
}

}  // namespace shadowbench::claims::salvi

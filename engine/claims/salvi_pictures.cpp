// Salvi et al. 2010, section 5.1, figures 3 and 5: pictures that are hard to tell apart.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/salvi.h"
#include "claims/salvi_view.h"

namespace shadowbench::claims::salvi {
namespace {

// AVSM with 12 nodes beside a deep shadow map of tolerance 0.002, in a scene of opaque things and smoke.
void figure_3(const Context& context) {
    std::vector<double> to_deep, to_all, flip;
    for (int k = 0; k < seeds; ++k) {
        const View view(with_size(with_seeds(context.document(level), k), context), context);
        const render::Image twelve = view.picture("avsm"), deep = view.picture("deep");
        const Difference difference = view.difference(twelve, deep);
        to_deep.push_back(difference.rms);
        flip.push_back(difference.flip);
        to_all.push_back(view.difference(twelve, view.picture("uncompressed")).rms);
    }
    const Value rms = median_of(to_deep), all = median_of(to_all);
    context.report->claims.push_back(
        {"section 5.1, figure 3",
         "there is little perceptible difference between AVSM 12 and a deep shadow map of tolerance 0.002",
         fmt::format("the pictures differ by rms {}, mean FLIP {}", to_text(rms), to_text(median_of(flip))),
         judge_unnoticed(rms),
         "Smoke between opaque things in place of the game's level; both maps are filtered alike.",
         {rms}});
    context.report->claims.push_back({"section 5.1, figure 3",
                                      "the results for sampling the uncompressed data also look identical",
                                      fmt::format("AVSM 12 differs from the uncompressed map by rms {}", to_text(all)),
                                      judge_unnoticed(all),
                                      "In the same scenes.",
                                      {all}});
}

// Hair in smoke.
void figure_5(const Context& context) {
    std::vector<double> nodes, slices, terms, ratio;
    for (int k = 0; k < seeds; ++k) {
        nlohmann::json document = with_size(with_seeds(context.document(hair_in_smoke), k), context);
        document["techniques"] =
            nlohmann::json::parse(R"([{"type":"avsm","cells":"sample","nodes":12,"filter":"bilinear"},)"
                                  R"({"type":"opacity","cells":"sample","slices":32,"filter":"bilinear"},)"
                                  R"({"type":"fourier","cells":"sample","terms":16,"filter":"bilinear"},)"
                                  R"({"type":"uncompressed","filter":"bilinear"}])");
        const View view(document, context);
        const render::Image truth = view.picture("uncompressed");
        const auto rms = [&](const char* technique) { return view.difference(view.picture(technique), truth).rms; };
        nodes.push_back(rms("avsm"));
        slices.push_back(rms("opacity"));
        terms.push_back(rms("fourier"));
        ratio.push_back(nodes.back() / std::min(slices.back(), terms.back()));
    }
    const Value twelve = median_of(nodes), osm = median_of(slices), fom = median_of(terms), over = median_of(ratio);
    context.report->claims.push_back(
        {"figure 5 (caption)",
         "with hair in smoke AVSM 12 and uncompressed are nearly identical, and OSM 32 and FOM 16 show substantial "
         "artifacts",
         fmt::format(
             "pictures differ from the uncompressed one by rms {} against {} (OSM 32) and {} (FOM 16), where a grey "
             "level is {:.3g}; AVSM 12 over the better of the others: {}",
             to_text(twelve), to_text(osm), to_text(fom), grey_level, to_text(over)),
         both(both(judge_unnoticed(twelve), judge_much_less(over, exactly(1.0))),
              both(judge_less(exactly(grey_level), osm), judge_less(exactly(grey_level), fom))),
         "Artifacts are substantial only if they exceed a grey level, too. Slices smear a step over their interval, "
         "and a series rings at it. The paper's FOM had less than optimal depth bounds; here its bounds are those of "
         "all casters in the map.",
         {twelve, osm, fom, over}});
}

}  // namespace

void pictures(const Context& context) {
    figure_3(context);
    figure_5(context);
}

}  // namespace shadowbench::claims::salvi

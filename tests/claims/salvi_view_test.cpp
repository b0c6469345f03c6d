// Pictures through maps of one set of light rays. What `render` makes of the same scenario is the oracle.
#include "claims/salvi_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "claims/salvi.h"
#include "claims/salvi_streams.h"
#include "render/display.h"
#include "render/render.h"

namespace shadowbench::claims::salvi {
namespace {

nlohmann::json smoke() {
    return nlohmann::json::parse(R"({
        "name": "view",
        "scene": {"objects": [
            {"type": "smoke_column", "particles": 200, "extinction": 0.5, "seed": 3},
            {"type": "quad", "corner": [-3, 0, -3], "edge_u": [0, 0, 6], "edge_v": [6, 0, 0], "casts_shadow": false}]},
        "lights": [{"type": "directional", "direction": [-1, -1, -0.3]}],
        "rays": {"resolution": 64, "samples_per_pixel": 1, "pattern": "regular"},
        "receivers": {"type": "camera", "position": [1, 2, 7], "target": [0, 1.2, 0], "bias": 0.01},
        "reference": {"samples_per_pixel": 1, "queries": 16, "spread_seeds": 0},
        "techniques": [
            {"type": "avsm", "cells": "sample", "nodes": 4, "filter": "bilinear", "order": "captured"},
            {"type": "avsm", "cells": "sample", "nodes": 12, "filter": "bilinear"},
            {"type": "uncompressed", "filter": "bilinear"}]})");
}

struct Measuring {
    PaperReport report;
    Context context;

    Measuring() {
        context.quick = true;
        context.report = &report;
    }
};

TEST(SalviView, ShowsWhatRenderShows) {
    Measuring measuring;
    const View view(smoke(), measuring.context);
    render::RenderOptions options;
    options.size = base::Vec2i(128, 96);
    const render::Rendering rendering = render::render(smoke(), options, {});
    const render::Image pictures[] = {view.picture("avsm", {"nodes=4"}), view.picture("avsm", {"nodes=12"}),
                                      view.picture("uncompressed")};
    ASSERT_EQ(rendering.techniques.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const render::Image& expected = rendering.techniques[i].picture.shaded;
        ASSERT_EQ(pictures[i].pixels.size(), expected.pixels.size());
        for (std::size_t p = 0; p < expected.pixels.size(); ++p)
            for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(pictures[i].pixels[p][c], expected.pixels[p][c]);
    }
}

// By definition, over the pixels that are not the black background: here all of the lit ground and smoke.
TEST(SalviView, ADifferenceIsThatOfTheDisplayOverThePixelsThatSeeAnything) {
    Measuring measuring;
    const View view(smoke(), measuring.context);
    const render::Image a = view.picture("avsm", {"nodes=4"}), b = view.picture("uncompressed");
    double squares = 0.0;
    for (std::size_t p = 0; p < a.pixels.size(); ++p)
        for (int c = 0; c < 3; ++c)
            squares += std::pow(render::to_display(a.pixels[p][c]) - render::to_display(b.pixels[p][c]), 2.0);
    const double all = std::sqrt(squares / (3.0 * static_cast<double>(a.pixels.size())));
    EXPECT_GT(view.difference(a, b).rms, all) << "the background counts as equal";
    EXPECT_LT(view.difference(a, b).rms, 3.0 * all);
    EXPECT_EQ(view.difference(a, a).rms, 0.0);
    EXPECT_EQ(view.difference(a, a).flip, 0.0);
    EXPECT_EQ(view.difference(a, a).most, 0.0);
}

TEST(SalviView, WhatIsWrongInTheSameWayInTwoFramesDoesNotChange) {
    Measuring measuring;
    const View view(smoke(), measuring.context);
    const render::Image coarse = view.picture("avsm", {"nodes=4"}), truth = view.picture("uncompressed");
    const Frame wrong{coarse, truth}, right{truth, truth};
    EXPECT_EQ(view.change(wrong, wrong), 0.0);
    EXPECT_EQ(view.change(right, right), 0.0);
    EXPECT_DOUBLE_EQ(view.change(right, wrong), view.difference(coarse, truth).rms);
}

// The background is equal in both pictures, so of all pixels no more than of those that see anything differ by more.
TEST(SalviView, OnePixelInAHundredMayDifferByMore) {
    Measuring measuring;
    const View view(smoke(), measuring.context);
    const render::Image a = view.picture("avsm", {"nodes=4"}), b = view.picture("uncompressed");
    const double most = view.difference(a, b).most;
    std::size_t more = 0, as_much = 0;
    for (std::size_t p = 0; p < a.pixels.size(); ++p) {
        double largest = 0.0;
        for (int c = 0; c < 3; ++c) {
            const auto shown = [&](const render::Image& image) {
                return render::to_display(std::clamp(static_cast<double>(image.pixels[p][c]), 0.0, 1.0));
            };
            largest = std::max(largest, std::abs(shown(a) - shown(b)));
        }
        more += largest > most;
        as_much += largest >= most;
    }
    EXPECT_GT(most, 0.0);
    EXPECT_GT(as_much, more);
    EXPECT_LE(more, a.pixels.size() / 100);
}

TEST(SalviView, PerceptibleDifferencesAreReadInTwoWays) {
    SeededDifferences few, many;
    for (int k = 0; k < seeds; ++k) {
        few.add({0.001, 0.1, 0.003});
        many.add({0.001, 0.1, 0.01});
    }
    EXPECT_EQ(few.unnoticed().verdict, Verdict::holds);
    EXPECT_EQ(many.unnoticed().verdict, Verdict::undecided) << "at some pixels";
    EXPECT_EQ(few.text(), "rms 0.001, 99 % of the pixels by at most 0.003, mean FLIP 0.1");
    EXPECT_EQ(few.values()[1].value, 0.003);
}

TEST(SalviView, LimitsAreThoseOfTheRules) {
    EXPECT_EQ(judge_unnoticed(exactly(grey_level)).verdict, Verdict::holds);
    EXPECT_EQ(judge_unnoticed(exactly(1.001 * grey_level)).verdict, Verdict::fails);
    EXPECT_EQ(judge_fit(exactly(rough_fit)).verdict, Verdict::in_shape);
    EXPECT_EQ(judge_fit(exactly(1.001 * rough_fit)).verdict, Verdict::fails);
}

TEST(SalviView, MoreNodesAreNearerToTheCurvesOfAllTexels) {
    Measuring measuring;
    const MapErrors errors = map_errors(smoke(), measuring.context);
    ASSERT_EQ(errors.rms.size(), 3u);
    EXPECT_GT(errors.depth, 0.0);
    EXPECT_LT(errors.rms[1], errors.rms[0]);
    EXPECT_LT(errors.rms[2], 1e-4) << "uncompressed";
}

// Of texels that hold anything at all the oracle is what a run checks. Those that hold no more than the nodes store are
// exact, so without them errors are larger.
TEST(SalviView, TexelsThatHoldLittleDoNotCountAsComplex) {
    Measuring measuring;
    const View view(smoke(), measuring.context);
    const bench::Contender& twelve = view.contender("avsm", {"nodes=12"});
    const ComplexCurves any = complex_curves(view, twelve, 0), complex = complex_curves(view, twelve, 6),
                        all = complex_curves(view, view.contender("uncompressed"), 6);
    EXPECT_LT(complex.texels, any.texels);
    EXPECT_GT(complex.rms, any.rms);
    EXPECT_GT(complex.mean, any.mean);
    EXPECT_LE(complex.mean, complex.rms) << "a mean of what is largest";
    EXPECT_LT(all.rms, 1e-4);
    const MapErrors of_map = map_errors(smoke(), measuring.context);
    const double texels = 64.0 * 64.0;
    EXPECT_NEAR(any.rms * std::sqrt(static_cast<double>(any.texels) / texels), of_map.rms[1], 0.05 * of_map.rms[1])
        << "texels that hold nothing have no error";
    EXPECT_THROW(complex_curves(view, twelve, 100000), base::Error);
}

TEST(SalviView, LooserDepthBoundsChangeWhatSpreadsOverThem) {
    Measuring measuring;
    nlohmann::json document = smoke();
    document["techniques"].push_back(
        nlohmann::json::parse(R"({"type": "fourier", "terms": 8, "filter": "bilinear"})"));
    const View view(document, measuring.context);
    const bench::Contender& fourier = view.contender("fourier");
    const render::Image truth = view.picture("uncompressed"), within = view.picture("fourier"),
                        same = view.picture(view.build_within(fourier, 1.0)),
                        looser = view.picture(view.build_within(fourier, 4.0));
    EXPECT_EQ(view.difference(same, within).rms, 0.0);
    EXPECT_GT(view.difference(looser, truth).rms, view.difference(within, truth).rms);
}

TEST(SalviView, AFrameInTheCapturedOrderIsTheCapturedMap) {
    Measuring measuring;
    const View view(smoke(), measuring.context);
    const bench::Contender& streamed = view.contender("avsm", {"nodes=4"});
    const render::Image captured = view.picture("avsm", {"nodes=4"});
    const auto frame = [&](std::uint32_t window) {
        return view.picture(view.build(streamed, shuffled(view.tiles(), window, 1)));
    };
    EXPECT_EQ(view.difference(frame(1), captured).rms, 0.0);
    EXPECT_GT(view.difference(frame(~0u), captured).rms, 0.0);
}

TEST(SalviView, SeedsOfProceduralObjectsAreReplaced) {
    EXPECT_EQ(with_seeds(smoke(), 0), smoke());
    const nlohmann::json other = with_seeds(smoke(), 2);
    EXPECT_EQ(other["scene"]["objects"][0]["seed"], 2003);
    EXPECT_FALSE(other["scene"]["objects"][1].contains("seed"));
}

TEST(SalviView, AScenarioIsNotedOnce) {
    Measuring measuring;
    const View first(smoke(), measuring.context), other(with_seeds(smoke(), 1), measuring.context);
    ASSERT_EQ(measuring.report.documents.size(), 1u);
    EXPECT_TRUE(measuring.report.documents[0].starts_with("view "));
}

}  // namespace
}  // namespace shadowbench::claims::salvi

#include "bench/contender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "bench/curve_check.h"
#include "bench/fake_map.h"
#include "bench/half_covered.h"
#include "bench/memory.h"
#include "curves/sweep.h"
#include "errors.h"
#include "rays/scenes.h"

namespace shadowbench::bench {
namespace {

// A fake technique on the half covered map with the layer over the whole map, so that all pixels have the same
// function.
class Contenders : public ::testing::Test {
protected:
    results::Cell judge(const FakeAnswers& answers) {
        fake_answers = answers;
        std::vector<Contender> contenders(1);
        contenders[0].row = &fake_technique();
        const techniques::BuildInput input{layout_, half_.view, nullptr};
        build_all(contenders, source_, input, MemoryLimits{}.all, {});
        check_functions(contenders, source_, layout_, {});
        const techniques::Query judged[] = {{1.5f, 1.5f, 2.0f, 1.0f}, {6.5f, 3.5f, 2.0f, 1.0f}};
        const Truth truth{1, {0.4, 0.4}, {0.0, 0.0}};
        check_lookups(contenders, judged, truth);
        return contenders[0].cell;
    }

    const curves::Curve true_function_{{1.0f, 1.0f}, {1.0f, 0.4f}, {3.0f, 0.4f}, {3.0f, 0.0f}};
    HalfCovered half_ = half_covered(1.5);
    rays::MapLayout layout_ = rays::make_layout(half_.scene, half_.view, half_.settings);
    rays::Capture capture_{half_.scene, half_.view, layout_};
    RaySource source_{capture_, layout_, std::size_t{1} << 30, {}};
};

TEST_F(Contenders, that_answer_exactly_are_ok) {
    const results::Cell cell = judge({.function = true_function_, .lookup = 0.45f});
    EXPECT_EQ(cell.status, results::CellStatus::ok) << cell.reason;
    ASSERT_TRUE(cell.curve && cell.lookup);
    EXPECT_EQ(cell.curve->cells, 64u);
    EXPECT_NEAR(cell.curve->norms.max, 0.0, 1e-6);
    EXPECT_NEAR(cell.lookup->norms.rms, 0.05, 1e-6);
    EXPECT_NEAR(cell.lookup->signed_mean, 0.05, 1e-6);
    EXPECT_EQ(cell.bytes, 100u);
    EXPECT_EQ(cell.working_bytes, 200u);
}

// Each pixel's function has two steps, so no function within the tolerance has fewer than four nodes.
TEST_F(Contenders, with_a_tolerance_have_their_nodes_beside_the_fewest) {
    std::vector<Contender> contenders;
    contenders.push_back(make_contender({"deep", R"({"tolerance": 0.02})", ""}, ""));
    contenders.push_back(make_contender({"shadow_map", "{}", ""}, ""));
    build_all(contenders, source_, {layout_, half_.view, nullptr}, MemoryLimits{}.all, {});
    check_functions(contenders, source_, layout_, {});
    const std::optional<results::FewestNodes>& over = contenders[0].cell.nodes.over_fewest;
    ASSERT_TRUE(over);
    EXPECT_EQ(over->cells, 64u);
    EXPECT_EQ(over->fewest, 4u * 64u);
    EXPECT_EQ(over->nodes, contenders[0].cell.nodes.total);
    EXPECT_FALSE(contenders[1].cell.nodes.over_fewest);
    // The short checks of an exploration do not ask for it, and must not search.
    const CheckedMap quick{&contenders[0].maps, contenders[0].promises, contenders[0].cell.error_bound};
    for (const CurveVerdict& verdict : check_curves(source_, layout_, std::span(&quick, 1), 64, {}))
        for (const NodesBesideFewest& tile : verdict.nodes) EXPECT_TRUE(tile.stored.empty());
}

TEST_F(Contenders, within_their_promised_error_are_ok) {
    curves::Curve near = true_function_;
    near[1].value = near[2].value = 0.392f;
    const results::Cell cell = judge({.function = near, .lookup = 0.4f});
    EXPECT_EQ(cell.status, results::CellStatus::ok) << cell.reason;
    EXPECT_NEAR(cell.curve->norms.rms, 0.008, 1e-6);
    EXPECT_NEAR(cell.curve->mean_l1, 0.016, 1e-5);
}

TEST_F(Contenders, beyond_their_promised_error_fail_with_the_first_pixel) {
    curves::Curve wrong = true_function_;
    wrong[1].value = wrong[2].value = 0.3f;
    const results::Cell cell = judge({.function = wrong, .lookup = 0.4f});
    EXPECT_EQ(cell.status, results::CellStatus::failed);
    EXPECT_NE(cell.reason.find("cell (0, 0)"), std::string::npos) << cell.reason;
    EXPECT_NE(cell.reason.find("0.1"), std::string::npos) << cell.reason;
    ASSERT_TRUE(cell.curve);  // what was measured is still shown
    EXPECT_NEAR(cell.curve->norms.max, 0.1, 1e-6);
    EXPECT_FALSE(cell.lookup);
}

TEST_F(Contenders, whose_function_rises_fail) {
    const results::Cell cell = judge({.function = {{1.0f, 0.4f}, {2.0f, 0.405f}}});
    EXPECT_EQ(cell.status, results::CellStatus::failed);
    EXPECT_NE(cell.reason.find("rises"), std::string::npos) << cell.reason;
}

TEST_F(Contenders, whose_function_leaves_the_unit_range_fail) {
    const results::Cell cell = judge({.function = {{1.0f, 1.0f}, {2.0f, -0.001f}}});
    EXPECT_NE(cell.reason.find("outside [0, 1]"), std::string::npos) << cell.reason;
}

TEST_F(Contenders, that_answer_nan_fail) {
    for (const float answer : {std::numeric_limits<float>::quiet_NaN(), 1.5f, -0.1f}) {
        const results::Cell cell = judge({.function = true_function_, .lookup = answer});
        EXPECT_EQ(cell.status, results::CellStatus::failed) << answer;
        EXPECT_NE(cell.reason.find("lookup"), std::string::npos) << cell.reason;
    }
}

TEST_F(Contenders, whose_values_promise_no_range_may_leave_it) {
    const FakeAnswers raw{.function = {{1.0f, 1.0f}, {1.0f, 1.005f}, {1.0f, 0.4f}, {3.0f, 0.4f}, {3.0f, 0.0f}},
                          .lookup = 1.2f,
                          .promises = {.monotone = false, .unit_range = false}};
    const results::Cell cell = judge(raw);
    EXPECT_EQ(cell.status, results::CellStatus::ok) << cell.reason;
    ASSERT_TRUE(cell.lookup);
    EXPECT_NEAR(cell.lookup->norms.max, 0.8, 1e-6);
    EXPECT_NEAR(cell.curve->rise, 0.005, 1e-6);
    FakeAnswers infinite = raw;
    infinite.lookup = std::numeric_limits<float>::infinity();
    EXPECT_EQ(judge(infinite).status, results::CellStatus::failed);
}

// A series or slices may err in between, but not before and behind all casters.
TEST_F(Contenders, that_promise_only_the_ends_fail_if_those_are_wrong) {
    const techniques::Promises ends{.localised = false, .leak = 0.004};
    const auto with = [&](curves::Curve function) {
        return judge({.function = std::move(function), .lookup = 0.4f, .promises = ends});
    };
    const results::Cell right = with({{1.0f, 1.0f}, {1.0f, 0.4f}, {3.0f, 0.395f}, {3.0f, 0.0039f}});
    EXPECT_EQ(right.status, results::CellStatus::ok) << right.reason;
    const results::Cell leaks = with({{1.0f, 1.0f}, {1.0f, 0.4f}, {3.0f, 0.395f}, {3.0f, 0.0041f}});
    EXPECT_EQ(leaks.status, results::CellStatus::failed);
    EXPECT_NE(leaks.reason.find("behind all that casts shadows it is 0.0041 instead of 0"), std::string::npos)
        << leaks.reason;
    const results::Cell dark = with({{1.0f, 0.995f}, {1.0f, 0.4f}, {3.0f, 0.4f}, {3.0f, 0.0f}});
    EXPECT_NE(dark.reason.find("before all that casts shadows it is 0.995 instead of 1"), std::string::npos)
        << dark.reason;
    EXPECT_EQ(with({}).status, results::CellStatus::failed) << "a function that is lit everywhere";
}

TEST_F(Contenders, that_may_be_dark_early_are_held_to_their_far_end) {
    const auto with = [&](techniques::Promises promises, float behind) {
        return judge({.function = {{1.0f, 0.9f}, {1.0f, 0.4f}, {3.0f, 0.4f}, {3.0f, behind}},
                      .lookup = 0.4f,
                      .promises = promises,
                      .error_bound = std::numeric_limits<double>::infinity()});
    };
    const results::Cell early = with({.localised = false, .approximate = true, .early = true, .leak = 0.1}, 0.09f);
    EXPECT_EQ(early.status, results::CellStatus::ok) << early.reason;
    EXPECT_EQ(with({.localised = false, .approximate = true, .early = true, .leak = 0.1}, 0.11f).status,
              results::CellStatus::failed);
    EXPECT_EQ(with({.approximate = true, .early = true, .leak = 0.1}, 0.11f).status, results::CellStatus::failed)
        << "an approximate technique is held to its ends, localised or not";
    EXPECT_EQ(with({.localised = false, .approximate = true, .leak = 0.1}, 0.09f).status, results::CellStatus::failed)
        << "dark before the first surface";
}

TEST_F(Contenders, that_are_dark_where_nothing_casts_a_shadow_fail) {
    std::vector<Contender> contenders(2);
    contenders[0].cell.lookup = results::LookupErrors{};
    contenders[1].cell.lookup = results::LookupErrors{{1e-3, 0, 0, 0}, 0};
    check_lit(contenders);
    EXPECT_TRUE(contenders[0].ok());
    EXPECT_FALSE(contenders[1].ok());
    EXPECT_NE(contenders[1].cell.reason.find("0.001"), std::string::npos) << contenders[1].cell.reason;
}

// Answers are stored channel after channel; the failure names the place of the query.
TEST_F(Contenders, whose_timed_answers_leave_the_unit_range_fail) {
    const techniques::Query asked[] = {{1.5f, 1.5f, 2.0f, 1.0f}, {6.5f, 3.5f, 2.0f, 1.0f}};
    Contender contender;
    check_answers(contender, asked, std::vector<float>{0.0f, 1.0f, 0.5f, 1.0f});
    EXPECT_TRUE(contender.ok()) << contender.cell.reason;
    check_answers(contender, asked, std::vector<float>{0.0f, 1.0f, 0.5f, std::numeric_limits<float>::quiet_NaN()});
    EXPECT_FALSE(contender.ok());
    EXPECT_NE(contender.cell.reason.find("(6.5, 3.5, 2)"), std::string::npos) << contender.cell.reason;
}

TEST_F(Contenders, that_refuse_the_layout_are_bad_input) {
    fake_answers = {.function = true_function_, .refuses_begin = true};
    std::vector<Contender> contenders(1);
    contenders[0].row = &fake_technique();
    contenders[0].cell.where = "/techniques/3";
    const techniques::BuildInput input{layout_, half_.view, nullptr};
    test::error_of([&] { check_served(contenders, input); }, base::ErrorCode::bad_input, "/techniques/3");
    test::error_of([&] { build_all(contenders, source_, input, MemoryLimits{}.all, {}); }, base::ErrorCode::bad_input,
                   "/techniques/3");
}

TEST_F(Contenders, are_judged_alike_if_the_rays_are_captured_again) {
    const RaySource recaptured(capture_, layout_, 0, {});
    EXPECT_FALSE(recaptured.kept());
    EXPECT_EQ(recaptured.segments(), source_.segments());
    std::size_t rays = 0;
    recaptured.for_each_batch(0, [&](RaySource::Batch batch) {
        for (const rays::LightRays& tile : batch) rays += tile.rays();
    });
    EXPECT_EQ(rays, source_.rays());
}

// A batch of few tiles leaves threads idle at its end; one of all would take memory in proportion to the map.
TEST_F(Contenders, get_more_tiles_at_a_time_from_several_threads_but_not_all) {
    rays::MapLayout layout = layout_;
    layout.width = layout.height = 16;
    layout.tile_width = layout.tile_height = 1;
    const rays::Capture capture(half_.scene, half_.view, layout);
    const auto batches = [&](int threads) {
        const base::ThreadLimit limit(threads);
        std::vector<std::size_t> sizes;
        RaySource(capture, layout, 0, {}).for_each_batch(0, [&](RaySource::Batch batch) {
            sizes.push_back(batch.size());
        });
        return sizes;
    };
    EXPECT_THAT(batches(1), ::testing::AllOf(::testing::SizeIs(64), ::testing::Each(4u)));
    EXPECT_THAT(batches(2), ::testing::ElementsAre(8u, 64u, 64u, 64u, 56u));
}

// A fake technique on a medium of optical depth 2 over the whole map.
class ContendersInAMedium : public ::testing::Test {
protected:
    ContendersInAMedium() {
        scene_.objects.emplace_back();
        scene_.objects[0].shape = rays::testing::slab();
        view_ = rays::make_light_view(rays::testing::directional(), scene_, {4, 4}, "");
        layout_ = rays::make_layout(scene_, view_, rays::testing::rays(4, 4));
        capture_.emplace(scene_, view_, layout_);
        source_.emplace(*capture_, layout_, std::size_t{1} << 30, RaySource::Watch{});
    }

    // The function of every pixel, too bright by up to `stray` halfway down.
    curves::Curve function(float stray) const {
        curves::SweepScratch scratch;
        curves::Curve curve;
        curves::visibility(capture_->tile(0), 0, 4, 0x1p-24, scratch, curve);
        const float end = curve.back().value, span = 1.0f - end;
        for (curves::Vertex& v : curve) v.value += stray * 4.0f * (1.0f - v.value) * (v.value - end) / (span * span);
        return curve;
    }

    results::Cell judge(float stray, double error_bound) {
        fake_answers = {.function = function(stray), .error_bound = error_bound};
        std::vector<Contender> contenders(1);
        contenders[0].row = &fake_technique();
        build_all(contenders, *source_, {layout_, view_, nullptr}, MemoryLimits{}.all, {});
        check_functions(contenders, *source_, layout_, {});
        return contenders[0].cell;
    }

    scene::Scene scene_;
    rays::LightView view_;
    rays::MapLayout layout_;
    std::optional<rays::Capture> capture_;
    std::optional<RaySource> source_;
};

TEST_F(ContendersInAMedium, are_held_to_promises_far_below_the_error_of_a_coarse_reference) {
    const results::Cell right = judge(0.0f, 1e-6);
    EXPECT_EQ(right.status, results::CellStatus::ok) << right.reason;
    ASSERT_TRUE(right.curve);
    EXPECT_EQ(right.curve->cells, 16u);
    EXPECT_LT(right.curve->reference_error, 1e-7);
    EXPECT_LT(right.curve->norms.max, 5e-7);
    const results::Cell wrong = judge(1e-5f, 1e-6);
    EXPECT_EQ(wrong.status, results::CellStatus::failed);
    EXPECT_NE(wrong.reason.find("above the promised 1e-06"), std::string::npos) << wrong.reason;
    ASSERT_TRUE(wrong.curve);
    EXPECT_NEAR(wrong.curve->norms.max, 1e-5, 1e-6);
}

TEST_F(ContendersInAMedium, with_wide_promises_have_the_coarse_reference) {
    const results::Cell cell = judge(1e-5f, 0.01);
    EXPECT_EQ(cell.status, results::CellStatus::ok) << cell.reason;
    ASSERT_TRUE(cell.curve);
    EXPECT_EQ(cell.curve->reference_error, 1e-4);
}

}  // namespace
}  // namespace shadowbench::bench

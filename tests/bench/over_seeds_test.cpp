#include "bench/over_seeds.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/fake_map.h"
#include "bench/half_covered.h"
#include "bench/ray_source.h"
#include "rays/capture.h"
#include "rays/tracer.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

// One light on the half-covered map, whose edge is inside a column of sample cells.
class OverSeeds : public ::testing::Test {
protected:
    OverSeeds() : half_(half_covered(0.1)), tracer_(half_.scene, true) {
        half_.settings.samples_per_pixel = 4;
        for (int i = 0; i < 200; ++i)
            queries_.push_back({0.04f * static_cast<float>(i), static_cast<float>(i % 8) + 0.5f, 2.0f, 1.0f});
    }

    rays::MapLayout layout() const { return rays::make_layout(half_.scene, half_.view, half_.settings); }
    Truth truth() const {
        scene::RaySettings settings = half_.settings;
        settings.samples_per_pixel = 256;
        settings.seed = 99;
        return reference_visibility(half_.scene, half_.view, settings, queries_, {});
    }
    Spread measure(int seeds, std::span<Contender> contenders) {
        const rays::MapLayout own = layout();
        const techniques::BuildInput input{own, half_.view, &tracer_};
        return measure_over_seeds({half_.scene, input, seeds, {}}, contenders, queries_, truth(), {});
    }
    // The light's own rays, as a run builds and judges them.
    void judge(const rays::MapLayout& layout, std::span<Contender> contenders) const {
        const rays::Capture capture(half_.scene, half_.view, layout);
        const RaySource source(capture, layout, std::size_t{1} << 30, {});
        build_all(contenders, source, {layout, half_.view, &tracer_}, MemoryLimits{}.all, {});
        check_lookups(contenders, queries_, truth());
    }

    HalfCovered half_;
    rays::Tracer tracer_;
    std::vector<Query> queries_;
};

std::vector<Contender> some_contenders() {
    std::vector<Contender> contenders;
    for (const char* type : {"deep", "uncompressed", "pcf", "variance", "ray_traced"})
        contenders.push_back(make_contender({type, "{}", ""}, ""));
    return contenders;
}

TEST_F(OverSeeds, gives_what_a_light_with_that_seed_gives) {
    std::vector<Contender> contenders = some_contenders();
    measure(3, contenders);
    for (int s = 0; s < 3; ++s) {
        rays::MapLayout other = layout();
        other.seed = base::hash(half_.settings.seed, static_cast<std::uint64_t>(s) + 1);
        std::vector<Contender> alone = some_contenders();
        judge(other, alone);
        for (std::size_t i = 0; i < alone.size(); ++i) {
            ASSERT_EQ(contenders[i].cell.over_seeds.size(), 3u) << contenders[i].cell.technique;
            const results::SeedErrors& seed = contenders[i].cell.over_seeds[static_cast<std::size_t>(s)];
            EXPECT_EQ(seed.bytes, alone[i].cell.bytes) << alone[i].cell.technique;
            EXPECT_EQ(seed.lookup.rms, alone[i].cell.lookup->norms.rms) << alone[i].cell.technique;
            EXPECT_EQ(seed.lookup.max, alone[i].cell.lookup->norms.max) << alone[i].cell.technique;
        }
    }
    for (const Contender& contender : contenders)
        EXPECT_NE(contender.cell.over_seeds[0].lookup.rms, contender.cell.over_seeds[1].lookup.rms)
            << contender.cell.technique << " must have other rays";
}

TEST_F(OverSeeds, does_not_depend_on_the_number_of_threads) {
    std::vector<double> values[2];
    for (const int threads : {1, 2}) {
        const base::ThreadLimit limit(threads);
        std::vector<Contender> contenders = some_contenders();
        const Spread spread = measure(2, contenders);
        judge(layout(), contenders);
        std::vector<double>& of = values[threads - 1];
        of = {spread.rms, spread.max};
        for (const Contender& contender : contenders) {
            of.push_back(contender.cell.lookup->interval->low);
            of.push_back(contender.cell.lookup->interval->high);
            for (const results::SeedErrors& seed : contender.cell.over_seeds) of.push_back(seed.lookup.rms);
        }
    }
    EXPECT_EQ(values[0], values[1]);
}

TEST_F(OverSeeds, interval_says_whether_it_covers_the_rays) {
    std::vector<Contender> contenders = some_contenders();
    measure(4, contenders);
    judge(layout(), contenders);
    std::vector<Contender> unmeasured = some_contenders();
    measure(1, unmeasured);
    judge(layout(), unmeasured);
    half_.settings.pattern = scene::Pattern::regular;
    std::vector<Contender> regular = some_contenders();
    measure(4, regular);
    judge(layout(), regular);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const results::Cell& all = contenders[i].cell;
        EXPECT_TRUE(all.lookup->interval->covers_rays) << all.technique;
        EXPECT_GT(all.lookup->interval->high - all.lookup->interval->low,
                  unmeasured[i].cell.lookup->interval->high - unmeasured[i].cell.lookup->interval->low)
            << all.technique;
        EXPECT_FALSE(unmeasured[i].cell.lookup->interval->covers_rays) << all.technique;
        EXPECT_TRUE(unmeasured[i].cell.over_seeds.empty()) << all.technique;
        EXPECT_TRUE(regular[i].cell.lookup->interval->covers_rays) << all.technique;
        EXPECT_TRUE(regular[i].cell.over_seeds.empty()) << all.technique;
    }
}

TEST_F(OverSeeds, fails_a_technique_that_fails_with_another_seed) {
    fake_answers = {.function = {{1.0f, 1.0f}}, .lookup = 2.0f};
    std::vector<Contender> contenders = some_contenders();
    contenders.emplace_back();
    contenders.back().row = &fake_technique();
    measure(2, contenders);
    for (std::size_t i = 0; i + 1 < contenders.size(); ++i) EXPECT_TRUE(contenders[i].ok());
    EXPECT_FALSE(contenders.back().ok());
    EXPECT_TRUE(contenders.back().cell.over_seeds.empty());
    EXPECT_EQ(contenders.back().cell.reason.rfind("with the rays of seed ", 0), 0u) << contenders.back().cell.reason;
    EXPECT_NE(contenders.back().cell.reason.find("answers 2"), std::string::npos) << contenders.back().cell.reason;
}

TEST_F(OverSeeds, spread_is_that_of_a_binomial_if_each_footprint_has_one_ray) {
    half_ = half_covered(0.125);  // the edge halves pixel 4
    half_.settings.samples_per_pixel = 1;
    for (int i = 0; i < 200; ++i) queries_[i] = {4.5f, static_cast<float>(i % 8) + 0.5f, 2.0f, 1.0f};
    EXPECT_NEAR(measure(64, {}).rms, 0.6 * 0.5, 0.02);
}

// The spread of a footprint without a ray is that of its nearest one.
TEST_F(OverSeeds, spread_of_narrow_footprints_is_that_of_the_nearest_ray) {
    half_ = half_covered(0.125);  // the edge halves pixel 4
    half_.settings.samples_per_pixel = 1;
    for (int i = 0; i < 200; ++i) queries_[i] = {4.5f, static_cast<float>(i % 8) + 0.5f, 2.0f, 1e-6f};
    EXPECT_NEAR(measure(64, {}).rms, 0.6 * 0.5, 0.02);
}

TEST_F(OverSeeds, spread_is_0_for_a_regular_pattern) {
    half_.settings.pattern = scene::Pattern::regular;
    const Spread spread = measure(4, {});
    EXPECT_EQ(spread.rms, 0.0);
    EXPECT_EQ(spread.max, 0.0);
}

}  // namespace
}  // namespace shadowbench::bench

#include "claims/seeded_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace shadowbench::claims {
namespace {

constexpr const char* two_deep_maps = R"(techniques=[{"type":"deep","tolerance":0},{"type":"deep","tolerance":0.2}])";

Context small_context(PaperReport& report) {
    Context context;
    context.scenarios = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios/papers";
    context.quick = true;
    context.report = &report;
    return context;
}

std::vector<std::string> small_ball(const char* techniques) {
    return {"/scene/objects/0/strands=500", "rays.samples_per_pixel=4", "receivers.resolution=[24,18]", techniques};
}

std::vector<float> answers(const bench::Maps& maps, const std::vector<techniques::Query>& queries) {
    return bench::lookup_all(maps, queries);
}

TEST(SeededLight, BuildsTheSameMapsForASeedAndOthersForAnother) {
    PaperReport report;
    const Context context = small_context(report);
    const SeededLight light(context, "lokovic2000_ball", small_ball(two_deep_maps), {"rays.resolution=32"});
    EXPECT_EQ(light.layout().width, 32);
    ASSERT_EQ(report.documents.size(), 1u);
    EXPECT_EQ(report.documents[0].rfind("lokovic2000_ball ", 0), 0u);
    const bench::QuerySet asked = light.queries();
    ASSERT_GT(asked.queries.size(), 100u);
    EXPECT_EQ(asked.footprints.size(), asked.queries.size());
    const auto first = light.build(0), again = light.build(0), other = light.build(1);
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(answers(first[0], asked.queries), answers(again[0], asked.queries));
    EXPECT_NE(answers(first[0], asked.queries), answers(other[0], asked.queries));
    EXPECT_LT(bench::nodes(first[1]).total, bench::nodes(first[0]).total);
}

TEST(SeededLight, KnowsTheTruthOfAnyQueries) {
    PaperReport report;
    const Context context = small_context(report);
    std::vector<std::string> set = small_ball(R"(techniques=[{"type":"deep","tolerance":0}])");
    set.push_back("reference.samples_per_pixel=64");
    const SeededLight light(context, "lokovic2000_ball", set, {"rays.resolution=32"});
    const bench::QuerySet asked = light.queries();
    std::vector<techniques::Query> behind_all, before_all;
    for (const techniques::Query& query : asked.queries) {
        behind_all.push_back({query.x, query.y, light.layout().z_max + 1.0f, 1.0f});
        before_all.push_back({query.x, query.y, light.layout().z_min - 1.0f, 1.0f});
    }
    const bench::Truth behind = light.truth(behind_all), before = light.truth(before_all);
    ASSERT_EQ(behind.value.size(), behind_all.size());
    const std::vector<float> answered = answers(light.build(0)[0], behind_all);
    double difference = 0.0;
    for (std::size_t q = 0; q < behind_all.size(); ++q) {
        EXPECT_EQ(before.value[q], 1.0);
        difference += std::abs(answered[q] - behind.value[q]) / static_cast<double>(behind_all.size());
    }
    EXPECT_LT(difference, 0.1);
}

TEST(SeededLight, TimesEachBuildAndThenTheCapture) {
    PaperReport report;
    const Context context = small_context(report);
    const SeededLight light(context, "lokovic2000_ball", small_ball(two_deep_maps), {"rays.resolution=16"});
    ASSERT_EQ(light.capture_place(), 2u);
    const Turns turns = light.build_turns({});
    ASSERT_EQ(turns.times.size(), 3u);
    for (const std::vector<double>& ms : turns.times) {
        EXPECT_EQ(ms.size(), build_rounds.least);
        for (const double one : ms) EXPECT_GT(one, 0.0);
    }
}

TEST(TimedMaps, AreTimedInTheOrderOfScenariosAndTechniques) {
    PaperReport report;
    const Context context = small_context(report);
    TimedMaps timed;
    timed.add(context, "lokovic2000_ball", small_ball(R"(techniques=[{"type":"pcf","num_samples":4}])"),
              {"rays.resolution=16"}, 200);
    timed.add(context, "lokovic2000_ball", small_ball(two_deep_maps), {"rays.resolution=16"}, 200);
    EXPECT_EQ(report.documents.size(), 2u);
    const Turns turns = timed.take({});
    ASSERT_EQ(turns.times.size(), 3u);
    for (const std::vector<double>& ns : turns.times) {
        EXPECT_EQ(ns.size(), lookup_rounds.least);
        for (const double one : ns) EXPECT_GT(one, 0.0);
    }
}

}  // namespace
}  // namespace shadowbench::claims

#include "claims/seeded_light.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace shadowbench::claims {
namespace {

std::vector<float> answers(const bench::Maps& maps, const std::vector<techniques::Query>& queries) {
    return bench::lookup_all(maps, queries);
}

TEST(SeededLight, BuildsTheSameMapsForASeedAndOthersForAnother) {
    PaperReport report;
    Context context;
    context.scenarios = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios/papers";
    context.quick = true;
    context.report = &report;
    const SeededLight light(context, "lokovic2000_ball",
                            {"/scene/objects/0/strands=500", "rays.samples_per_pixel=4", "receivers.resolution=[24,18]",
                             R"(techniques=[{"type":"deep","tolerance":0},{"type":"deep","tolerance":0.2}])"},
                            {"rays.resolution=32"});
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

}  // namespace
}  // namespace shadowbench::claims

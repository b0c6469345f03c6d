// Receivers outside a light's map, on the committed scenario.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/hard_case.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using techniques::Query;

// The spot is at the origin and looks along -z; its near plane is at 0.5, a quad of opacity 3/4 at 1.
TEST(HardReceivers, BehindTheLightAndOutsideItsMapEverythingIsLit) {
    const HardCase hard("receivers");
    std::vector<Query> queries;
    for (const Vec3d& place :
         {Vec3d(0, 0, 0), Vec3d(0, 0, 1), Vec3d(0.1, -0.2, 3), Vec3d(0, 0, 1e6), Vec3d(1, 0, 0), Vec3d(0.1, 0, -0.25),
          Vec3d(0.1, 0.1, -0.5), Vec3d(5, 0, -1), Vec3d(-5, 0, -3), Vec3d(0, 0.5, -1.25), Vec3d(1e9, 1e9, -1e9)})
        queries.push_back(hard.at(place));
    queries.push_back({-1e-30f, 8.0f, 3.0f, 1.0f});
    queries.push_back({16.0f, 8.0f, 3.0f, 1.0f});
    queries.push_back({8.0f, std::nanf(""), 3.0f, 1.0f});
    queries.push_back({8.0f, 8.0f, std::nanf(""), 1.0f});
    queries.push_back({8.0f, 8.0f, -INFINITY, 1.0f});
    for (const Contender& contender : hard.contenders()) {
        const std::vector<float> answers = lookup_all(contender.maps, {queries});
        for (std::size_t i = 0; i < queries.size(); ++i)
            EXPECT_EQ(answers[i], 1.0f) << contender.cell.technique << " " << contender.cell.parameters << ", " << i;
    }
}

TEST(HardReceivers, AtTheBorderOfTheMapAndFarBehindAllAnswersAreThoseOfTheWall) {
    const HardCase hard("receivers");
    const float wall = 1.0f, behind = std::nextafter(1.0f, 2.0f), border = std::nextafter(16.0f, 0.0f);
    std::vector<Query> queries;
    std::vector<long double> expected;
    for (const float x : {0.0f, 0.4f, border})
        for (const float y : {0.0f, 3.0f, border})
            for (const float z : {0.6f, wall, behind, 1.4f, 3.0f, 1e6f, 1e30f}) {
                queries.push_back({x, y, z, 1.0f});  // beside the ball in the middle
                expected.push_back(z > wall ? 0.25L : 1.0L);
            }
    hard.expect(queries, expected);
}

}  // namespace
}  // namespace shadowbench::bench

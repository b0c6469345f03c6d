#include "recommend/floors.h"

#include <gtest/gtest.h>

namespace shadowbench::recommend {
namespace {

Family faithful() {
    Family family{"deep", "deep", {{"resolution", {"16", "32"}}, {"samples_per_pixel", {"1", "4"}},
                                   {"tolerance", {"0.3", "0.2", "0.1", "0.05"}}}};
    family.faithful = true;
    return family;
}

Point point(std::size_t family, int own) {
    return {family, {1, 0, own}};
}

TEST(Floors, AreBoundsOnceFourFaithfulFamiliesHaveAccurateSettings) {
    Floors floors;
    Family depth_map = faithful();
    depth_map.faithful = false;
    for (std::size_t f = 0; f < 3; ++f) EXPECT_FALSE(floors.add(faithful(), point(f, 2), 0.1 + 0.01 * static_cast<double>(f)));
    EXPECT_FALSE(floors.add(faithful(), point(3, 1), 0.3)) << "its tolerance is coarse, so its error is not that of the rays";
    EXPECT_FALSE(floors.add(depth_map, point(4, 3), 0.3));
    EXPECT_FALSE(floors.add(faithful(), point(2, 3), 0.11)) << "the same family again";
    EXPECT_TRUE(floors.known().empty());
    const std::optional<Floor> floor = floors.add(faithful(), point(3, 3), 0.2);
    ASSERT_TRUE(floor);
    EXPECT_EQ(floor->resolution, 1);
    EXPECT_EQ(floor->samples, 0);
    EXPECT_EQ(floor->error, 0.1) << "the least of all";
}

TEST(Floors, AreHintsOnceOneFamilyIsAccurateOrThreeAreNot) {
    Floors floors;
    floors.add(faithful(), point(0, 0), 0.3);
    floors.add(faithful(), point(1, 0), 0.2);
    EXPECT_TRUE(floors.all().empty());
    floors.add(faithful(), point(2, 0), 0.25);
    ASSERT_EQ(floors.all().size(), 1u);
    EXPECT_EQ(floors.all()[0].error, 0.2);
    Floors accurate_one;
    accurate_one.add(faithful(), point(0, 3), 0.3);
    EXPECT_EQ(accurate_one.all().size(), 1u);
}

TEST(Floors, AreLoweredByWhatErrsLess) {
    Floors floors;
    for (std::size_t f = 0; f < 4; ++f) floors.add(faithful(), point(f, 3), 0.1);
    EXPECT_EQ(floors.known()[0].error, 0.1);
    EXPECT_FALSE(floors.add(faithful(), point(4, 3), 0.15)) << "it is not lower";
    ASSERT_TRUE(floors.add(faithful(), point(4, 2), 0.07));
    ASSERT_EQ(floors.known().size(), 1u);
    EXPECT_EQ(floors.known()[0].error, 0.07);
    const std::size_t version = floors.version();
    floors.add(faithful(), point(4, 2), 0.08);
    EXPECT_EQ(floors.version(), version);
}

}  // namespace
}  // namespace shadowbench::recommend

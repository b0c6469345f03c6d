#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/load.h"

namespace shadowbench::scene {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const Vec3f a(0, 0, 0), b(1, 0, 0), c(2, 0, 0);

TEST(MergeEqualPoints, KeepsTheLargerRadius) {
    Hair hair{{a, a, b, b, b, c}, {1, 2, 5, 3, 4, 6}, {0, 6}};
    merge_equal_points(hair);
    EXPECT_THAT(hair.points, ElementsAre(a, b, c));
    EXPECT_THAT(hair.radii, ElementsAre(2, 5, 6));
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 3u));
}

TEST(MergeEqualPoints, LeavesAPointThatReturnsAndStrandsThatTouch) {
    Hair hair{{a, b, a, a, b}, {1, 2, 3, 4, 5}, {0, 3, 5}};
    merge_equal_points(hair);
    EXPECT_THAT(hair.points, ElementsAre(a, b, a, a, b));
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 3u, 5u));
}

TEST(MergeEqualPoints, DropsStrandsOfOnePoint) {
    Hair hair{{a, a, b, c, c, a, b, b}, {1, 1, 1, 1, 1, 2, 3, 4}, {0, 2, 3, 5, 8}};
    merge_equal_points(hair);
    EXPECT_THAT(hair.points, ElementsAre(a, b));
    EXPECT_THAT(hair.radii, ElementsAre(2, 4));
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 2u));
}

TEST(MergeEqualPoints, MayLeaveNothing) {
    Hair hair{{a, a}, {1, 1}, {0, 2}};
    merge_equal_points(hair);
    EXPECT_THAT(hair.points, IsEmpty());
    EXPECT_THAT(hair.radii, IsEmpty());
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u));
    Hair none;
    merge_equal_points(none);
    EXPECT_THAT(none.strand_begin, IsEmpty());
}

}  // namespace
}  // namespace shadowbench::scene

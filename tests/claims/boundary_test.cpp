#include "claims/boundary.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace shadowbench::claims {
namespace {

constexpr int side = 200;

// A shadow with the shape of a disc, in a picture of which only some columns are seen.
std::vector<Shade> disc(double radius, int first_seen) {
    std::vector<Shade> pixels;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double dx = x + 0.5 - 0.5 * side, dy = y + 0.5 - 0.5 * side;
            pixels.push_back(x < first_seen                        ? Shade::unseen
                             : dx * dx + dy * dy < radius * radius ? Shade::shadowed
                                                                   : Shade::lit);
        }
    return pixels;
}

// The disc holds the middles of at most one row, and of one column, more or fewer than its diameter has pixels. Each is
// crossed twice.
TEST(Boundary, OfADiscIsItsCircumference) {
    for (const double radius : {30.0, 75.5})
        EXPECT_NEAR(boundary_length(disc(radius, 0), {side, side}), 2.0 * std::numbers::pi * radius,
                    std::numbers::pi + 1e-9);
}

TEST(Boundary, IsBetweenSeenPixels) {
    const double half = std::numbers::pi * 60.0;
    EXPECT_NEAR(boundary_length(disc(60.0, side / 2), {side, side}), half, 0.02 * half);
    EXPECT_EQ(boundary_length(disc(60.0, side), {side, side}), 0.0);
}

}  // namespace
}  // namespace shadowbench::claims

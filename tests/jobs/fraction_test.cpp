#include "service/jobs/fraction.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace shadowbench::service {
namespace {

const std::vector<const char*> measured = {"reference", "spread over seeds", "capture",       "build",
                                           "check",     "timing builds",     "timing lookups"};
const std::vector<const char*> pictured = {"view rays", "capture", "build", "lookup", "reference"};

TEST(JobFractions, GrowFromNothingToAll) {
    for (const bool pictures : {false, true}) {
        JobFraction fraction(4, pictures ? 2 : 0);
        double last = 0.0;
        const auto grows = [&](double now) {
            EXPECT_GT(now, last);
            EXPECT_LE(now, 1.0 + 1e-12);
            last = now;
        };
        for (const char* place : {"1/2 key", "1/2 rim", "2/2 key", "2/2 rim"})
            for (const char* stage : measured)
                for (std::size_t done = 1; done <= 4; ++done) grows(fraction.measuring({place, stage, done, 4}));
        if (pictures)
            for (const char* place : {"key", "rim"})
                for (const char* stage : pictured)
                    for (std::size_t done = 1; done <= 4; ++done) grows(fraction.picturing({place, stage, done, 4}));
        EXPECT_NEAR(last, 1.0, 1e-9);
    }
}

// Light rays that do not fit into memory are captured again for every pass.
TEST(JobFractions, NeverFall) {
    JobFraction fraction(1, 0);
    const double checked = fraction.measuring({"", "check", 4, 4});
    EXPECT_EQ(fraction.measuring({"", "capture", 1, 4}), checked);
    EXPECT_EQ(fraction.measuring({"", "a stage that is unknown", 1, 4}), checked);
    EXPECT_GT(fraction.measuring({"", "timing builds", 1, 4}), checked);
}

// Variants are loaded under places without a light. Each would count as a light that is done.
TEST(JobFractions, DoNotTakeLoadingForALight) {
    JobFraction with(4, 0), without(4, 0);
    for (const char* place : {"1/2 key", "1/2 rim", "2/2 key", "2/2 rim"}) {
        EXPECT_EQ(with.measuring({std::string(place).substr(0, 3), "load", 1, 1}),
                  without.measuring({place, "a stage that is unknown", 1, 1}));
        EXPECT_EQ(with.measuring({place, "timing lookups", 2, 4}), without.measuring({place, "timing lookups", 2, 4}));
    }
}

TEST(JobFractions, StayInRangeWhateverIsCounted) {
    JobFraction fraction(1, 0);
    EXPECT_LE(fraction.measuring({"a", "timing lookups", 9, 4}), 1.0 + 1e-12);
    EXPECT_LE(fraction.measuring({"b", "timing lookups", 0, 0}), 1.0 + 1e-12);
    EXPECT_LE(fraction.measuring({"c", "timing lookups", 4, 4}), 1.0 + 1e-12);
}

}  // namespace
}  // namespace shadowbench::service

#include "curves/fewest.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cases.h"
#include "curves/compress.h"
#include "curves/norms.h"

namespace shadowbench::curves {
namespace {

using cases::Case;

double error(CurveView a, CurveView b) {
    return distance(a, b, 0.0, 0.0).max;
}

// Whether all depths are the input's, as often as there: a step that the input lacks would be seen in smoke.
bool is_part_of_depths(CurveView part, CurveView whole) {
    const auto less = [](const Vertex& a, const Vertex& b) { return a.z < b.z; };
    return std::includes(whole.begin(), whole.end(), part.begin(), part.end(), less);
}

// Brute force: tries every choice of depths, with a step or without one at each, even where the input has none. The
// values that the last vertex of a choice can take are an interval, whose ends are corners of a polygon in the plane of
// the values at both ends of the segment to it; the corners are found as the intersections of all pairs of sides.
class BruteForce {
public:
    BruteForce(const Curve& curve, double tolerance) : tolerance_(tolerance) {
        for (const Vertex& v : curve) {
            if (groups_.empty() || groups_.back().z != v.z) groups_.push_back({v.z, v.value, v.value});
            groups_.back().after = v.value;
        }
        start_ = groups_.front().before;
    }

    std::size_t fewest() {
        best_ = 2 * groups_.size();
        for (std::size_t i = 0; i < groups_.size(); ++i) {  // level up to the first vertex
            const Group& at = groups_[i];
            if (start_ > at.before + tolerance_ + kTie) break;
            go_on(i, {start_, start_}, 1);
            if (start_ > at.after + tolerance_ + kTie) break;
        }
        return best_;
    }

private:
    static constexpr double kTie = 1e-11;
    struct Group {
        double z, before, after;
    };
    struct Range {
        double low, high;
        bool empty() const { return low > high + kTie; }
    };
    struct Side {  // a * from + b * to <= c
        double a, b, c;
    };

    // The value in front of group i can be any of `front`, the last of so many vertices.
    void go_on(std::size_t i, Range front, std::size_t vertices) {
        const Group& at = groups_[i];
        const Range both{std::max(front.low, at.before - tolerance_), std::min(front.high, at.after + tolerance_)};
        if (!both.empty()) leave(i, both, vertices);
        leave(i, {std::max(at.after - tolerance_, 0.0), std::min(at.after + tolerance_, front.high)}, vertices + 1);
    }

    void leave(std::size_t i, Range behind, std::size_t vertices) {
        const bool lit = vertices == 1 && start_ == 1.0;
        if (behind.low <= groups_.back().after + tolerance_ + kTie) best_ = std::min(best_, lit ? 0 : vertices);
        for (std::size_t j = i + 1; j < groups_.size() && vertices + 1 < best_; ++j) {
            const Range front = arrive(i, behind, j);
            if (!front.empty()) go_on(j, front, vertices + 1);
        }
    }

    Range arrive(std::size_t i, Range behind, std::size_t j) const {
        const double least = std::max(groups_[j].before - tolerance_, 0.0);
        std::vector<Side> sides = {{1, 0, behind.high},
                                   {-1, 0, -behind.low},
                                   {0, 1, groups_[j].before + tolerance_},
                                   {0, -1, -least},
                                   {-1, 1, 0}};  // does not rise
        for (std::size_t k = i + 1; k < j; ++k) {
            const double share = (groups_[k].z - groups_[i].z) / (groups_[j].z - groups_[i].z);
            sides.push_back({1 - share, share, groups_[k].after + tolerance_});
            sides.push_back({share - 1, -share, tolerance_ - groups_[k].before});
        }
        Range range{2.0, -1.0};
        for (std::size_t s = 0; s < sides.size(); ++s)
            for (std::size_t t = s + 1; t < sides.size(); ++t) {
                const double determinant = sides[s].a * sides[t].b - sides[t].a * sides[s].b;
                if (std::abs(determinant) < 1e-12) continue;
                const double from = (sides[s].c * sides[t].b - sides[t].c * sides[s].b) / determinant;
                const double to = (sides[s].a * sides[t].c - sides[t].a * sides[s].c) / determinant;
                const bool inside = std::all_of(sides.begin(), sides.end(), [&](const Side& side) {
                    return side.a * from + side.b * to <= side.c + kTie;
                });
                if (!inside) continue;
                range.low = std::min(range.low, to);
                range.high = std::max(range.high, to);
            }
        return range;
    }

    std::vector<Group> groups_;
    double tolerance_, start_;
    std::size_t best_ = 0;
};

// Up to seven depths, some with steps; all numbers are multiples of 1/64, so that ties are exact.
Curve on_a_grid(base::Random& random) {
    Curve curve;
    float z = 0.0f;
    int value = 64 - 16 * static_cast<int>(random.below(2));
    const std::uint64_t groups = 2 + random.below(6);
    for (std::uint64_t i = 0; i < groups; ++i, z += static_cast<float>(1 + random.below(3))) {
        for (const bool step : {false, true}) {
            if (step && random.below(2) == 0) continue;
            value -= std::min(value, static_cast<int>(random.below(step ? 20 : 9)));
            curve.push_back({z, static_cast<float>(value) / 64.0f});
        }
    }
    return curve;
}

TEST(CompressToFewest, BruteForceFindsNoFewer) {
    base::Random random(1);
    std::size_t saved = 0;
    for (int round = 0; round < 600; ++round) {
        const Curve curve = on_a_grid(random);
        const float tolerance = static_cast<float>(1 + random.below(6)) / 64.0f;
        const Curve compressed = compress_to_fewest(curve, tolerance);
        ASSERT_EQ(compressed.size(), BruteForce(curve, tolerance).fewest())
            << "round " << round << ": " << Case{curve, tolerance};
        ASSERT_LE(error(compressed, curve), tolerance + cases::rounding_of(curve))
            << "round " << round << ": " << Case{curve, tolerance};
        ASSERT_TRUE(is_part_of_depths(compressed, curve)) << "round " << round << ": " << Case{curve, tolerance};
        saved += compress(curve, tolerance).size() - compressed.size();
    }
    EXPECT_GT(saved, 20u) << "the comparison is idle where compress() has the fewest too";
}

RC_GTEST_PROP(CompressToFewest, StaysWithinTheToleranceOnBothSidesOfEveryStep, ()) {
    const Case c = *cases::any_case();
    RC_ASSERT(error(compress_to_fewest(c.curve, c.tolerance), c.curve) <= c.tolerance + cases::rounding_of(c.curve));
}

// More vertices than compress() would be no bound to measure it against.
RC_GTEST_PROP(CompressToFewest, GivesAVisibilityFunctionOfTheInputsDepthsThatIsNotLongerThanThatOfCompress, ()) {
    const Case c = *cases::any_case();
    const Curve compressed = compress_to_fewest(c.curve, c.tolerance);
    RC_ASSERT(compressed.size() <= compress(c.curve, c.tolerance).size());
    RC_ASSERT(is_visibility(compressed));
    RC_ASSERT(is_part_of_depths(compressed, c.curve));
}

// What lies before all occluders is lit.
RC_GTEST_PROP(CompressToFewest, StartsAtTheExactFirstValue, ()) {
    const Case c = *cases::any_case();
    RC_PRE(!c.curve.empty());
    RC_ASSERT(evaluate(compress_to_fewest(c.curve, c.tolerance), c.curve.front().z) == c.curve.front().value);
}

RC_GTEST_PROP(CompressToFewest, IntoTheInputsOwnMemoryWithUsedScratchGivesTheSame, ()) {
    const Case c = *cases::any_case(), other = *cases::any_case();
    FewestScratch scratch;
    Curve in_place = other.curve;
    compress_to_fewest(in_place, other.tolerance, scratch, in_place.data());
    in_place = c.curve;
    in_place.resize(compress_to_fewest(in_place, c.tolerance, scratch, in_place.data()));
    RC_ASSERT(in_place == compress_to_fewest(c.curve, c.tolerance));
}

// Metres or millimetres: a tolerance has no unit of depth.
RC_GTEST_PROP(CompressToFewest, ScalingDepthsByAPowerOfTwoScalesDepthsAlone, ()) {
    const Case c = *cases::any_case();
    const int power = *cases::full_range(rc::gen::inRange(-30, 31));
    Curve scaled = c.curve, expected = compress_to_fewest(c.curve, c.tolerance);
    RC_PRE(cases::scale_depths(scaled, power));
    cases::scale_depths(expected, power);
    RC_ASSERT(compress_to_fewest(scaled, c.tolerance) == expected);
}

// The middle of the slopes that reach depth 2 leaves 0.875 there, and nothing from 0.875 passes the windows at 3 and 4.
// From 0.85, which the tolerance allows too, a segment does, and ends at 0.25 at most.
const Curve bend{{0, 1}, {1, 0.9f}, {2, 0.9f}, {3, 0.5f}, {4, 0.29f}};

TEST(CompressToFewest, ChoosesTheEndOfASegmentForTheNextOne) {
    EXPECT_EQ(compress(bend, 0.05f).size(), 4u);
    const Curve compressed = compress_to_fewest(bend, 0.05f);
    ASSERT_EQ(compressed.size(), 3u);
    EXPECT_EQ(compressed[0], bend[0]);
    EXPECT_EQ(compressed[1].z, 2.0f);
    EXPECT_NEAR(compressed[1].value, 0.85, 1e-6);
    EXPECT_EQ(compressed[2].z, 4.0f);
    EXPECT_NEAR(compressed[2].value, 0.25, 1e-6);
    EXPECT_LE(error(compressed, bend), 0.05 + 0x1p-24);
}

// Without the limit a map of long functions would seem to hang.
TEST(CompressToFewest, GivesTheOutputOfCompressWhereItTakesTooManySteps) {
    FewestScratch scratch;
    Curve out(bend.size());
    out.resize(compress_to_fewest(bend, 0.05f, scratch, out.data()));
    EXPECT_EQ(out.size(), 3u);
    EXPECT_TRUE(scratch.complete);
    scratch.most_steps = 1;
    out.resize(bend.size());
    out.resize(compress_to_fewest(bend, 0.05f, scratch, out.data()));
    EXPECT_EQ(out, compress(bend, 0.05f));
    EXPECT_FALSE(scratch.complete);
    out.resize(compress_to_fewest(Curve{{1, 1}}, 0.05f, scratch, out.data()));
    EXPECT_TRUE(scratch.complete) << "of the last call";
}

// Few vertices for thousands of depths, where each segment may end almost anywhere.
TEST(CompressToFewest, EndsSoonOnThousandsOfDepthsAtALooseTolerance) {
    base::Random random(3);
    FewestScratch scratch;
    Curve curve;
    float value = 1.0f;
    for (int i = 0; i < 5000; ++i) {
        curve.push_back({static_cast<float>(i), value});
        value *= 1.0f - cases::number(random, 0.0, i / 500 % 2 == 0 ? 0.001 : 0.0001);
    }
    Curve out(curve.size());
    out.resize(compress_to_fewest(curve, 0.02f, scratch, out.data()));
    EXPECT_LE(out.size(), compress(curve, 0.02f).size());
    EXPECT_LE(error(out, curve), 0.02 + cases::rounding_of(curve));
    EXPECT_LE(scratch.bytes(), 5000u * 64 * 64) << "memory grows with the depths alone";
}

// Level for as long as the tolerance allows, then one segment: the first vertex need not be the input's first.
TEST(CompressToFewest, StartsLate) {
    const Curve curve{{0, 1}, {1, 0.95f}, {2, 0.92f}, {3, 0.5f}, {4, 0.1f}, {9, 0.1f}};
    EXPECT_EQ(compress_to_fewest(curve, 0.1f), (Curve{{2, 1}, {4, 0.1f}}));
}

TEST(CompressToFewest, AFallWithinTheToleranceOfALitFunctionNeedsNoVertex) {
    EXPECT_TRUE(compress_to_fewest(Curve{}, 0.02f).empty());
    EXPECT_TRUE(compress_to_fewest(Curve{{1, 1}, {1, 1}, {2, 1}}, 0.0f).empty());
    EXPECT_TRUE(compress_to_fewest(Curve{{1, 1}, {2, 0.99f}}, 0.02f).empty());
    EXPECT_EQ(compress_to_fewest(Curve{{1, 0.5f}, {2, 0.49f}}, 0.02f), (Curve{{1, 0.5f}}));
}

TEST(CompressToFewest, LargeStepsTakeTwoVerticesAndSmallOnesNone) {
    const Curve wall{{2, 1}, {2, 0}};
    EXPECT_EQ(compress_to_fewest(wall, 0.02f), wall);
    EXPECT_EQ(compress_to_fewest(Curve{{1, 1}, {2, 1}, {2, 0.4f}, {3, 0.4f}, {3, 0}, {4, 0}}, 0.02f),
              (Curve{{2, 1}, {2, 0.4f}, {3, 0.4f}, {3, 0}}));
    Curve stairs;
    for (int i = 0; i < 1000; ++i)
        for (int side = 0; side < 2; ++side)
            stairs.push_back({static_cast<float>(i), 1.0f - 0.001f * static_cast<float>(i + side)});
    EXPECT_EQ(compress_to_fewest(stairs, 0.01f).size(), 2u);
}

// Thousands of depths and dozens of segments, as in a pixel of hair or smoke.
TEST(CompressToFewest, LongFunctionsTakeFewerThanCompressDoes) {
    base::Random random(2);
    for (const bool surfaces : {false, true}) {
        std::size_t fewest = 0, plain = 0;
        for (int round = 0; round < 20; ++round) {
            Curve curve;
            float value = 1.0f;
            for (int i = 0; i < 800; ++i) {
                const float z = static_cast<float>(i);
                if (surfaces) curve.push_back({z, value});
                value *= 1.0f - cases::number(random, 0.0, i / 100 % 2 == 0 ? 0.02 : 0.002);
                curve.push_back({z, value});
            }
            const Curve compressed = compress_to_fewest(curve, 0.004f);
            ASSERT_LE(error(compressed, curve), 0.004 + cases::rounding_of(curve));
            ASSERT_TRUE(is_visibility(compressed));
            fewest += compressed.size();
            plain += compress(curve, 0.004f).size();
        }
        EXPECT_LT(fewest, plain) << surfaces;
    }
}

TEST(CompressToFewest, AToleranceThatIsNotANumberOrNegativeKeepsTheFunction) {
    const Curve curve{{1, 1}, {2, 0.9f}, {3, 0.2f}};
    EXPECT_EQ(compress_to_fewest(curve, -1.0f), curve);
    EXPECT_EQ(compress_to_fewest(curve, std::numeric_limits<float>::quiet_NaN()), curve);
}

// Input that breaks the contract must not hang or write past the output.
TEST(CompressToFewest, EndsOnFunctionsThatRiseOrAreNotNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const float values[] = {0.0f, 1.0f, 0.5f, nan, infinity, -infinity};
    base::Random random(6);
    FewestScratch scratch;
    for (int round = 0; round < 2000; ++round) {
        Curve curve;
        for (int i = 0; i < 8; ++i) curve.push_back({values[random.below(6)], values[random.below(6)]});
        const std::size_t count = curve.size();
        ASSERT_LE(compress_to_fewest(curve, 0.02f, scratch, curve.data()), count);
    }
}

}  // namespace
}  // namespace shadowbench::curves

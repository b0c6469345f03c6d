#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>

#include "techniques/any_rays.h"
#include "techniques/built.h"
#include "techniques/depths.h"
#include "techniques/multi_depth/select_depths.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using nlohmann::json;
using testing::map_of;
using testing::patchy_depths;

std::vector<float> chosen(Selection selection, std::vector<float> samples, std::size_t n) {
    std::vector<float> out(n);
    select_depths(selection, samples, out);
    return out;
}
using Depths = std::vector<float>;

TEST(SelectDepths, KeepsTheCellsOwnDepthWhateverElse) {
    const Depths samples{5, 1, 9, 3, 7, 2, 8, 4, 6};  // the first is the cell's own
    EXPECT_EQ(chosen(Selection::maximum, samples, 2), (Depths{5, 9}));
    EXPECT_EQ(chosen(Selection::minimum, samples, 2), (Depths{1, 5}));
    EXPECT_EQ(chosen(Selection::both, samples, 3), (Depths{1, 5, 9}));
    EXPECT_EQ(chosen(Selection::both, samples, 2), (Depths{5, 9}));
    EXPECT_EQ(chosen(Selection::both, samples, 4), (Depths{1, 5, 8, 9}));
    EXPECT_EQ(chosen(Selection::maximum, samples, 4), (Depths{5, 7, 8, 9}));
    EXPECT_EQ(chosen(Selection::minimum, samples, 3), (Depths{1, 2, 5}));
    for (const Selection s : {Selection::maximum, Selection::minimum, Selection::both, Selection::sorted})
        EXPECT_EQ(chosen(s, samples, 1), Depths{5});
}

TEST(SelectDepths, TakesTheMiddleOfEachSortedGroup) {
    // Groups of 9: {1 2 3} {4 5 6} {7 8 9}. The own depth stands for its group.
    EXPECT_EQ(chosen(Selection::sorted, {6, 1, 9, 3, 7, 2, 8, 4, 5}, 3), (Depths{2, 6, 8}));
    EXPECT_EQ(chosen(Selection::sorted, {1, 6, 9, 3, 7, 2, 8, 4, 5}, 3), (Depths{1, 5, 8}));
    EXPECT_EQ(chosen(Selection::sorted, {9, 1, 6, 3, 7, 2, 8, 4, 5}, 3), (Depths{2, 5, 9}));
    EXPECT_EQ(chosen(Selection::sorted, {2, 1}, 4), (Depths{1, 1, 2, 2})) << "fewer samples than groups";
}

TEST(SelectDepths, SortedGroupsAgreeWithTheirDefinition) {
    base::Random random(1);
    for (int trial = 0; trial < 3000; ++trial) {
        const std::size_t q = 1 + random.below(30), n = 1 + random.below(8);
        Depths samples;
        for (std::size_t i = 0; i < q; ++i) samples.push_back(static_cast<float>(random.below(12)));
        Depths sorted = samples;
        std::sort(sorted.begin(), sorted.end());
        const Depths found = chosen(Selection::sorted, samples, n);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
        if (q < n) continue;
        // One of every group: found[g] lies in group g, and the own depth is there, in the group that holds it first.
        std::size_t own = n;
        for (std::size_t g = 0; g < n; ++g) {
            const std::size_t first = g * q / n, last = (g + 1) * q / n;
            EXPECT_GE(found[g], sorted[first]);
            EXPECT_LE(found[g], sorted[last - 1]);
            for (std::size_t r = first; r < last && own == n; ++r)
                if (sorted[r] == samples[0]) own = g;
        }
        EXPECT_EQ(found[own], samples[0]);
    }
}

TEST(SearchRegion, IsASquareAroundTheCellItself) {
    for (const int side : {1, 3, 5, 7}) {
        const std::vector<Offset> offsets = search_region(side * side);
        EXPECT_EQ(offsets[0].x, 0);
        EXPECT_EQ(offsets[0].y, 0);
        std::set<std::pair<int, int>> cells;
        for (const Offset& o : offsets) {
            cells.insert({o.x, o.y});
            EXPECT_LE(std::max(std::abs(o.x), std::abs(o.y)), side / 2);
        }
        EXPECT_EQ(cells.size(), static_cast<std::size_t>(side * side));
    }
    for (const Offset& o : search_region(5)) EXPECT_LE(std::abs(o.x) + std::abs(o.y), 1) << "those with a common side";
}

// Every cell compared with its neighbours looked up one by one, also at the borders of tiles and of the map.
TEST(MultiDepth, MaximumAndMinimumAreThoseOfTheNeighbourhood) {
    constexpr int width = 40, height = 34;
    const std::vector<float> base = patchy_depths(width, height, 3);
    const CellGrid grid{width, height, 1.0f, 1.0f};
    const std::vector<float> found = select_all(Selection::both, 25, 3, grid, base);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Depths expected{base[grid.index(x, y)], no_depth, -no_depth};
            for (int v = std::max(y - 2, 0); v <= std::min(y + 2, height - 1); ++v)
                for (int u = std::max(x - 2, 0); u <= std::min(x + 2, width - 1); ++u) {
                    expected[1] = std::min(expected[1], base[grid.index(u, v)]);
                    expected[2] = std::max(expected[2], base[grid.index(u, v)]);
                }
            std::sort(expected.begin(), expected.end());
            const float* cell = &found[3 * grid.index(x, y)];
            ASSERT_EQ(Depths(cell, cell + 3), expected) << x << " " << y;
        }
}

TEST(MultiDepth, WithOneDepthAndOneSampleIsTheShadowMap) {
    constexpr int width = 90, height = 70;
    const std::vector<float> depths = patchy_depths(width, height, 5);
    const auto one = map_of("multi_depth", {{"n", 1}, {"kernel", 1}, {"bias", 0.07}}, width, height, depths);
    const auto plain = map_of("shadow_map", {{"bias", 0.07}}, width, height, depths);
    base::Random random(6);
    std::vector<Query> queries;
    for (int i = 0; i < 50000; ++i)
        queries.push_back({static_cast<float>(random.uniform(-1, width + 1)),
                           static_cast<float>(random.uniform(-1, height + 1)),
                           static_cast<float>(random.uniform(-1, 3)), static_cast<float>(random.uniform(0.1, 5))});
    for (const float z : depths) queries.push_back({33.3f, 30.2f, z + 0.07f, 1.0f});
    std::vector<float> a(queries.size()), b(queries.size());
    one.map->lookup(queries, a);
    plain.map->lookup(queries, b);
    EXPECT_EQ(a, b);
    EXPECT_EQ(one.map->bytes(), plain.map->bytes());
}

// The number of outcomes of PCF(k, n): Pagot et al. 2004, table 1. On a map of nothing but different depths every
// outcome occurs, and none beside them.
TEST(MultiDepth, ReachesExactlyTheOutcomesOfTable1) {
    const int table[5][8] = {{2, 3, 4, 5, 6, 7, 8, 9},
                             {5, 9, 13, 17, 21, 25, 29, 33},
                             {10, 19, 28, 37, 46, 55, 64, 73},
                             {17, 33, 49, 65, 81, 97, 113, 129},
                             {26, 51, 76, 101, 126, 151, 176, 201}};
    constexpr int side = 24;
    base::Random random(9);
    std::vector<float> depths(side * side);
    for (float& z : depths) z = static_cast<float>(random.uniform(1, 2));
    for (int kernel = 1; kernel <= 5; ++kernel)
        for (int n = 1; n <= 8; ++n) {
            const auto map = map_of("multi_depth", {{"n", n}, {"kernel", kernel}, {"select", "sorted"}, {"q", 25}},
                                    side, side, depths);
            std::vector<Query> queries;
            for (int i = 0; i < 60; ++i) {
                const float x = static_cast<float>(random.uniform(3, side - 3));
                const float y = static_cast<float>(random.uniform(3, side - 3));
                for (float z = 0.99f; z < 2.02f; z += 0.0025f) queries.push_back({x, y, z, 1.0f});
            }
            std::vector<float> visibility(queries.size());
            map.map->lookup(queries, visibility);
            const std::set<float> outcomes(visibility.begin(), visibility.end());
            EXPECT_EQ(static_cast<int>(outcomes.size()), table[kernel - 1][n - 1]) << "k " << kernel << "^2, n " << n;
            for (const float v : outcomes) {
                const double steps = v * static_cast<double>(n * kernel * kernel);
                EXPECT_NEAR(steps, std::round(steps), 1e-4);
            }
        }
}

TEST(MultiDepth, CountsTheStoredDepthsBeforeTheReceiver) {
    // A wall at 1 left of one at 2: the cells at the border keep both, those further away one of them three times.
    constexpr int side = 16;
    std::vector<float> depths;
    for (int i = 0; i < side * side; ++i) depths.push_back(i % side < 8 ? 1.0f : 2.0f);
    const auto map = map_of("multi_depth", {{"kernel", 1}}, side, side, depths);
    const auto at = [&](float x, float z) { return map.lookup(x, 8.5f, z); };
    EXPECT_FLOAT_EQ(at(7.5f, 1.5f), 1.0f / 3) << "own and minimum 1, maximum 2";
    EXPECT_FLOAT_EQ(at(8.5f, 1.5f), 2.0f / 3) << "own and maximum 2, minimum 1";
    EXPECT_EQ(at(6.5f, 1.5f), 0.0f);
    EXPECT_EQ(at(9.5f, 1.5f), 1.0f);
    EXPECT_EQ(at(7.5f, 1.0f), 1.0f) << "the wall itself is lit";
    EXPECT_EQ(at(7.5f, 2.5f), 0.0f);
    curves::Curve stored;
    map.map->stored(7, 8, 0, {}, stored);
    EXPECT_EQ(stored, (curves::Curve{{1, 1}, {1, 1.0f / 3}, {2, 1.0f / 3}, {2, 0}}));
}

TEST(MultiDepth, WhereNothingIsStandsFurtherThanEverything) {
    constexpr int side = 16;
    std::vector<float> depths;
    for (int i = 0; i < side * side; ++i) depths.push_back(i % side < 8 ? 1.0f : no_depth);
    const auto map = map_of("multi_depth", {{"kernel", 1}}, side, side, depths);
    const float far_depth = 1e30f;
    EXPECT_EQ(map.lookup(3.5f, 8.5f, far_depth), 0.0f);
    EXPECT_FLOAT_EQ(map.lookup(7.5f, 8.5f, far_depth), 1.0f / 3)
        << "the deepest around is nothing: never in its shadow";
    EXPECT_FLOAT_EQ(map.lookup(8.5f, 8.5f, far_depth), 2.0f / 3) << "the nearest around is the wall";
    EXPECT_EQ(map.lookup(12.5f, 8.5f, far_depth), 1.0f);
    EXPECT_EQ(map.map->nodes().histogram, (std::vector<std::uint64_t>{7 * side, side, side, 7 * side}));
    EXPECT_EQ(map.lookup(0.5f, 0.5f, far_depth), 0.0f) << "the map's border is no shadow's border";
}

TEST(MultiDepth, ItsTestAnswersWhatTheStoredFunctionSays) {
    constexpr int width = 50, height = 41;
    const auto map = map_of("multi_depth", {{"kernel", 1}, {"n", 5}, {"select", "sorted"}, {"storage", "tiles"}}, width,
                            height, patchy_depths(width, height, 8));
    curves::Curve stored;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            map.map->stored(x, y, 0, {}, stored);
            ASSERT_TRUE(curves::is_visibility(stored));
            std::vector<float> depths{0.5f, 1.5f, 3.0f};
            for (const curves::Vertex& v : stored) depths.push_back(v.z);
            for (const float z : depths)
                ASSERT_NEAR(map.lookup(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z),
                            curves::evaluate(stored, z), 1e-6);
        }
}

TEST(MultiDepth, SpreadsItsKernelOverTheWidthAskedFor) {
    constexpr int side = 64;
    std::vector<float> depths;
    for (int i = 0; i < side * side; ++i) depths.push_back(i % side < 32 ? 1.0f : no_depth);
    const json parameters{{"n", 1}, {"kernel", 4}};
    json spread = parameters;
    spread["region"] = "query";
    const auto adjacent = map_of("multi_depth", parameters, side, side, depths);
    const auto wide = map_of("multi_depth", spread, side, side, depths);
    EXPECT_EQ(adjacent.lookup(27.5f, 32.5f, 5.0f, 16.0f), 0.0f);
    EXPECT_EQ(wide.lookup(27.5f, 32.5f, 5.0f, 16.0f), 0.25f);
    EXPECT_EQ(adjacent.lookup(32.0f, 32.5f, 5.0f, 16.0f), 0.5f);
    EXPECT_EQ(wide.lookup(32.0f, 32.5f, 5.0f, 16.0f), 0.5f);
}

TEST(MultiDepth, PromisesAnErrorOnlyWhereACellStandsForItselfAlone) {
    const Technique& row = find("multi_depth", "");
    const auto bound = [&](const json& parameters) {
        return row.error_bound(read_parameters(row.parameters, parameters, ""), {});
    };
    EXPECT_EQ(bound({{"n", 1}}), 0.0);
    EXPECT_EQ(bound({{"n", 4}, {"q", 1}}), 0.0);
    EXPECT_EQ(bound({{"n", 2}}), std::numeric_limits<double>::infinity());
}

RC_GTEST_PROP(MultiDepth, AnswersAreCountsOverSortedDepthsThatHoldTheCellsOwn, ()) {
    const testing::HandRays given = *testing::any_rays({.media = false});
    const Technique& row = find("multi_depth", "");
    ParameterValues values = testing::defaults(row);
    const int n = *rc::gen::inRange(1, 9), side = *rc::gen::inRange(1, 5);
    values.values["n"] = static_cast<double>(n);
    values.values["kernel"] = static_cast<double>(side);
    values.values["q"] = static_cast<double>(*rc::gen::element(9, 1, 2, 25, 289));
    values.values["select"] = std::string(*rc::gen::element("both", "maximum", "minimum", "sorted"));
    values.values["storage"] = std::string(*rc::gen::element("raw", "tiles", "bounding_box"));
    const testing::HandMap hand_map = make_map(row, values, given);

    const auto outcomes = static_cast<float>(n * side * side);
    std::vector<Query> queries;
    for (const float z : testing::telling_depths(given))
        for (int y = 0; y < given.height; ++y) queries.push_back({0.3f, static_cast<float>(y) + 0.6f, z, 1.0f});
    for (const float answer : hand_map.lookup(queries)) {
        const float count = (1.0f - answer) * outcomes;
        RC_ASSERT(std::abs(count - std::round(count)) <= 1e-4f);
    }

    curves::Curve stored;
    hand_map.map->stored(0, 0, 0, {}, stored);
    RC_ASSERT(curves::is_visibility(stored));
    RC_ASSERT(stored.size() <= 2u * static_cast<std::size_t>(n));
    RC_ASSERT(std::is_sorted(stored.begin(), stored.end(), [](const auto& a, const auto& b) { return a.z < b.z; }));
    float own = no_depth;
    for (const testing::Segment& s : given.rays[0])
        if (s.through < 1.0f) own = std::min(own, s.front);
    if (own != no_depth)
        RC_ASSERT(std::any_of(stored.begin(), stored.end(), [own](const auto& v) { return v.z == own; }));
}

}  // namespace
}  // namespace shadowbench::techniques

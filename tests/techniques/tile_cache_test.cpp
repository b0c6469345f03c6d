#include "techniques/deep/tile_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <list>

#include "base/error.h"
#include "base/parallel.h"
#include "base/read_text.h"
#include "techniques/built.h"
#include "techniques/deep/deep.h"
#include "techniques/deep_levels.h"

namespace shadowbench::techniques {
namespace {

using testing::curve_of;
using testing::random_levels;
using testing::TestFile;

constexpr std::size_t padding = DeepLevel::padding * sizeof(float);

struct Access {
    int x, y, level;
};

// Anywhere in any level, or a walk by at most one pixel that sometimes changes level.
std::vector<Access> accesses(const std::vector<DeepLevel>& levels, bool coherent, int count) {
    base::Random random(17);
    std::vector<Access> result{{0, 0, 0}};
    for (int i = 1; i < count; ++i) {
        Access a = result.back();
        if (!coherent || random.below(50) == 0) a.level = static_cast<int>(random.below(levels.size()));
        const DeepLevel& level = levels[static_cast<std::size_t>(a.level)];
        a.x = coherent ? a.x + static_cast<int>(random.below(3)) - 1 : static_cast<int>(random.below(level.width));
        a.y = coherent ? a.y + static_cast<int>(random.below(3)) - 1 : static_cast<int>(random.below(level.height));
        a.x = std::clamp(a.x, 0, level.width - 1);
        a.y = std::clamp(a.y, 0, level.height - 1);
        result.push_back(a);
    }
    return result;
}

// A cache with the least recently used slot, as simple as possible.
struct ReferenceCache {
    std::size_t slots;
    std::list<std::size_t> tiles = {};
    std::uint64_t hits = 0, misses = 0;

    void use(std::size_t tile) {
        const auto at = std::find(tiles.begin(), tiles.end(), tile);
        if (at != tiles.end()) {
            ++hits;
            tiles.erase(at);
        } else {
            ++misses;
            if (tiles.size() == slots) tiles.pop_back();
        }
        tiles.push_front(tile);
    }
};

class Caches : public ::testing::TestWithParam<std::tuple<bool, std::size_t, int>> {};

TEST_P(Caches, AnswerAsTheMapInMemoryAndKeepTheirSlots) {
    const auto [coherent, slots, channels] = GetParam();
    const TestFile path;
    const auto levels = random_levels(61, 47, channels, 2);
    write_deep_file(path.path, levels, 8, {});
    const DeepFile file(path.path);
    std::size_t largest = 0;
    for (std::size_t t = 0; t < file.tiles(); ++t) largest = std::max(largest, file.tile_bytes(t));

    TileCache cache(file, slots);
    ReferenceCache reference{slots};
    base::Random random(3);
    for (const Access& a : accesses(levels, coherent, 5000)) {
        const DeepLevel& level = levels[static_cast<std::size_t>(a.level)];
        const DeepFunction function = cache.function(a.x, a.y, a.level);
        ASSERT_EQ(function.nodes, level.nodes(level.pixel(a.x, a.y)));
        ASSERT_EQ(function.channels, level.has_colour(level.pixel(a.x, a.y)) ? 3 : 1);
        for (int c = 0; c < channels; ++c) {
            const curves::Curve curve = curve_of(level, a.x, a.y, c);
            for (std::uint32_t i = 0; i < function.nodes; ++i) {
                ASSERT_EQ((curves::Vertex{function.depths[i], function.values(c)[i]}), curve[i]);
                ASSERT_EQ(evaluate(function, c, curve[i].z), curves::evaluate(curve, curve[i].z));
            }
            const float z = static_cast<float>(random.uniform(-2, 8));
            ASSERT_EQ(evaluate(function, c, z), curves::evaluate(curve, z));
        }
        reference.use(file.tile_of(a.x, a.y, a.level));
        ASSERT_EQ(cache.hits(), reference.hits);
        ASSERT_EQ(cache.misses(), reference.misses);
        ASSERT_LE(cache.tile_bytes(), slots * (largest + padding));
        ASSERT_LE(cache.bytes(), cache.most_bytes());
    }
    EXPECT_GT(cache.misses(), 10u);
    EXPECT_GT(cache.bytes(), cache.tile_bytes());
}

INSTANTIATE_TEST_SUITE_P(All, Caches,
                         ::testing::Combine(::testing::Bool(), ::testing::Values(1, 4, 100), ::testing::Values(1, 3)));

TEST(TileCache, ASlotGrowsToTheLargestTileAndNeverShrinks) {
    // One tile a pixel, of 1, 5 and 3 nodes.
    DeepLevel level{3, 1, 1, {0, 2, 12, 18}, std::vector<float>(18 + DeepLevel::padding, 0.5f), {}};
    const TestFile path;
    write_deep_file(path.path, std::vector{level}, 1, {});
    const DeepFile file(path.path);
    TileCache cache(file, 1);
    EXPECT_EQ(cache.tile_bytes(), 0u);
    cache.function(0, 0, 0);
    EXPECT_EQ(cache.tile_bytes(), 4u * (2 + 2) + padding);
    cache.function(1, 0, 0);
    EXPECT_EQ(cache.tile_bytes(), 4u * (2 + 10) + padding);
    EXPECT_EQ(cache.bytes(), cache.most_bytes()) << "the largest tile has been there";
    cache.function(2, 0, 0);
    EXPECT_EQ(cache.tile_bytes(), 4u * (2 + 10) + padding);
    EXPECT_EQ(cache.function(2, 0, 0).nodes, 3u);

    TileCache all(file, 7);
    EXPECT_EQ(all.slots(), 3u) << "no more than there are tiles";
    for (int x = 0; x < 3; ++x) all.function(x, 0, 0);
    EXPECT_EQ(all.tile_bytes(), 4u * (6 + 18) + 3 * padding);
    EXPECT_EQ(all.bytes(), all.most_bytes()) << "each slot keeps its tile";
}

// The floor of lookups reads the mapped file, since the memory of a slot may go.
TEST(TileCache, KnowsWhereAFunctionLiesInTheFile) {
    const TestFile path;
    write_deep_file(path.path, random_levels(21, 13, 3, 8), 8, {});
    const DeepFile file(path.path);
    TileCache cache(file, 2);
    for (int y = 0; y < 13; ++y)
        for (int x = 0; x < 21; ++x) {
            const DeepFunction f = cache.function(x, y, 0);
            ASSERT_EQ(cache.last_tile(), file.tile_of(x, y, 0));
            ASSERT_EQ(std::memcmp(cache.in_file(f.depths), f.depths, f.nodes * sizeof(float)), 0) << x << " " << y;
        }
}

TEST(TileCache, GoesOnAfterATileThatIsDamaged) {
    const TestFile path;
    const auto levels = random_levels(8, 4, 1, 5, 1);
    write_deep_file(path.path, levels, 4, {});
    std::string bytes = base::read_text(path.path);
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    testing::write_bytes(path.path, bytes);
    const DeepFile file(path.path);
    TileCache cache(file, 1);
    for (int i = 0; i < 3; ++i) {
        EXPECT_THROW(cache.function(7, 3, 0), base::Error);
        EXPECT_EQ(evaluate(cache.function(1, 2, 0), 0, 0.5f), curves::evaluate(curve_of(levels[0], 1, 2, 0), 0.5f));
    }
    EXPECT_EQ(cache.hits(), 0u);
    EXPECT_EQ(cache.misses(), 6u);
}

TEST(TileCache, EveryThreadHasItsOwnOverOneFile) {
    const TestFile path;
    const auto levels = random_levels(40, 40, 1, 5);
    write_deep_file(path.path, levels, 8, {});
    const DeepFile file(path.path);
    const auto walk = accesses(levels, false, 400);
    base::parallel_for(8, [&](std::size_t thread) {
        TileCache cache(file, 2 + thread);
        for (const Access& a : walk)
            EXPECT_EQ(evaluate(cache.function(a.x, a.y, a.level), 0, 1.0f),
                      curves::evaluate(curve_of(levels[static_cast<std::size_t>(a.level)], a.x, a.y, 0), 1.0f));
    });
}

TEST(TileCache, LookupsAverageThePixelsOfALevelUnderTheFootprint) {
    const TestFile path;
    const auto levels = random_levels(32, 24, 3, 9);
    write_deep_file(path.path, levels, 8, {});
    const DeepFile file(path.path);
    TileCache cache(file, 3);
    const auto mean = [&](int level, int x0, int x1, int y0, int y1, int channel, float z) {
        double sum = 0.0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
                sum += curves::evaluate(curve_of(levels[static_cast<std::size_t>(level)], x, y, channel), z);
        return sum / ((x1 - x0) * (y1 - y0));
    };
    const std::vector<Query> queries = {
        {7.5f, 3.5f, 0.8f, 1},    // one pixel
        {8, 8, 0.8f, 4},          // pixels 6 to 9, across four tiles
        {31.5f, 23.5f, 1.5f, 3},  // the corner: only pixels of the map
        {-1, 3, 0.8f, 4},         // outside
        {8, 8, 100, 4},           // behind all
    };
    std::vector<float> v(3 * queries.size());
    lookup(cache, {}, queries, {}, v);
    for (std::size_t c = 0; c < 3; ++c) {
        const int channel = static_cast<int>(c);
        const float* answer = v.data() + c * queries.size();
        EXPECT_EQ(answer[0], curves::evaluate(curve_of(levels[0], 7, 3, channel), 0.8f));
        EXPECT_NEAR(answer[1], mean(0, 6, 10, 6, 10, channel, 0.8f), 1e-6);
        EXPECT_NEAR(answer[2], mean(0, 30, 32, 22, 24, channel, 1.5f), 1e-6);
        EXPECT_EQ(answer[3], 1.0f);
        EXPECT_NEAR(answer[4], mean(0, 6, 10, 6, 10, channel, 100), 1e-6);
    }
    const std::vector<Query> wide = {{8, 8, 0.8f, 8}, {-1, 3, 0.8f, 8}};  // a pixel of level 2 covers 4 x 4
    std::vector<float> w(3 * wide.size());
    lookup(cache, {.mip = Mip::nearest}, wide, {}, w);
    EXPECT_NEAR(w[0], mean(2, 1, 3, 1, 3, 0, 0.8f), 1e-6);
    EXPECT_EQ(w[1], 1.0f);
}

TEST(TileCache, AnswersAsTheMapThatWasWritten) {
    const auto b = testing::build(find("deep", ""), testing::hairy_scene(true), rays::testing::directional(),
                                  rays::testing::rays(24, 16), R"({"tolerance": 0.02})");
    ASSERT_EQ(levels(*b.map).size(), 1u);
    const TestFile path;
    write_deep_file(path.path, levels(*b.map), 16, {});
    const DeepFile file(path.path);
    TileCache cache(file, 2);
    base::Random random(4);
    std::vector<Query> queries;
    for (int i = 0; i < 2000; ++i)
        queries.push_back({static_cast<float>(random.uniform(-1, 25)), static_cast<float>(random.uniform(-1, 25)),
                           static_cast<float>(random.uniform(0, 2)), i % 2 == 0 ? 1.0f : 4.0f});
    std::vector<float> read(queries.size()), kept(queries.size());
    lookup(cache, {}, queries, {}, read);
    b.map->lookup(queries, kept);
    for (std::size_t i = 0; i < queries.size(); ++i) EXPECT_EQ(read[i], kept[i]);
    EXPECT_TRUE(levels(*testing::build(find("avsm", ""), testing::hairy_scene(false), rays::testing::directional(),
                                       rays::testing::rays(4, 1))
                            .map)
                    .empty());
}

}  // namespace
}  // namespace shadowbench::techniques

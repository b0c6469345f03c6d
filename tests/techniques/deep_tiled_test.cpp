// Deep shadow maps with storage=tiled: in a file, looked up through a fixed number of tiles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "techniques/built.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/deep_file.h"
#include "techniques/live_bytes.h"
#include "temporary_folder.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using testing::build;
using testing::Built;

const Technique& deep() {
    return find("deep", "");
}

Built hair(const char* parameters) {
    return build(deep(), testing::hairy_scene(true), directional(), rays::testing::rays(64, 4), parameters);
}

std::vector<Query> some_queries(int count) {
    std::vector<Query> queries;
    base::Random random(1);
    for (int i = 0; i < count; ++i)
        queries.push_back({static_cast<float>(random.uniform(-1, 65)), static_cast<float>(random.uniform(-1, 65)),
                           static_cast<float>(random.uniform(0, 2)), static_cast<float>(random.uniform(0, 12))});
    return queries;
}

std::vector<float> answers(const Map& map, std::span<const Query> queries) {
    std::vector<float> out(queries.size());
    map.lookup(queries, out);
    return out;
}

// The tiles of level 0 that one-pixel lookups need.
std::set<std::pair<int, int>> tiles_of(std::span<const Query> queries) {
    std::set<std::pair<int, int>> tiles;
    for (const Query& q : queries) tiles.insert({static_cast<int>(q.x) / tile_side, static_cast<int>(q.y) / tile_side});
    return tiles;
}

// What section 5.4 is for: only the tiles that are accessed are loaded, and loaded once if they fit.
TEST(DeepTiled, LoadsOnlyTheTilesThatLookupsNeed) {
    const Built b = hair(R"({"storage": "tiled", "slots": 16})");
    EXPECT_EQ(tiles(*b.map)->tiles, 16u);
    EXPECT_EQ(tiles(*b.map)->misses, 0u) << "nothing is loaded before it is asked for";
    std::vector<Query> queries;
    base::Random random(5);
    for (int i = 0; i < 500; ++i)  // in five tiles of the lower left corner
        queries.push_back({static_cast<float>(random.below(16 * (i % 2 == 0 ? 3 : 1))) + 0.5f,
                           static_cast<float>(random.below(16 * (i % 2 == 0 ? 1 : 3))) + 0.5f, 1.0f, 1.0f});
    answers(*b.map, queries);
    ASSERT_EQ(tiles_of(queries).size(), 5u);
    const TileCounts counts = tiles(*b.map).value();
    EXPECT_EQ(counts.misses, 5u);
    EXPECT_EQ(counts.hits + counts.misses, queries.size());
    EXPECT_LT(counts.slot_bytes, counts.file_bytes / 2);
}

TEST(DeepTiled, HoldsItsSlotsAndTheDirectoryAndNothingOfTheMap) {
    for (const char* parameters :
         {R"({"storage": "tiled", "slots": 1})", R"({"storage": "tiled", "slots": 4, "mip": "blend"})",
          R"({"storage": "tiled", "slots": 65536, "mip": "nearest"})"}) {
        const Built b = hair(parameters);
        const auto queries = some_queries(3000);
        const auto expected = answers(*b.map, queries);
        const std::size_t before = testing::live_bytes();
        auto map = deep().create(b.values);
        map->begin({b.rays.layout, b.rays.view, nullptr, 0});
        for (const auto& tile : b.rays.tiles) map->add(tile);
        map->finish();
        ASSERT_EQ(answers(*map, queries), expected);
        const auto held = static_cast<double>(testing::live_bytes() - before);
        const TileCounts counts = tiles(*map).value();
        EXPECT_NEAR(static_cast<double>(counts.held_bytes), held, 4096) << parameters;
        EXPECT_LE(counts.held_bytes, map->bytes()) << parameters;
        EXPECT_GT(2 * counts.held_bytes, map->bytes()) << parameters << ": every slot has been used";
        EXPECT_GE(map->working_bytes(), map->bytes());
        EXPECT_GE(map->bytes(), deep().least_bytes(b.values, b.rays.layout));
        EXPECT_EQ(map->bytes(), b.map->bytes()) << "it does not depend on the lookups";
    }
}

TEST(DeepTiled, TakesAsMuchMemoryAsItsSlotsAtTheLargestTile) {
    const Built memory = hair(R"({"tolerance": 0.002})");
    const Built tiled = hair(R"({"tolerance": 0.002, "storage": "tiled", "slots": 2})");
    const DeepLevel& level = levels(*memory.map)[0];
    std::size_t largest = 0;
    for (int y = 0; y < 64; y += tile_side)
        for (int x = 0; x < 64; x += tile_side) {
            std::size_t words = tile_side * tile_side + 1;
            for (int row = y; row < y + tile_side; ++row)
                words += level.offsets[level.pixel(x + tile_side - 1, row) + 1] - level.offsets[level.pixel(x, row)];
            largest = std::max(largest, words * sizeof(float));
        }
    EXPECT_GE(tiled.map->bytes(), 2 * largest);
    EXPECT_LE(tiled.map->bytes(), 2 * largest + 2048) << "and a directory of 16 tiles";
    EXPECT_LT(tiled.map->bytes(), memory.map->bytes());
    EXPECT_EQ(tiled.map->nodes().total, memory.map->nodes().total);
    EXPECT_TRUE(levels(*tiled.map).empty());
}

// There is one set of slots, whatever the number of threads.
TEST(DeepTiled, ThreadsShareTheSlots) {
    const Built b = hair(R"({"storage": "tiled", "slots": 2, "mip": "nearest"})");
    const Built memory = hair(R"({"mip": "nearest"})");
    const auto queries = some_queries(400);
    const auto expected = answers(*memory.map, queries);
    base::parallel_for(16, [&](std::size_t) { EXPECT_EQ(answers(*b.map, queries), expected); });
    EXPECT_EQ(tiles(*b.map)->slots, 2u);
    EXPECT_LE(tiles(*b.map)->held_bytes, b.map->bytes());
}

// The floor of lookups reads these addresses long after the slots hold other tiles.
TEST(DeepTiled, TouchedLinesStayReadable) {
    const Built b = hair(R"({"storage": "tiled", "slots": 1, "mip": "blend", "probes": 4})");
    std::vector<const void*> lines;
    std::size_t sum = 0;
    for (const Query& q : some_queries(300)) {
        b.map->touched(q, lines);
        b.map->touched_shaped(q, {6, 1, -1, 2}, lines);
    }
    answers(*b.map, some_queries(100));
    for (const void* line : lines) sum += *static_cast<const volatile unsigned char*>(line);
    EXPECT_LE(sum, 255 * lines.size());
    EXPECT_GT(lines.size(), 600u);
}

TEST(DeepTiled, LeavesNoFileBehind) {
    const TemporaryFolder folder;
    const char* const before = std::getenv("TMPDIR");
    const std::string old = before ? before : "";
    ::setenv("TMPDIR", folder.path().c_str(), 1);
    {
        const Built b = hair(R"({"storage": "tiled"})");
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "the open file has no name";
        EXPECT_FALSE(answers(*b.map, some_queries(10)).empty());
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));

    ::setenv("TMPDIR", folder.path("nowhere").c_str(), 1);
    try {
        hair(R"({"storage": "tiled"})");
        ADD_FAILURE() << "there is no such folder";
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
        EXPECT_NE(error.message().find("storage=memory"), std::string::npos) << error.message();
    }
    before ? ::setenv("TMPDIR", old.c_str(), 1) : ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace shadowbench::techniques

#include "techniques/store/depth_store.h"

#include <gtest/gtest.h>

#include "techniques/depths.h"

namespace shadowbench::techniques {
namespace {

using nlohmann::json;
using testing::map_of;
using testing::patchy_depths;

constexpr int width = 150, height = 110;  // not multiples of the tiles' side

std::vector<Query> random_queries(int count) {
    base::Random random(7);
    std::vector<Query> queries;
    for (int i = 0; i < count; ++i)
        queries.push_back({static_cast<float>(random.uniform(-2, width + 2)),
                           static_cast<float>(random.uniform(-2, height + 2)),
                           static_cast<float>(random.uniform(0.8, 2.4)), static_cast<float>(random.uniform(0.1, 9))});
    return queries;
}

std::vector<Footprint> random_footprints(std::size_t count) {
    base::Random random(8);
    const auto edge = [&] { return static_cast<float>(random.uniform(-4, 4)); };
    std::vector<Footprint> footprints;
    for (std::size_t i = 0; i < count; ++i) footprints.push_back({edge(), edge(), edge(), edge()});
    footprints[0] = {};
    return footprints;
}

class StorageOf : public ::testing::TestWithParam<const char*> {};

TEST_P(StorageOf, NeverChangesAnAnswer) {
    json parameters = json::parse(GetParam());
    const std::string type = parameters["type"];
    const std::vector<Query> queries = random_queries(20000);
    const std::vector<Footprint> footprints = random_footprints(queries.size());
    for (const std::uint64_t seed : {1, 2}) {
        const std::vector<float> depths = patchy_depths(width, height, seed);
        std::vector<float> raw(queries.size()), other(queries.size());
        const auto map = map_of(type.c_str(), parameters, width, height, depths);
        map.map->lookup_shaped(queries, footprints, raw);
        for (const char* storage : {"bounding_box", "tiles"}) {
            parameters["storage"] = storage;
            const auto stored = map_of(type.c_str(), parameters, width, height, depths);
            stored.map->lookup_shaped(queries, footprints, other);
            EXPECT_EQ(raw, other) << storage;
            std::vector<const void*> lines;
            for (std::size_t i = 0; i < 500; ++i) stored.map->touched_shaped(queries[i], footprints[i], lines);
            std::size_t sum = 0;  // reading these addresses must be allowed, which the address sanitizer checks
            for (const void* line : lines) sum += *static_cast<const volatile unsigned char*>(line);
            EXPECT_GT(lines.size(), 100u) << sum;
            EXPECT_EQ(map.map->nodes().histogram, stored.map->nodes().histogram);
            curves::Curve a, b;
            for (int i = 0; i < 500; ++i) {
                map.map->stored(i % width, i % height, 0, {}, a);
                stored.map->stored(i % width, i % height, 0, {}, b);
                ASSERT_EQ(a, b);
            }
        }
        parameters.erase("storage");
    }
}

class TilesOfFilters : public ::testing::TestWithParam<const char*> {};

// A lookup before or behind everything reads only the directory of tiles, not their cells.
TEST_P(TilesOfFilters, SpareTheCellsThatTheirBoundsTellOf) {
    json parameters = json::parse(GetParam());
    const std::string type = parameters["type"];
    parameters["storage"] = "tiles";
    constexpr int side = 96;
    base::Random random(3);
    std::vector<float> depths(side * side);
    for (float& z : depths) z = static_cast<float>(random.uniform(1, 2));
    const auto map = map_of(type.c_str(), parameters, side, side, depths);
    const auto lines = [&](float z) {
        std::vector<const void*> read;
        map.map->touched({48.0f, 48.0f, z, 1.0f}, read);
        return read.size();
    };
    EXPECT_LE(lines(0.9f), 3u);  // 9 tiles of 12 bytes
    EXPECT_LE(lines(2.4f), 3u);
    EXPECT_GT(lines(1.6f), lines(2.4f));
}

INSTANTIATE_TEST_SUITE_P(
    Techniques, StorageOf,
    ::testing::Values(R"({"type": "shadow_map"})", R"({"type": "shadow_map", "bias": 0.1})", R"({"type": "pcf"})",
                      R"({"type": "pcf", "bias0": 0.05, "bias1": 0.3})",
                      R"({"type": "pcf", "placement": "uniform", "bias1": 0.2})",
                      R"({"type": "pcf", "placement": "gaussian", "bias1": 0.2})",
                      R"({"type": "pcf", "placement": "shape", "region": "pixel", "bias1": 0.2})",
                      R"({"type": "pcf", "region": "pixel", "min_size": 0})",
                      R"({"type": "multi_depth", "bias": 0.05})",
                      R"({"type": "multi_depth", "n": 2, "select": "maximum"})",
                      R"({"type": "multi_depth", "n": 8, "select": "sorted", "q": 25, "region": "query"})"));

INSTANTIATE_TEST_SUITE_P(Techniques, TilesOfFilters,
                         ::testing::Values(R"({"type": "pcf"})", R"({"type": "pcf", "bias0": 0.05, "bias1": 0.3})",
                                           R"({"type": "pcf", "placement": "gaussian"})",
                                           R"({"type": "multi_depth", "bias": 0.05})",
                                           R"({"type": "multi_depth", "n": 8, "select": "sorted", "q": 25})"));

TEST(DepthStore, ReadsEveryCellAsItWasGiven) {
    const CellGrid grid{70, 45, 1.0f, 1.0f};
    for (const int n : {1, 3}) {
        base::Random random(3);
        std::vector<float> depths(grid.count() * n);
        for (float& z : depths) z = random.uniform() < 0.7 ? no_depth : static_cast<float>(random.uniform(1, 2));
        for (const Storage way : {Storage::raw, Storage::bounding_box, Storage::tiles}) {
            DepthStore store;
            store.keep(way, grid, n, std::vector<float>(depths));
            for (int y = 0; y < grid.height; ++y)
                for (int x = 0; x < grid.width; ++x)
                    for (int i = 0; i < n; ++i)
                        ASSERT_EQ(store.at(x, y)[i], depths[grid.index(x, y) * n + i]) << x << " " << y;
        }
    }
}

TEST(DepthStore, BoundsHoldTheDepthsOfEveryRange) {
    const CellGrid grid{100, 70, 1.0f, 1.0f};
    std::vector<float> depths = patchy_depths(grid.width, grid.height, 4);
    for (std::size_t i = 0; i < depths.size(); ++i)
        if (i % 100 < 40) depths[i] = no_depth;
    base::Random random(5);
    for (const Storage way : {Storage::bounding_box, Storage::tiles}) {
        DepthStore store;
        store.keep(way, grid, 1, std::vector<float>(depths));
        int exact_bounds = 0;
        for (int i = 0; i < 2000; ++i) {
            CellRange r;
            r.x0 = static_cast<int>(random.below(90));
            r.y0 = static_cast<int>(random.below(60));
            r.x1 = r.x0 + 1 + static_cast<int>(random.below(10));
            r.y1 = r.y0 + 1 + static_cast<int>(random.below(10));
            DepthBounds exact{no_depth, -no_depth};
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) {
                    exact.least = std::min(exact.least, depths[grid.index(x, y)]);
                    exact.greatest = std::max(exact.greatest, depths[grid.index(x, y)]);
                }
            store.read([&](const auto& read) {
                if constexpr (std::decay_t<decltype(read)>::bounded) {
                    const DepthBounds bounds = read.bounds(r);
                    EXPECT_LE(bounds.least, exact.least);
                    EXPECT_GE(bounds.greatest, exact.greatest);
                    exact_bounds += bounds.least == exact.least;
                }
            });
        }
        EXPECT_GT(exact_bounds, 500) << "bounds that are never exact save nothing";
    }
}

TEST(DepthStore, KeepsNoBytesForWhatIsEmpty) {
    const CellGrid grid{128, 96, 1.0f, 1.0f};
    std::vector<float> depths(grid.count(), no_depth);
    for (int y = 40; y < 50; ++y)
        for (int x = 33; x < 40; ++x) depths[grid.index(x, y)] = 1.0f;  // inside one tile
    const auto bytes = [&](Storage way) {
        DepthStore store;
        store.keep(way, grid, 1, std::vector<float>(depths));
        return store.bytes();
    };
    EXPECT_EQ(bytes(Storage::raw), grid.count() * 4);
    EXPECT_EQ(bytes(Storage::bounding_box), 7u * 10 * 4);
    EXPECT_EQ(bytes(Storage::tiles), 32u * 32 * 4 + 4 * 3 * sizeof(DepthTile));
    depths.assign(grid.count(), no_depth);
    for (const Storage way : {Storage::bounding_box, Storage::tiles})
        EXPECT_EQ(bytes(way), least_store_bytes(way, grid, 1)) << "nothing at all";
}

}  // namespace
}  // namespace shadowbench::techniques

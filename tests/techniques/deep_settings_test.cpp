// What must hold for deep maps with all settings; conformance_test.cpp checks it for the defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "techniques/built.h"
#include "techniques/deep/segment_search.h"
#include "techniques/live_bytes.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using testing::build;
using testing::Built;

const Technique& deep() {
    return find("deep", "");
}

scene::Scene hair(bool coloured) {
    scene::Scene scene = testing::hairy_scene(true);
    if (coloured) scene.objects[0].opacity = base::Vec3f(0.7f, 0.3f, 0.5f);
    return scene;
}

std::vector<Query> some_queries(int count, double size) {
    std::vector<Query> queries;
    base::Random random(1);
    for (int i = 0; i < count; ++i)
        queries.push_back({static_cast<float>(random.uniform(-1, size + 1)),
                           static_cast<float>(random.uniform(-1, size + 1)), static_cast<float>(random.uniform(0, 2)),
                           static_cast<float>(std::exp(random.uniform(-2, 5)))});
    for (int i = 0; i < count; ++i)  // coherent ones
        queries.push_back({10.5f + static_cast<float>(i % 3), 9.5f, 0.5f + 1e-3f * static_cast<float>(i), 1.0f});
    queries.push_back({5.5f, 5.5f, std::numeric_limits<float>::quiet_NaN(), 1.0f});
    return queries;
}

std::vector<float> answers(const Map& map, std::span<const Query> queries) {
    std::vector<float> out(queries.size() * static_cast<std::size_t>(map.channels()));
    map.lookup(queries, out);
    return out;
}

class DeepSettings : public ::testing::TestWithParam<const char*> {};

TEST_P(DeepSettings, TheOrderOfTilesAndTheCompanyOfAQueryChangeNothing) {
    for (const bool coloured : {false, true}) {
        const Built b = build(deep(), hair(coloured), directional(), rays::testing::rays(80, 4), GetParam());
        ASSERT_GT(b.rays.tiles.size(), 1u);
        const auto again = deep().create(b.values);
        again->begin({b.rays.layout, b.rays.view, nullptr, 0});
        for (auto tile = b.rays.tiles.rbegin(); tile != b.rays.tiles.rend(); ++tile) again->add(*tile);
        again->finish();
        const std::vector<Query> queries = some_queries(400, 80);
        const std::vector<float> expected = answers(*b.map, queries);
        EXPECT_EQ(answers(*again, queries), expected);
        EXPECT_EQ(b.map->bytes(), again->bytes());
        for (const float v : expected) ASSERT_TRUE(v >= 0.0f && v <= 1.0f) << v;
        const std::size_t channels = static_cast<std::size_t>(b.map->channels());
        for (std::size_t i = 0; i < queries.size(); i += 7) {
            const std::vector<float> alone = answers(*b.map, {&queries[i], 1});
            for (std::size_t c = 0; c < channels; ++c) ASSERT_EQ(alone[c], expected[c * queries.size() + i]);
        }
    }
}

TEST_P(DeepSettings, BytesAreWhatTheMapHolds) {
    for (const bool coloured : {false, true}) {
        const Built b = build(deep(), hair(coloured), directional(), rays::testing::rays(64, 4), GetParam());
        const std::size_t before = testing::live_bytes();
        auto map = deep().create(b.values);
        map->begin({b.rays.layout, b.rays.view, nullptr, 0});
        for (const auto& tile : b.rays.tiles) map->add(tile);
        map->finish();
        const auto held = static_cast<double>(testing::live_bytes() - before);
        EXPECT_NEAR(static_cast<double>(map->bytes()), held, 4096 + 0.01 * held);
        EXPECT_GE(map->working_bytes(), map->bytes());
        EXPECT_GE(map->bytes(), deep().least_bytes(b.values, b.rays.layout));
    }
}

TEST_P(DeepSettings, AnEmptyMapHoldsTheLeastBytesAndIsLit) {
    scene::Scene scene;
    scene.objects.push_back(rays::testing::quad({-9, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    scene.objects.push_back(rays::testing::quad({9, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    for (const float blue : {1.0f, 0.5f}) {
        scene.objects[0].opacity = base::Vec3f(1.0f, 1.0f, blue);
        const Built b = build(deep(), scene, directional(), rays::testing::rays(13, 4), GetParam());
        EXPECT_EQ(b.map->bytes(), deep().least_bytes(b.values, b.rays.layout));
        for (const float v : answers(*b.map, some_queries(100, 13))) ASSERT_EQ(v, 1.0f);
    }
}

TEST_P(DeepSettings, TouchedLinesLieInTheMap) {
    for (const bool coloured : {false, true}) {
        const Built b = build(deep(), hair(coloured), directional(), rays::testing::rays(32, 4), GetParam());
        std::size_t sum = 0;
        std::vector<const void*> lines;
        for (const Query& q : some_queries(100, 32)) b.map->touched(q, lines);
        for (const void* line : lines) sum += *static_cast<const volatile unsigned char*>(line);
        EXPECT_LE(sum, 255 * lines.size());
        EXPECT_GT(lines.size(), 200u);
    }
}

TEST_P(DeepSettings, GivenFunctionsKeepTheirPlaces) {
    const std::vector<curves::Curve> functions = {{}, {{1, 1}, {1, 0.5f}, {2, 0.5f}, {2, 0}}, {{0, 1}, {10, 0}}};
    nlohmann::json parameters = nlohmann::json::parse(GetParam());
    parameters["tolerance"] = 0;
    const ParameterValues values = read_parameters(deep().parameters, parameters, "/techniques/0");
    const auto map = deep().from_curves(values, functions);
    EXPECT_EQ(map->cells(), Cells::pixel);
    EXPECT_EQ(map->channels(), 1);
    curves::Curve stored;
    map->stored(1, 0, 0, {}, stored);
    EXPECT_EQ(stored, functions[1]);
    map->stored(2, 0, 0, {}, stored);
    EXPECT_EQ(stored, functions[2]);
}

TEST_P(DeepSettings, AnswersAreTheSameWhateverTheSearch) {
    for (const bool coloured : {false, true}) {
        std::vector<float> expected;
        for (const char* search : {"binary", "linear", "cached"}) {
            nlohmann::json parameters = nlohmann::json::parse(GetParam());
            parameters["search"] = search;
            parameters["tolerance"] = 0.001;  // functions of many nodes
            const Built b =
                build(deep(), hair(coloured), directional(), rays::testing::rays(32, 16), parameters.dump().c_str());
            ASSERT_GT(b.map->nodes().max, 3 * DeepLevel::padding);
            const std::vector<float> found = answers(*b.map, some_queries(3000, 32));
            if (expected.empty()) expected = found;
            ASSERT_EQ(found, expected) << search;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Parameters, DeepSettings,
                         ::testing::Values(R"({})", R"({"filter": "gaussian", "radius": 1.5})",
                                           R"({"mip": "nearest", "search": "linear"})",
                                           R"({"mip": "blend", "kernel": "tent", "search": "cached"})",
                                           R"({"filter": "tent", "radius": 1.0, "mip": "blend"})",
                                           R"({"mip": "blend", "mip_from": "samples"})",
                                           R"({"compression": "optimal", "mip": "nearest"})"));

// Duplicated depths are steps; a NaN goes to the front.
TEST(SegmentSearch, AllFindTheFirstDepthThatIsNotLess) {
    base::Random random(2);
    CachedSearch cached(1000);
    for (std::uint32_t n = 1; n <= 70; ++n) {
        std::vector<float> depths;
        float z = 0.0f;
        for (std::uint32_t i = 0; i < n; ++i)
            depths.push_back(z += random.below(3) ? static_cast<float>(random.below(4)) : 0.0f);
        depths.resize(n + DeepLevel::padding, -1.0f);  // depths behind the last must not count
        for (float at = -1.0f; at < z + 2.0f; at += 0.5f) {
            const auto end = depths.begin() + n;
            const auto expected =
                static_cast<std::uint32_t>(std::lower_bound(depths.begin(), end, at) - depths.begin());
            ASSERT_EQ(BinarySearch()(depths.data(), n, at), expected) << n << " " << at;
            ASSERT_EQ(LinearSearch()(depths.data(), n, at), expected);
            const float other = static_cast<float>(random.uniform(-1, z + 1));  // moves the cache elsewhere
            ASSERT_EQ(cached(depths.data(), n, other), LinearSearch()(depths.data(), n, other));
            ASSERT_EQ(cached(depths.data(), n, at), expected);
        }
        const float nan = std::numeric_limits<float>::quiet_NaN();
        EXPECT_EQ(BinarySearch()(depths.data(), n, nan), 0u);
        EXPECT_EQ(LinearSearch()(depths.data(), n, nan), 0u);
        EXPECT_EQ(cached(depths.data(), n, nan), 0u);
    }
}

}  // namespace
}  // namespace shadowbench::techniques

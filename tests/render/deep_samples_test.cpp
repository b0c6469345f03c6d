#include "render/deep_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/random.h"
#include "render/recomposite.h"

namespace shadowbench::render {
namespace {

using curves::Curve;
using testing::composite;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using testing::Sample;

constexpr float front = -10.0f;

DeepBlock block_of(const std::vector<Curve>& functions) {
    DeepBlock block;
    block.channels = static_cast<int>(functions.size());
    EXPECT_TRUE(append_function(functions, front, block));
    return block;
}

std::vector<Sample> samples(const DeepBlock& block, std::size_t channel) {
    std::vector<Sample> result;
    for (std::size_t s = 0; s < block.z_front.size(); ++s)
        result.push_back({block.z_front[s], block.z_back[s], block.alpha[s * block.channels + channel]});
    return result;
}

Curve random_function(base::Random& random, bool starts_lower, bool ends_black) {
    Curve curve;
    double z = random.uniform(-1, 1), value = starts_lower ? 0.9 : 1.0;
    const std::uint64_t count = 1 + random.below(40);
    for (std::uint64_t i = 0; i < count; ++i) {
        curve.push_back({static_cast<float>(z), static_cast<float>(value)});
        if (random.below(2) == 0) z += random.uniform(0, 0.3);
        if (random.below(4) != 0) value *= random.below(8) == 0 ? 1e-3 : random.uniform(0.7, 1);
    }
    if (ends_black) curve.push_back({curve.back().z, 0.0f});
    return curve;
}

TEST(DeepSamples, StepsAreSurfacesAndSlopesAreMedia) {
    const DeepBlock block = block_of({{{1, 1}, {1, 0.5f}, {3, 0.25f}, {4, 0.25f}, {4, 0}}});
    EXPECT_THAT(block.z_front, ElementsAre(1, 1, 4));
    EXPECT_THAT(block.z_back, ElementsAre(1, 3, 4));
    EXPECT_THAT(block.alpha, ElementsAre(0.5f, 0.5f, 1));
}

TEST(DeepSamples, LitPixelsHaveNone) {
    EXPECT_TRUE(block_of({{}}).z_front.empty());
    EXPECT_TRUE((block_of({{{0, 1}, {5, 1}}}).z_front.empty()));
}

TEST(DeepSamples, FlatStretchesHaveNoneWhateverTheRoundingBefore) {
    Curve stairs;
    for (int i = 0; i < 50; ++i) {
        const float z = static_cast<float>(i);
        stairs.push_back({z, 1.0f - 0.013f * z});
        stairs.push_back({z, 1.0f - 0.013f * (z + 1)});
    }
    EXPECT_EQ(block_of({stairs}).z_front.size(), 50u);
    EXPECT_TRUE(block_of({{{0, 1}, {1, 1}, {1, 1e-12f}, {2, 0}}}).alpha[0] == 1.0f) << "and no sample behind it";
}

TEST(DeepSamples, DarknessFromTheFrontIsASurfaceThere) {
    EXPECT_THAT(block_of({{{1, 0.5f}}}).z_front, ElementsAre(front));
    const DeepBlock nearer = block_of({{{front - 1, 0.5f}, {1, 0.5f}}});
    ASSERT_EQ(nearer.z_front.size(), 1u);
    EXPECT_LT(nearer.z_front[0], front - 1);
    EXPECT_THAT(nearer.alpha, ElementsAre(0.5f));
}

TEST(DeepSamples, CompositeToTheFunctionsAtEveryVertexOfEveryChannel) {
    base::Random random(2);
    for (int i = 0; i < 300; ++i) {
        std::vector<Curve> functions(i % 2 == 0 ? 1 : 3);
        for (Curve& f : functions) f = random_function(random, i % 5 == 0, i % 3 == 0);
        if (i % 7 == 0) functions[0].clear();
        const DeepBlock block = block_of(functions);
        for (std::size_t c = 0; c < functions.size(); ++c)
            for (const Curve& other : functions)  // a channel keeps its value where another one has a vertex
                for (const curves::Vertex& v : other) {
                    EXPECT_NEAR(composite(samples(block, c), v.z, false), curves::evaluate(functions[c], v.z), 1e-6);
                    EXPECT_NEAR(composite(samples(block, c), v.z, true), curves::evaluate_behind(functions[c], v.z),
                                1e-6);
                }
    }
}

TEST(DeepSamples, RoundingDoesNotAddUpOverManySteps) {
    Curve stairs;
    for (int i = 0; i < 20000; ++i) {
        const float z = static_cast<float>(i);
        stairs.push_back({z, 1.0f - static_cast<float>(i) / 20000});
        stairs.push_back({z, 1.0f - static_cast<float>(i + 1) / 20000});
    }
    const std::vector<Sample> all = samples(block_of({stairs}), 0);
    for (const float z : {10000.5f, 19000.5f, 19990.5f, 20001.0f})
        EXPECT_NEAR(composite(all, z, false), curves::evaluate(stairs, z), 1e-6);
}

TEST(DeepSamples, FunctionsThatRiseAreRefusedAndLeaveNothing) {
    DeepBlock block;
    EXPECT_FALSE((append_function(std::vector<Curve>{{{0, 1}, {1, 0.5f}, {2, 0.6f}}}, front, block)));
    EXPECT_TRUE(block.z_front.empty() && block.z_back.empty() && block.alpha.empty());
    EXPECT_TRUE((append_function(std::vector<Curve>{{{0, 1}, {1, 0.5f}, {2, 0.5000001f}}}, front, block)))
        << "by rounding";
}

TEST(DeepSamples, OneRayAPixelKeepsItsSegments) {
    rays::LightRays tile;
    tile.width = 2;
    tile.height = 1;
    tile.begin = {0, 0, 3};
    tile.z_front = {1, 1, 2};
    tile.z_back = {1, 4, 3};  // overlapping media
    tile.transmittance = {0.75f, 0.5f, 0.25f};
    const DeepBlock block = samples_of_rays(tile);
    EXPECT_THAT(block.begin, ElementsAre(0u, 0u, 3u));
    EXPECT_EQ(block.z_front, tile.z_front);
    EXPECT_EQ(block.z_back, tile.z_back);
    EXPECT_THAT(block.alpha, ElementsAre(FloatEq(0.25f), FloatEq(0.5f), FloatEq(0.75f)));
}

TEST(DeepSamples, SeveralColouredRaysAreTheirMean) {
    rays::LightRays tile;
    tile.width = tile.height = 1;
    tile.samples = 2;
    tile.channels = 3;
    tile.begin = {0, 1, 2};
    tile.z_front = {1, 2};
    tile.transmittance = {0, 1, 0.5f, 0, 0, 0.5f};
    const DeepBlock block = samples_of_rays(tile);
    const double expected[3][2] = {{0.5, 0}, {1, 0.5}, {0.75, 0.5}};  // behind 1 and behind 2
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(composite(samples(block, c), 1.5f, false), expected[c][0], 1e-6);
        EXPECT_NEAR(composite(samples(block, c), 2.5f, false), expected[c][1], 1e-6);
    }
}

TEST(DeepSamples, MapsOfEveryTechniqueGiveTheirStoredFunctions) {
    base::Random random(9);
    std::vector<Curve> functions;
    for (int i = 0; i < 20; ++i) functions.push_back(random_function(random, false, i % 2 == 0));
    for (const techniques::Technique& row : techniques::all()) {
        if (!row.from_curves || !row.promises.monotone) continue;
        const auto values = techniques::read_parameters(row.parameters, nlohmann::json::object(), "");
        bench::Maps maps;
        maps.parts.push_back(row.from_curves(values, functions));
        const techniques::Map& map = *maps.parts[0];
        maps.layout = std::make_unique<rays::MapLayout>();
        rays::MapLayout& layout = *maps.layout;
        layout.width = static_cast<int>(functions.size());
        layout.z_min = -1;
        layout.z_max = 20;
        ASSERT_EQ(size_of(maps), base::Vec2i(layout.width, 1));
        const DeepBlock row_of_cells = samples_of_functions(maps, 0);
        ASSERT_EQ(row_of_cells.begin.size(), functions.size() + 1);
        const std::vector<Sample> all = samples(row_of_cells, 0);
        for (std::size_t p = 0; p < functions.size(); ++p) {
            Curve kept;
            map.stored(static_cast<int>(p), 0, 0, {}, kept);
            const std::vector<Sample> pixel(all.begin() + static_cast<std::ptrdiff_t>(row_of_cells.begin[p]),
                                            all.begin() + static_cast<std::ptrdiff_t>(row_of_cells.begin[p + 1]));
            for (const curves::Vertex& v : kept) {
                if (v.z <= layout.z_min) continue;
                EXPECT_NEAR(composite(pixel, v.z, false), curves::evaluate(kept, v.z), 1e-5) << row.id;
                EXPECT_NEAR(composite(pixel, v.z, true), curves::evaluate_behind(kept, v.z), 1e-5) << row.id;
            }
        }
    }
}

}  // namespace
}  // namespace shadowbench::render

// Blocks of lookups in a deep map of functions of every length. A search that lost the node before a segment, or read
// past the last function, would show here alone: the scenes of other tests have short functions.
#include <gtest/gtest.h>

#include <limits>

#include "base/random.h"
#include "base/simd_path.h"
#include "techniques/deep/deep_lookup.h"
#include "techniques/deep_levels.h"

namespace shadowbench::techniques {
namespace {

constexpr int width = 9, height = 7;

// Places in the map and around it; half of the depths are those of nodes, where a step shows on which side a search
// ends.
std::vector<Query> places(const DeepLevel& level, std::span<const float> widths, std::uint64_t seed) {
    base::Random random(seed);
    const auto any = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    const float last =
        level.floats.size() > DeepLevel::padding ? 0.3f * static_cast<float>(level.floats.size()) / 63 : 0;
    std::vector<Query> queries;
    for (int i = 0; i < 500; ++i) {  // no multiple of a block's length
        Query q{any(-0.3, width + 0.3), any(-0.3, height + 0.3), any(-2.0, last + 2.0),
                widths[static_cast<std::size_t>(random.below(widths.size()))]};
        const std::size_t pixel = level.pixel(std::clamp(static_cast<int>(q.x), 0, width - 1),
                                              std::clamp(static_cast<int>(q.y), 0, height - 1));
        if (level.nodes(pixel) > 0 && i % 2 == 0)
            q.z = level.floats[level.offsets[pixel] + random.below(level.nodes(pixel))];
        queries.push_back(q);
    }
    queries[3].z = std::numeric_limits<float>::quiet_NaN();
    queries[5].z = std::numeric_limits<float>::infinity();
    queries[8].z = -std::numeric_limits<float>::infinity();
    queries[13].x = queries[14].y = std::numeric_limits<float>::quiet_NaN();
    return queries;
}

std::vector<float> answers(const DeepLevel& level, const LookupRule& rule, std::span<const Query> queries,
                           std::size_t at_once) {
    std::vector<float> result(queries.size());
    for (std::size_t i = 0; i < queries.size(); i += at_once) {
        const std::size_t count = std::min(at_once, queries.size() - i);
        lookup({&level, 1}, rule, queries.subspan(i, count), {}, std::span(result).subspan(i, count));
    }
    return result;
}

float expected_at(const DeepLevel& level, const Query& q) {
    if (!(q.x >= 0.0f && q.y >= 0.0f && q.x < width && q.y < height)) return 1.0f;
    const curves::Curve curve = testing::curve_of(level, static_cast<int>(q.x), static_cast<int>(q.y), 0);
    return curve.empty() ? 1.0f : curves::evaluate(curve, q.z);
}

class DeepBlocks : public ::testing::TestWithParam<int> {  // the most nodes of a function
protected:
    ~DeepBlocks() override { base::set_simd_path(base::simd_paths().back()); }

    const DeepLevel level_ = testing::random_level(width, height, 1, static_cast<std::uint64_t>(GetParam()),
                                                   static_cast<std::uint64_t>(GetParam()));
};

TEST_P(DeepBlocks, OfSinglePixelsAreTheirFunctions) {
    const float narrow[] = {0.0f};
    const std::vector<Query> queries = places(level_, narrow, 1);
    for (const base::SimdPath path : base::simd_paths()) {
        base::set_simd_path(path);
        for (const Kernel kernel : {Kernel::box, Kernel::pixels}) {
            const std::vector<float> found = answers(level_, {.kernel = kernel}, queries, queries.size());
            for (std::size_t i = 0; i < queries.size(); ++i)
                EXPECT_EQ(found[i], expected_at(level_, queries[i])) << static_cast<int>(path) << ", query " << i;
        }
    }
}

TEST_P(DeepBlocks, AnswerAsLookupsOneByOne) {
    const float any[] = {0.0f, 0.4f, 1.0f, std::numeric_limits<float>::quiet_NaN()}, wide[] = {0.2f, 1.9f, 3.0f};
    for (const std::span<const float> widths : {std::span<const float>(any), std::span<const float>(wide)})
        for (const Kernel kernel : {Kernel::box, Kernel::tent, Kernel::pixels}) {
            const std::vector<Query> queries = places(level_, widths, 2);
            const std::vector<float> one_by_one = answers(level_, {.kernel = kernel}, queries, 1);
            for (const base::SimdPath path : base::simd_paths()) {
                base::set_simd_path(path);
                const std::vector<float> found = answers(level_, {.kernel = kernel}, queries, queries.size());
                for (std::size_t i = 0; i < queries.size(); ++i)
                    EXPECT_EQ(found[i], one_by_one[i]) << static_cast<int>(path) << ", query " << i;
            }
        }
}

// A map that holds nothing, one of a node, functions of one vector of depths, just above, of several halvings.
INSTANTIATE_TEST_SUITE_P(MostNodes, DeepBlocks, ::testing::Values(0, 1, 5, 16, 19, 40, 300));

TEST(DeepBlocks, OfOneRowAreTheMeansOfTwoPixels) {
    DeepLevel level = testing::random_level(40, 1, 1, 5);
    std::vector<Query> queries;
    for (int x = 0; x < 39; ++x) queries.push_back({static_cast<float>(x) + 0.75f, 0.5f, 1.0f, 1.0f});
    const std::vector<float> found = answers(level, {}, queries, queries.size());
    for (std::size_t x = 0; x < queries.size(); ++x) {
        double sum = 0.0;
        for (const int i : {0, 1}) {
            const curves::Curve curve = testing::curve_of(level, static_cast<int>(x) + i, 0, 0);
            sum += (i == 0 ? 0.75 : 0.25) * (curve.empty() ? 1.0 : curves::evaluate(curve, 1.0f));
        }
        EXPECT_EQ(found[x], static_cast<float>(sum)) << x;
    }
}

}  // namespace
}  // namespace shadowbench::techniques

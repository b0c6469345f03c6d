// Lookups in blocks, with each set of instructions that this machine has, answer with the bits of lookups one by one.
// Otherwise an answer would depend on the machine, or on the lookups beside it.
#include <gtest/gtest.h>

#include <limits>

#include "base/random.h"
#include "base/simd_path.h"
#include "techniques/any_rays.h"
#include "techniques/built.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

// Sets the path, and the best one again.
struct OnPath {
    explicit OnPath(base::SimdPath path) { base::set_simd_path(path); }
    ~OnPath() { base::set_simd_path(base::simd_paths().back()); }
};

// Places in the map and around it, with footprints of these widths.
std::vector<Query> places(std::span<const float> widths, int size, std::uint64_t seed) {
    base::Random random(seed);
    const auto any = [&](double low, double high) { return static_cast<float>(low + (high - low) * random.uniform()); };
    std::vector<Query> queries;
    for (int i = 0; i < 333; ++i)  // no multiple of a block's length
        queries.push_back({any(-0.5, size + 0.5), any(-0.5, size + 0.5), any(-2.0, 12.0),
                           widths[static_cast<std::size_t>(random.below(widths.size()))]});
    queries[7].x = std::numeric_limits<float>::quiet_NaN();
    queries[11].z = std::numeric_limits<float>::quiet_NaN();
    queries[40].z = std::numeric_limits<float>::infinity();
    queries[41].z = -std::numeric_limits<float>::infinity();
    queries[50].x = 3.0f;  // on borders of cells
    queries[50].y = 5.0f;
    return queries;
}

class LookupPaths : public ::testing::TestWithParam<const Technique*> {};

TEST_P(LookupPaths, AnswerAsLookupsOneByOne) {
    const Technique& row = *GetParam();
    if (row.traits.traces || row.traits.draws_samples) GTEST_SKIP() << "no lookups in blocks";
    constexpr int size = 8;
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const float narrow[] = {0.0f, 0.3f, 1.0f}, any[] = {0.0f, 1.0f, 1.6f, 2.5f, 7.0f, -1.0f, infinite};
    const std::vector<ParameterValues> variants = testing::variants(row);
    const std::size_t step = variants.size() > 60 ? 3 : 1;  // a deep shadow map has hundreds
    for (std::size_t v = 0; v < variants.size(); v += step) {
        const ParameterValues& values = variants[v];
        if (row.create(values)->needs().submission) continue;  // another order of insertion, the same lookups
        SCOPED_TRACE(testing::text_of(row, values));
        const auto built = testing::build(row, testing::hairy_scene(true), rays::testing::directional(),
                                          rays::testing::rays(size, 4), to_json(values).dump().c_str());
        for (const std::span<const float> widths : {std::span<const float>(narrow), std::span<const float>(any)}) {
            const std::vector<Query> queries = places(widths, size, widths.size());
            std::vector<float> expected(queries.size()), answers(queries.size());
            {
                const OnPath path(base::SimdPath::baseline);
                for (std::size_t i = 0; i < queries.size(); ++i)
                    built.map->lookup(std::span(queries).subspan(i, 1), std::span(expected).subspan(i, 1));
            }
            for (const base::SimdPath p : base::simd_paths()) {
                const OnPath path(p);
                built.map->lookup(queries, answers);
                for (std::size_t i = 0; i < queries.size(); ++i)
                    EXPECT_EQ(answers[i], expected[i]) << "path " << static_cast<int>(p) << ", query " << i;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, LookupPaths, ::testing::ValuesIn(testing::rows()), testing::name_of_row);

}  // namespace
}  // namespace shadowbench::techniques

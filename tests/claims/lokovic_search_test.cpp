#include "claims/lokovic_search.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "techniques/deep/segment_search.h"

namespace shadowbench::claims::lokovic {
namespace {

TEST(Search, ThePointerFindsWhatTheSearchFromTheFrontFinds) {
    base::Random random(1);
    for (const std::uint32_t nodes : {1u, 2u, 5u, 40u}) {
        std::vector<float> depths;
        float depth = 0.0f;
        for (std::uint32_t i = 0; i < nodes; ++i) {
            depth += i % 3 == 2 ? 0.0f : static_cast<float>(random.uniform());  // some steps
            depths.push_back(depth);
        }
        std::uint32_t last = 0;
        for (int i = 0; i < 500; ++i) {
            // Depths between the nodes, at them, before and behind all.
            const float z =
                i % 2 == 0 ? static_cast<float>(random.uniform(-0.5, 1.2 * depth + 0.5)) : depths[random.below(nodes)];
            EXPECT_EQ(search_from(last, depths.data(), nodes, z), techniques::LinearSearch()(depths.data(), nodes, z));
            EXPECT_LE(last, nodes);
        }
    }
}

}  // namespace
}  // namespace shadowbench::claims::lokovic

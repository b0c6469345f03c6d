#include "curves/depth_sort.h"

#include <gtest/gtest.h>

#include "cases.h"

namespace shadowbench::curves {
namespace {

TEST(DepthSort, KeysOrderAsDepthsDo) {
    const float depths[] = {-1e30f, -2.0f, -1e-45f, 0.0f, 1e-45f, 1e-3f, 1.0f, std::nextafter(1.0f, 2.0f), 1e30f};
    for (std::size_t i = 1; i < std::size(depths); ++i) EXPECT_LT(depth_key(depths[i - 1]), depth_key(depths[i]));
    for (const float z : depths) EXPECT_EQ(key_depth(depth_key(z)), z);
    EXPECT_EQ(depth_key(-0.0f), depth_key(0.0f)) << "one depth would become two";
}

// Every size class has its own algorithm; equal depths must keep their order in all of them.
TEST(DepthSort, SortsStablyAtEverySizeAndSpread) {
    base::Random random(3);
    std::vector<std::uint64_t> items, scratch;
    for (const std::size_t count : {0, 1, 2, 7, 95, 96, 97, 300, 4095, 4096, 20000})
        for (const double spread : {0.0, 1e-4, 1.0, 1e9}) {
            items.clear();
            for (std::size_t i = 0; i < count; ++i) {
                const float z = i % 3 == 0 ? 7.0f : cases::number(random, 7.0 - spread, 7.0 + spread);
                items.push_back(depth_item(z, static_cast<std::uint32_t>(i)));
            }
            auto expected = items;
            std::stable_sort(expected.begin(), expected.end(), [](auto a, auto b) { return a >> 32 < b >> 32; });
            sort_by_depth(items, scratch);
            ASSERT_EQ(items, expected) << count << " items, spread " << spread;
        }
}

}  // namespace
}  // namespace shadowbench::curves

#include "bench/reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "bench/half_covered.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

TEST(Reference, knows_the_filtered_edge_of_a_layer) {
    HalfCovered half = half_covered(0.1);  // the edge is at x = 4.4 pixels
    half.settings.samples_per_pixel = 4096;
    const Query queries[] = {
        {1.5f, 2.5f, 2.0f, 1.0f},  // under the layer
        {6.5f, 2.5f, 2.0f, 1.0f},  // beside it
        {4.5f, 4.5f, 2.0f, 1.0f},  // 40 % of the footprint under it
        {4.4f, 4.0f, 2.0f, 2.0f},  // half of it, across pixels
        {1.5f, 2.5f, 1.0f, 1.0f},  // on the layer: it shades what is strictly behind
        {6.5f, 2.5f, 3.5f, 1.0f},  // below the floor
    };
    const Truth truth = reference_visibility(half.scene, half.view, half.settings, queries, {});
    ASSERT_EQ(truth.channels, 1);
    ASSERT_EQ(truth.value.size(), 6u);
    const double expected[] = {0.4, 1.0, 1.0 - 0.4 * 0.6, 0.7, 1.0, 0.0};
    for (int q = 0; q < 6; ++q) EXPECT_NEAR(truth.value[q], expected[q], 4 * truth.standard_error[q] + 1e-6) << q;
    EXPECT_NEAR(truth.standard_error[0], 0.0, 1e-7);
    EXPECT_GT(truth.standard_error[2], 0.0);
    EXPECT_LT(truth.standard_error[2], 0.2 * 0.6 * std::sqrt(0.4 * 0.6 / 4096)) << "far below that of independent rays";
}

TEST(Reference, clips_the_footprint_to_the_map) {
    const HalfCovered half = half_covered();
    const Query queries[] = {{0.1f, 0.1f, 2.0f, 3.0f}};
    const Truth truth = reference_visibility(half.scene, half.view, half.settings, queries, {});
    EXPECT_NEAR(truth.value[0], 0.4, 1e-6);
}

TEST(Reference, traces_rays_in_a_footprint_that_holds_none) {
    HalfCovered half = half_covered();
    const Query queries[] = {{1.3f, 1.3f, 2.0f, 1e-6f}, {6.3f, 1.3f, 2.0f, 1e-6f}};
    const Truth truth = reference_visibility(half.scene, half.view, half.settings, queries, {});
    EXPECT_NEAR(truth.value[0], 0.4, 1e-6);
    EXPECT_NEAR(truth.value[1], 1.0, 1e-6);
    EXPECT_NEAR(truth.standard_error[0], 0.0, 1e-15) << "a ray of each set, and all see the same";
    half.settings.samples_per_pixel = 1;
    EXPECT_EQ(reference_visibility(half.scene, half.view, half.settings, queries, {}).standard_error[0], 0.5)
        << "one ray is not certain";
}

TEST(Reference, does_not_depend_on_the_number_of_threads) {
    HalfCovered half = half_covered(0.1);
    half.settings.resolution = half.view.resolution = {256, 256};
    half.view.pixel = {2.0 / 256, 2.0 / 256};
    std::vector<Query> queries;
    for (int i = 0; i < 200; ++i) queries.push_back({static_cast<float>(i) * 1.28f, 100.0f, 2.0f, 30.0f});
    std::vector<double> values[2];
    for (int threads : {1, 2}) {
        const base::ThreadLimit limit(threads);
        values[threads - 1] = reference_visibility(half.scene, half.view, half.settings, queries, {}).value;
    }
    EXPECT_EQ(values[0], values[1]);
}

}  // namespace
}  // namespace shadowbench::bench

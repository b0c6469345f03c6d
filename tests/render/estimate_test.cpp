#include "render/estimate.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace shadowbench::render {
namespace {

// A ball before a camera, in the map of a light.
class PictureEstimate : public ::testing::Test {
protected:
    PictureEstimate() {
        scenario_.receivers.camera = scene::Camera{{0, 0, 10}, {0, 0, 0}};
        scene::Object ball;
        ball.shape = scene::Spheres{{{0, 0, 0}}, {1.0f}};
        scenario_.scene.objects.push_back(ball);
        work_.view.lower = {-50.0, -50.0};
        work_.view.pixel = {1.0, 1.0};
        work_.view.resolution = {100, 100};
        work_.pixels = 1e4;
        work_.rays = 1.6e5;
        work_.segments = work_.exact = work_.truth_segments = 4.0;
        work_.truth_pixel_rays = work_.truth_samples = 100.0;
        work_.footprint = 16.0;
        work_.techniques = 2.0;
    }
    double of(int side, std::size_t lights = 1, std::uint64_t file_bytes = 0) {
        scenario_.receivers.resolution = {side, side};
        const std::vector<bench::LightWork> works(lights, work_);
        return estimate_pictures({scenario_, works, file_bytes}, 2);
    }

    scene::Scenario scenario_;
    bench::LightWork work_;
};

// 0.09 s were estimated for a job whose pictures took 10.5 s.
TEST_F(PictureEstimate, counts_pixels_lights_and_techniques) {
    EXPECT_NEAR(of(2048) - of(1024), 4.0 * (of(1024) - of(512)), 0.05 * of(2048)) << "beside whole chunks of the truth";
    EXPECT_NEAR(of(512, 3) - of(512, 2), of(512, 2) - of(512, 1), 1e-9);
    const double two = of(512);
    work_.techniques = 4.0;
    EXPECT_GT(of(512), 1.1 * two);
    EXPECT_EQ(of(512, 0), 0.0);
    work_.techniques = 2.0;
    work_.traced = 1.0;
    work_.lookup_rays = 16.0;
    EXPECT_GT(of(512), 1.1 * two);
}

// Small pictures are enlarged: a job with a camera of 128 by 128 draws 512 by 512.
TEST_F(PictureEstimate, is_for_the_size_that_is_drawn) {
    EXPECT_EQ(of(64), of(512));
    EXPECT_LT(of(32), 0.5 * of(64)) << "at most eight times as wide";
}

TEST_F(PictureEstimate, counts_the_bytes_of_files_that_are_read_again) {
    EXPECT_NEAR(of(512, 1, 2'000'000) - of(512), 2.0 * (of(512, 1, 1'000'000) - of(512)), 1e-9);
    EXPECT_GT(of(512, 1, 1'000'000), of(512));
}

// The rays of the map of the truth are captured again for each half a million points.
TEST_F(PictureEstimate, counts_the_truth_for_each_part_of_the_points) {
    scenario_.receivers.camera = scene::Camera{{0, 0, 1.6}, {0, 0, 0}};  // the ball fills the picture
    const auto of_the_truth = [&](int side) {
        work_.pixels = 1e7;
        const double large = of(side);
        work_.pixels = 1e4;
        return large - of(side);
    };
    EXPECT_GT(of_the_truth(2048), 1.99 * of_the_truth(512));
}

// A picture with so many points that memory does not hold them ends there: no truth is found for them.
TEST_F(PictureEstimate, ends_where_the_points_fill_the_memory) {
    scene::Mesh sheets;
    sheets.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    for (int sheet = 0; sheet < 1000; ++sheet)
        for (const base::Vec3i& half : {base::Vec3i{0, 1, 2}, base::Vec3i{0, 2, 3}}) sheets.triangles.push_back(half);
    scene::Object object;
    object.shape = sheets;
    object.opacity = base::Vec3f(1e-4f);
    scenario_.scene.objects = {object};
    const double sees = of(512);
    work_.truth_pixel_rays = work_.truth_samples = 1e6;
    EXPECT_EQ(of(512), sees);
    EXPECT_GT(of(128, 2, 1000), sees) << "the files are read";
}

// A ball outside the map is lit everywhere.
TEST_F(PictureEstimate, counts_the_truth_of_points_inside_the_map) {
    const double inside = of(512);
    work_.view.lower = {100.0, 100.0};
    EXPECT_LT(of(512), 0.8 * inside);
}

// Media have a point for each step of a view ray: up to 64 a pixel.
TEST_F(PictureEstimate, counts_the_way_through_media) {
    const double ball = of(512);
    scene::GridVolume grid;
    grid.size = {4, 4, 4};
    grid.density.assign(64, 1.0f);
    grid.lower = {-2, -2, -2};
    grid.upper = {2, 2, 2};
    grid.step = 0.05;
    scene::Object smoke;
    smoke.shape = grid;
    scenario_.scene.objects.push_back(smoke);
    const double full = of(512);
    EXPECT_GT(full, 1.5 * ball);
    grid.density.assign(64, 0.0f);
    grid.density[0] = 1.0f;
    scenario_.scene.objects.back().shape = grid;
    EXPECT_LT(of(512) - ball, 0.2 * (full - ball)) << "most of it is empty";
}

}  // namespace
}  // namespace shadowbench::render

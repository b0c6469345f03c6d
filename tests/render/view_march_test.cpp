#include "render/view_march.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::render {
namespace {

using base::Vec3d;
using base::Vec3f;
using rays::TracedSegment;

// Constant extinction between two depths.
TracedSegment medium(double front, double back, double sigma) {
    return {front, back, Vec3f(static_cast<float>(std::exp(-sigma * (back - front))))};
}

ViewMarch march(const std::vector<TracedSegment>& segments, double step) {
    ViewMarch result;
    march_view_ray(segments, {}, step, result);
    return result;
}

// Light that fades inside the medium as exp(-k (t - front)), for which in-scattering has a closed form.
double in_scattering(const ViewMarch& march, double front, double k) {
    double sum = 0.0;
    for (const ViewStep& s : march.steps) sum += s.share.x * std::exp(-k * (s.t - front));
    return sum;
}

TEST(ViewMarch, scatters_the_light_that_a_uniform_slab_takes_whatever_the_step) {
    for (const double step : {0.01, 0.3, 5.0}) {
        const ViewMarch m = march({medium(2, 4, 0.7)}, step);
        EXPECT_NEAR(in_scattering(m, 2, 0.0), 1.0 - std::exp(-1.4), 1e-7) << step;
        EXPECT_NEAR(m.transmittance.x, std::exp(-1.4), 1e-7) << step;
    }
}

TEST(ViewMarch, converges_to_the_closed_form_of_light_that_fades_in_the_slab) {
    // Integral over the slab of sigma exp(-sigma s) exp(-k s) ds = sigma / (sigma + k) (1 - exp(-(sigma + k) L)).
    const double sigma = 0.7, k = 1.3, length = 2.0;
    const double expected = sigma / (sigma + k) * (1.0 - std::exp(-(sigma + k) * length));
    double before = 1.0;
    for (const int steps : {8, 32, 128}) {
        const double error =
            std::abs(in_scattering(march({medium(2, 4, sigma)}, length / steps), 2, k) - expected) / expected;
        EXPECT_LT(error, 0.1 * before) << "second order in the step";
        before = error;
    }
    EXPECT_LT(before, 1e-4);
}

TEST(ViewMarch, multiplies_media_that_overlap) {
    const ViewMarch both = march({medium(0, 2, 0.5), medium(1, 3, 1.5)}, 0.01);
    EXPECT_NEAR(both.transmittance.x, std::exp(-0.5 * 2 - 1.5 * 2), 1e-6);
    double first = 0.0;  // before the second medium starts
    for (const ViewStep& s : both.steps)
        if (s.t < 1.0) first += s.share.x;
    EXPECT_NEAR(first, 1.0 - std::exp(-0.5), 1e-6);
}

TEST(ViewMarch, does_not_look_up_in_a_gap) {
    const ViewMarch m = march({medium(0, 1, 0.4), medium(6, 7, 0.4)}, 0.25);
    ASSERT_EQ(m.steps.size(), 8u);
    for (const ViewStep& s : m.steps) EXPECT_TRUE(s.t < 1.0 || s.t > 6.0) << s.t;
    EXPECT_NEAR(m.transmittance.x, std::exp(-0.8), 1e-7);
}

TEST(ViewMarch, keeps_to_its_number_of_steps_in_many_thin_pieces) {
    std::vector<TracedSegment> comb;  // 1,000 pieces with gaps as thin as themselves
    for (int i = 0; i < 1000; ++i) comb.push_back(medium(0.01 * i, 0.01 * i + 0.005, 0.1));
    EXPECT_LE(march(comb, 10.0 / 128).steps.size(), 129u);
}

TEST(ViewMarch, ends_where_no_light_is_left) {
    const ViewMarch m = march({medium(0, 1, 40.0), medium(3, 4, 1.0)}, 0.05);
    EXPECT_LT(m.steps.back().t, 1.0);
    EXPECT_LT(m.transmittance.x, 1e-4);
}

TEST(ViewMarch, keeps_channels_apart_and_passes_over_surfaces) {
    const ViewMarch m = march({{0.5, 0.5, Vec3f(0.0f)}, {1, 2, Vec3f(1.0f, 0.5f, 0.25f)}}, 10.0);
    ASSERT_EQ(m.steps.size(), 1u);
    EXPECT_EQ(m.steps[0].share.x, 0.0);
    EXPECT_NEAR(m.steps[0].share.y, 0.5, 1e-7);
    EXPECT_NEAR(m.steps[0].share.z, 0.75, 1e-7);
}

rays::SurfaceHit surface(double t, Vec3d opacity) {
    return {t, Vec3d(0.0), Vec3d(0.0), Vec3d(0.0), opacity};
}

TEST(ViewMarch, composites_surfaces_in_order_of_depth) {
    ViewMarch m;
    march_view_ray({}, std::vector{surface(1, Vec3d(0.25)), surface(2, Vec3d(0.5, 0, 1)), surface(3, Vec3d(0.8))}, 1.0,
                   m);
    ASSERT_EQ(m.surfaces.size(), 3u);
    EXPECT_EQ(m.surfaces[0], Vec3d(0.25));
    EXPECT_EQ(m.surfaces[1], Vec3d(0.375, 0, 0.75));
    EXPECT_NEAR((m.surfaces[2] - Vec3d(0.3, 0.6, 0)).length(), 0.0, 1e-12);
    EXPECT_NEAR((m.transmittance - Vec3d(0.075, 0.15, 0)).length(), 0.0, 1e-12);
}

// A slab from 2 to 4 with a surface at 3.1, inside one of its steps or between two, and others before and behind it.
TEST(ViewMarch, dims_the_media_behind_a_surface_and_the_surface_behind_media_whatever_the_step) {
    const double sigma = 0.7;
    const auto media_to = [&](double t) { return std::exp(-sigma * (t - 2)); };
    for (const double step : {0.01, 0.3, 5.0}) {
        ViewMarch m;
        march_view_ray(std::vector{medium(2, 4, sigma)},
                       std::vector{surface(1, Vec3d(0.2)), surface(3.1, Vec3d(0.4)), surface(7, Vec3d(0.5))}, step, m);
        EXPECT_NEAR(in_scattering(m, 2, 0.0), 0.8 * ((1 - media_to(3.1)) + 0.6 * (media_to(3.1) - media_to(4))), 1e-7)
            << step;
        ASSERT_EQ(m.surfaces.size(), 3u);
        EXPECT_NEAR(m.surfaces[0].x, 0.2, 1e-12);
        EXPECT_NEAR(m.surfaces[1].x, 0.8 * media_to(3.1) * 0.4, 1e-7);
        EXPECT_NEAR(m.surfaces[2].x, 0.8 * 0.6 * media_to(4) * 0.5, 1e-7);
    }
}

TEST(ViewMarch, ends_at_surfaces_behind_which_no_light_is_left) {
    std::vector<rays::SurfaceHit> many;
    for (int i = 0; i < 100; ++i) many.push_back(surface(1 + i, Vec3d(0.5)));
    ViewMarch m;
    march_view_ray(std::vector{medium(40, 50, 1.0)}, many, 1.0, m);
    EXPECT_EQ(m.surfaces.size(), 14u) << "2^-14 is the first power below 1e-4";
    EXPECT_TRUE(m.steps.empty());
    EXPECT_EQ(m.transmittance.x, std::ldexp(1.0, -14));
}

TEST(ViewMarch, of_an_empty_ray_is_empty) {
    const ViewMarch m = march({}, 1.0);
    EXPECT_TRUE(m.steps.empty());
    EXPECT_EQ(m.transmittance, Vec3d(1, 1, 1));
}

}  // namespace
}  // namespace shadowbench::render

#include "metrics/flip.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/parallel.h"
#include "base/random.h"

namespace shadowbench::metrics {
namespace {

constexpr double pi = std::numbers::pi;

using Rgb = std::array<double, 3>;

struct Picture {
    int width, height;
    std::vector<float> rgb;
};

Picture constant(int width, int height, const Rgb& colour) {
    Picture picture{width, height, {}};
    for (int p = 0; p < width * height; ++p)
        for (const double c : colour) picture.rgb.push_back(static_cast<float>(c));
    return picture;
}

Picture noise(int width, int height, std::uint64_t seed) {
    Picture picture{width, height, {}};
    base::Random random(seed);
    for (int v = 0; v < width * height * 3; ++v) picture.rgb.push_back(static_cast<float>(random.uniform()));
    return picture;
}

Flip flip(const Picture& a, const Picture& b, double ppd = flip_pixels_per_degree) {
    return metrics::flip(a.rgb, b.rgb, a.width, a.height, ppd);
}

// --- an independent implementation of the paper, in double, with two-dimensional kernels
// ------------------------------

namespace oracle {

using Grid = std::vector<double>;  // width * height

struct Filter {
    int radius;
    std::vector<double> weight;  // (2 radius + 1)^2
};

Filter make(int radius, const std::function<double(int, int)>& value) {
    Filter f{radius, {}};
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) f.weight.push_back(value(x, y));
    double positive = 0.0, negative = 0.0;
    for (const double w : f.weight) (w > 0 ? positive : negative) += w;
    for (double& w : f.weight) w = w > 0 ? w / positive : w < 0 ? w / -negative : 0.0;
    return f;
}

Grid convolve(const Grid& in, int width, int height, const Filter& f) {
    Grid out(in.size(), 0.0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int j = -f.radius; j <= f.radius; ++j)
                for (int i = -f.radius; i <= f.radius; ++i) {
                    const int xx = std::min(std::max(x + i, 0), width - 1),
                              yy = std::min(std::max(y + j, 0), height - 1);
                    out[y * width + x] +=
                        f.weight[(j + f.radius) * (2 * f.radius + 1) + i + f.radius] * in[yy * width + xx];
                }
    return out;
}

// The usual sRGB matrices to four digits and their white.
Rgb xyz(const Rgb& c) {
    return {(0.4123867 * c[0] + 0.3575915 * c[1] + 0.1804505 * c[2]) / 0.9504285,
            0.2126368 * c[0] + 0.7151830 * c[1] + 0.0721802 * c[2],
            (0.0193306 * c[0] + 0.1191972 * c[1] + 0.9503726 * c[2]) / 1.0889004};
}

Rgb clamped_rgb(Rgb v) {
    v[0] *= 0.9504285;
    v[2] *= 1.0889004;
    const Rgb rgb = {3.241003275 * v[0] - 1.537398934 * v[1] - 0.498615861 * v[2],
                     -0.969224334 * v[0] + 1.875930071 * v[1] + 0.041554224 * v[2],
                     0.055639423 * v[0] - 0.204011202 * v[1] + 1.057148933 * v[2]};
    Rgb result;
    for (int i = 0; i < 3; ++i) result[i] = std::min(std::max(rgb[i], 0.0), 1.0);
    return result;
}

Rgb hunt(const Rgb& rgb) {
    const Rgb v = xyz(rgb);
    const auto f = [](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; };
    const double l = 116 * f(v[1]) - 16;
    return {l, l / 100 * 500 * (f(v[0]) - f(v[1])), l / 100 * 200 * (f(v[1]) - f(v[2]))};
}

double distance(const Rgb& a, const Rgb& b) {
    return std::abs(a[0] - b[0]) + std::sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

double redistributed(double hyab) {
    const double top = std::pow(distance(hunt({0, 1, 0}), hunt({0, 0, 1})), 0.7), e = std::pow(hyab, 0.7);
    return e < 0.4 * top ? 0.95 / (0.4 * top) * e : 0.95 + 0.05 * (e - 0.4 * top) / (0.6 * top);
}

struct Seen {
    std::vector<Rgb> lab;
    Grid edge, point;
};

Seen look(const Picture& p, double ppd) {
    Grid y, cx, cz;
    for (std::size_t i = 0; i < p.rgb.size(); i += 3) {
        const Rgb v = xyz({p.rgb[i], p.rgb[i + 1], p.rgb[i + 2]});
        y.push_back(116 * v[1] - 16);
        cx.push_back(500 * (v[0] - v[1]));
        cz.push_back(200 * (v[1] - v[2]));
    }
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const auto sensitivity = [&](double a1, double b1, double a2, double b2) {
        return make(radius, [=](int i, int j) {
            const double r2 = (i * i + j * j) / (ppd * ppd);
            return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * r2 / b1) +
                   a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * r2 / b2);
        });
    };
    const Grid fy = convolve(y, p.width, p.height, sensitivity(1, 0.0047, 0, 1e-5));
    const Grid fx = convolve(cx, p.width, p.height, sensitivity(1, 0.0053, 0, 1e-5));
    const Grid fz = convolve(cz, p.width, p.height, sensitivity(34.1, 0.04, 13.5, 0.025));
    Seen seen;
    for (std::size_t i = 0; i < fy.size(); ++i) {
        const double l = (fy[i] + 16) / 116;
        seen.lab.push_back(hunt(clamped_rgb({l + fx[i] / 500, l, l - fz[i] / 200})));
    }
    const double sigma = 0.5 * 0.082 * ppd;
    const int reach = static_cast<int>(std::ceil(3 * sigma));
    const auto bell = [=](int i, int j) { return std::exp(-(i * i + j * j) / (2 * sigma * sigma)); };
    const auto bend = [=](int i) { return i * i / (sigma * sigma) - 1; };
    const auto magnitude = [&](const Filter& f, const Filter& g) {
        Grid a = convolve(y, p.width, p.height, f), b = convolve(y, p.width, p.height, g), out;
        for (std::size_t i = 0; i < a.size(); ++i) out.push_back(std::sqrt(a[i] * a[i] + b[i] * b[i]));
        return out;
    };
    for (double& v : y) v = (v + 16) / 116;
    seen.edge = magnitude(make(reach, [&](int i, int j) { return -i * bell(i, j); }),
                          make(reach, [&](int i, int j) { return -j * bell(i, j); }));
    seen.point = magnitude(make(reach, [&](int i, int j) { return bend(i) * bell(i, j); }),
                           make(reach, [&](int i, int j) { return bend(j) * bell(i, j); }));
    return seen;
}

Grid flip(const Picture& a, const Picture& b, double ppd) {
    const Seen seen_a = look(a, ppd), seen_b = look(b, ppd);
    Grid map;
    for (std::size_t i = 0; i < seen_a.lab.size(); ++i) {
        const double edge = std::abs(seen_a.edge[i] - seen_b.edge[i]),
                     point = std::abs(seen_a.point[i] - seen_b.point[i]);
        const double features = std::sqrt(std::max(edge, point) / std::sqrt(2.0));
        map.push_back(std::pow(redistributed(distance(seen_a.lab[i], seen_b.lab[i])), 1 - features));
    }
    return map;
}

}  // namespace oracle

TEST(Flip, agrees_with_the_whole_kernels_in_double) {
    for (const double ppd : {67.0, 30.0}) {
        Picture a = noise(29, 23, 3), b = noise(29, 23, 4);
        for (std::size_t i = 0; i < b.rgb.size() / 2; ++i) b.rgb[i] = a.rgb[i];  // half of it is the same
        const Flip result = flip(a, b, ppd);
        const oracle::Grid expected = oracle::flip(a, b, ppd);
        double mean = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(result.map[i], expected[i], 2e-3) << "pixel " << i << " at " << ppd;
            mean += expected[i] / static_cast<double>(expected.size());
        }
        EXPECT_NEAR(result.mean, mean, 1e-5);
    }
}

TEST(Flip, sees_an_edge_and_a_point_as_the_whole_kernels_do) {
    Picture grey = constant(41, 33, {0.2, 0.2, 0.2}), marked = grey;
    for (int y = 0; y < 33; ++y)
        for (int c = 0; c < 3; ++c) marked.rgb[3 * (y * 41 + 8) + c] = 0.7f;
    marked.rgb[3 * (16 * 41 + 30) + 1] = 1.0f;
    const Flip result = flip(grey, marked);
    const oracle::Grid expected = oracle::flip(grey, marked, 67.0);
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(result.map[i], expected[i], 2e-3) << i;
    EXPECT_GT(result.map[16 * 41 + 30], 0.1f);
    EXPECT_LT(result.map[16 * 41 + 20], 0.02f) << "no change between them";
}

// Without structure only the colour pipeline remains, computed here by hand for grey, where only L* differs.
TEST(Flip, of_black_and_white_is_the_spread_lightness_distance) {
    const Flip result = flip(constant(9, 7, {0, 0, 0}), constant(9, 7, {1, 1, 1}));
    // Hunt-adjusted green and blue of sRGB are (87.73, -75.7, 73.0) and (32.30, 25.6, -34.9), 203.1 apart: 203.1^0.7 =
    // 41.24; black and white are 100 apart: 100^0.7 = 25.12, so 0.95 + 0.05 (25.12 - 16.50) / (41.24 - 16.50).
    EXPECT_NEAR(result.mean, 0.9674, 2e-4);
    EXPECT_NEAR(result.max, result.mean, 1e-6);
    EXPECT_NEAR(result.weighted_median, result.mean, 1e-6);
}

TEST(Flip, of_green_and_blue_is_the_largest_possible) {
    EXPECT_NEAR(flip(constant(5, 5, {0, 1, 0}), constant(5, 5, {0, 0, 1})).mean, 1.0, 1e-5);
}

TEST(Flip, of_a_picture_and_itself_is_0) {
    const Picture a = noise(40, 31, 1);
    const Flip result = flip(a, a);
    EXPECT_EQ(result.mean, 0.0);
    EXPECT_EQ(result.max, 0.0);
    EXPECT_EQ(result.weighted_median, 0.0);
}

TEST(Flip, does_not_depend_on_which_picture_comes_first) {
    const Picture a = noise(24, 18, 5), b = noise(24, 18, 6);
    EXPECT_EQ(flip(a, b).map, flip(b, a).map);
}

TEST(Flip, stays_between_0_and_1_and_clamps_values_that_no_monitor_shows) {
    Picture a = noise(30, 30, 7), b = noise(30, 30, 8);
    for (std::size_t i = 0; i < b.rgb.size(); i += 3) b.rgb[i] = i % 2 ? 1.0f : 0.0f;
    const Flip bounded = flip(a, b);
    for (const float v : bounded.map) ASSERT_TRUE(v >= 0.0f && v <= 1.0f) << v;
    for (std::size_t i = 0; i < b.rgb.size(); i += 3) b.rgb[i] = i % 2 ? 50.0f : std::nanf("");
    EXPECT_EQ(flip(a, b).map, bounded.map);
}

TEST(Flip, grows_with_contrast) {
    double before = 0.0;
    for (const double white : {0.25, 0.3, 0.4, 0.6, 1.0}) {
        Picture a = constant(20, 20, {0.2, 0.2, 0.2}), b = a;
        for (std::size_t i = 0; i < b.rgb.size() / 2; ++i) b.rgb[i] = static_cast<float>(white);
        const double mean = flip(a, b).mean;
        EXPECT_GT(mean, before) << white;
        before = mean;
    }
}

// A checkerboard of pixels that is finer than the eye resolves looks like its average.
TEST(Flip, ignores_detail_that_is_too_fine_to_see) {
    Picture fine = constant(64, 64, {0, 0, 0}), coarse = fine;
    const Picture average = constant(64, 64, {0.5, 0.5, 0.5});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                fine.rgb[3 * (y * 64 + x) + c] = (x + y) % 2 ? 1.0f : 0.0f;
                coarse.rgb[3 * (y * 64 + x) + c] = (x / 16 + y / 16) % 2 ? 1.0f : 0.0f;
            }
    EXPECT_LT(flip(average, fine, 134.0).mean, 0.1 * flip(average, coarse, 134.0).mean);
}

TEST(Flip, weighted_median_halves_the_sum_of_the_differences) {
    const Flip result = flip(noise(31, 17, 9), noise(31, 17, 10));
    double sum = 0.0, below = 0.0, up_to = 0.0;
    for (const float v : result.map) {
        sum += v;
        if (v < result.weighted_median) below += v;
        if (v <= result.weighted_median) up_to += v;
    }
    EXPECT_LT(below, 0.5 * sum);
    EXPECT_GE(up_to, 0.5 * sum - 1e-9);
}

TEST(Flip, is_the_same_on_one_thread_and_on_two) {
    const Picture a = noise(50, 40, 11), b = noise(50, 40, 12);
    Flip result[2];
    for (const int threads : {1, 2}) {
        const base::ThreadLimit limit(threads);
        result[threads - 1] = flip(a, b);
    }
    EXPECT_EQ(result[0].map, result[1].map);
    EXPECT_EQ(result[0].mean, result[1].mean);
}

}  // namespace
}  // namespace shadowbench::metrics

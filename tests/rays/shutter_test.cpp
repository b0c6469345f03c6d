// The times of a pixel's rays: one in each part of the shutter, and not correlated with their positions.
#include "rays/shutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "rays/light_rays.h"

namespace shadowbench::rays {
namespace {

const int counts[] = {1,  2,  3,  4,  5,  6,   7,   8,   9,    12,   16,   22,  25,
                      32, 37, 60, 64, 97, 100, 111, 256, 1000, 1009, 1024, 4096};

MapLayout layout_of(int samples, std::uint64_t seed, bool jittered) {
    MapLayout layout;
    layout.width = layout.height = 64;
    layout.moving = true;
    layout.jittered = jittered;
    layout.seed = seed;
    set_samples(layout, samples);
    return layout;
}

// Calls visit(pixel's layout, first column, first row of cells) for pixels of many seeds, `rays` rays in all.
template <class Visit>
int for_pixels(int samples, int rays, const Visit& visit) {
    const int pixels = std::max(16, rays / samples);
    for (int p = 0; p < pixels; ++p) {
        const MapLayout layout = layout_of(samples, static_cast<std::uint64_t>(p / 8), p % 3 == 0);
        const std::uint64_t place = base::hash(static_cast<std::uint64_t>(p));
        visit(layout, static_cast<int>(place % 64) * layout.samples_x,
              static_cast<int>(place / 64 % 64) * layout.samples_y);
    }
    return pixels;
}

int part_of(const MapLayout& layout, int i, int j) {
    return static_cast<int>(sample_time(layout, i, j) * layout.samples());
}

TEST(Shutter, EveryPixelOfEverySeedHasOneRayInEachPart) {
    for (const int samples : counts)
        for_pixels(samples, 100000, [&](const MapLayout& layout, int i0, int j0) {
            std::vector<int> rays(static_cast<std::size_t>(samples));
            for (int j = 0; j < layout.samples_y; ++j)
                for (int i = 0; i < layout.samples_x; ++i) {
                    const int part = part_of(layout, i0 + i, j0 + j);
                    ASSERT_GE(part, 0);
                    ASSERT_LT(part, samples);
                    ++rays[static_cast<std::size_t>(part)];
                }
            ASSERT_EQ(std::count(rays.begin(), rays.end(), 1), samples) << "samples " << samples;
        });
}

TEST(Shutter, LayoutsWiderThanHighHaveOneRayInEachPartToo) {
    for (const auto& [across, down] : {std::pair{4, 2}, {7, 3}, {5, 1}, {16, 15}}) {
        std::vector<int> rays(static_cast<std::size_t>(across * down));
        for (int j = 0; j < down; ++j)
            for (int i = 0; i < across; ++i) ++rays[shutter_part(across, down, i, j, 12)];
        EXPECT_EQ(std::count(rays.begin(), rays.end(), 1), across * down);
    }
}

TEST(Shutter, EachColumnAndEachRowOfCellsHasOneRayInEachLongStretch) {
    for (const int samples : counts)
        for_pixels(samples, 20000, [&](const MapLayout& layout, int i0, int j0) {
            const int s = layout.samples_x, n = layout.samples_y;
            std::vector<int> column(static_cast<std::size_t>(samples)), row(static_cast<std::size_t>(samples));
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < s; ++i) {
                    const int part = part_of(layout, i0 + i, j0 + j);
                    ++column[static_cast<std::size_t>(i * n + part / s)];
                    ++row[static_cast<std::size_t>(j * s + part / n)];
                }
            ASSERT_EQ(std::count(column.begin(), column.end(), 1), samples);
            if (n % s == 0) {
                ASSERT_EQ(std::count(row.begin(), row.end(), 1), samples);
            }
        });
}

// The guarantees of shutter.h for positions x, y of cells and times t of parts, all in the middle, in any pixel. s
// columns, n rows; E|x - 1/2| <= 1/4 and likewise for y.
struct Promise {
    double x, y, xy;  // the largest covariance of the time with x, with y, with (x - 1/2)(y - 1/2)
};
Promise promise(int s, int n) {
    // A column has one ray in each of n stretches, at any place in it: its mean time is off by (s - 1) / (2 s n).
    Promise p;
    p.x = 0.25 * (s - 1.0) / (2.0 * s * n);
    // The s times of a row stand 1 / s apart, rounded to stretches.
    p.y = 0.25 * (1.0 / (2.0 * s) + (n % s == 0 ? 0.0 : 2.0 / n));
    p.xy = 1.0 / 64;  // E|x - 1/2||y - 1/2||t - 1/2|
    // w = 2^l neighbouring cells of a column lie one each in w parts of the shutter, rounded and rotated: their mean
    // time is off by 3 / (2 w) + 2 / n. Inside a band of w rows y has the standard deviation w / (n sqrt(12)), and t
    // less than 0.3. Of n rows, n % w are left over.
    for (int w = 1; w <= n; w *= 2) {
        const double off = w == 1 ? 0.5 : std::min(0.5, 1.5 / w + 2.0 / n);
        const double y = 0.25 * off + 0.3 * w / (n * std::sqrt(12.0)) + 0.25 * (n % w) / n;
        p.y = std::min(p.y, y);
        p.xy = std::min(p.xy, 0.25 * y);
    }
    return p;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const double n = static_cast<double>(a.size());
    double ma = 0.0, mb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ma += a[k] / n;
        mb += b[k] / n;
    }
    for (std::size_t k = 0; k < a.size(); ++k) {
        aa += (a[k] - ma) * (a[k] - ma);
        bb += (b[k] - mb) * (b[k] - mb);
        ab += (a[k] - ma) * (b[k] - mb);
    }
    return aa * bb > 1e-20 ? ab / std::sqrt(aa * bb) : 0.0;
}

double deviation(const std::vector<double>& a) {
    double mean = 0.0, squares = 0.0;
    for (const double v : a) mean += v / static_cast<double>(a.size());
    for (const double v : a) squares += (v - mean) * (v - mean) / static_cast<double>(a.size());
    return std::sqrt(squares);
}

TEST(Shutter, NoPixelOfAnySeedHasPlaceAndTimeCorrelated) {
    using Function = double (*)(double, double);
    const Function functions[] = {[](double x, double) { return x; }, [](double, double y) { return y; },
                                  [](double x, double y) { return x + y; }, [](double x, double y) { return x - y; },
                                  [](double x, double y) { return x * y; }};
    for (const int samples : counts) {
        if (samples == 1) continue;
        double squares[5] = {};
        const int pixels = for_pixels(samples, 150000, [&](const MapLayout& layout, int i0, int j0) {
            const int s = layout.samples_x, n = layout.samples_y;
            const Promise p = promise(s, n);
            const double most[] = {p.x, p.y, p.x + p.y, p.x + p.y, p.xy + 0.5 * (p.x + p.y)};
            std::vector<double> t, f;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < s; ++i) t.push_back((part_of(layout, i0 + i, j0 + j) + 0.5) / samples);
            for (int k = 0; k < 5; ++k) {
                f.clear();
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i < s; ++i) f.push_back(functions[k]((i + 0.5) / s, (j + 0.5) / n));
                const double c = correlation(f, t), bound = most[k] / std::max(deviation(f) * deviation(t), 1e-12);
                ASSERT_LE(std::abs(c), std::min(bound, 1.0) + 1e-9)
                    << samples << " samples, seed " << layout.seed << ", function " << k;
                squares[k] += c * c;
            }
        });
        // Times in a random order would have a mean square of 1 / (samples - 1): stratified ones have no more.
        // The second term is four standard deviations of the mean square over so many pixels.
        for (int k = 0; k < 5; ++k)
            EXPECT_LE(squares[k] / pixels, (1.0 + 4.0 * std::sqrt(2.0 / pixels)) / (samples - 1.0))
                << samples << " samples, function " << k;
    }
}

TEST(Shutter, EveryCellIsEquallyOftenInEveryPart) {
    for (const auto& [s, n] : {std::pair{1, 7}, {2, 3}, {3, 4}, {4, 4}}) {
        const int parts = s * n, keys = 20000;
        std::vector<int> count(static_cast<std::size_t>(parts * parts));
        for (int key = 0; key < keys; ++key)
            for (int cell = 0; cell < parts; ++cell)
                ++count[static_cast<std::size_t>(cell) * parts +
                        shutter_part(s, n, cell % s, cell / s, static_cast<std::uint64_t>(key))];
        const double expected = static_cast<double>(keys) / parts;
        for (const int c : count) EXPECT_NEAR(c, expected, 5.0 * std::sqrt(expected)) << s << " x " << n;
    }
}

}  // namespace
}  // namespace shadowbench::rays

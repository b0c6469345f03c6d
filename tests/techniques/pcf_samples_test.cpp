#include "techniques/depth/pcf_samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::techniques {
namespace {

constexpr PcfSettings figure_4{16, 3, 2, 2, 0, 0};

struct Moments {
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;  // means, variances, covariance
    double low_u = 1, high_u = 0, mean_u = 0;
};

template <Placement placement>
Moments moments(const Region& region, float x, float y) {
    Moments m;
    double count = 0;
    for (std::uint64_t lookup = 0; lookup < 4000; ++lookup)
        for_each_sample<placement>(region, x, y, base::hash(lookup), [&](float sx, float sy, float u) {
            ++count;
            m.x += sx - x;
            m.y += sy - y;
            m.xx += (sx - x) * (sx - x);
            m.yy += (sy - y) * (sy - y);
            m.xy += (sx - x) * (sy - y);
            m.low_u = std::min<double>(m.low_u, u);
            m.high_u = std::max<double>(m.high_u, u);
            m.mean_u += u;
        });
    m.x /= count;
    m.y /= count;
    m.xx = m.xx / count - m.x * m.x;
    m.yy = m.yy / count - m.y * m.y;
    m.xy = m.xy / count - m.x * m.y;
    m.mean_u /= count;
    return m;
}

Region box(float width) {
    return square_region({16, 1, 0, 2, 0, 0}, {64, 64, 1.0f, 2.0f}, width);
}

// Half-sizes 3 and 6 cells. Expected variances: h^2/3 of the uniform distribution; of the Gaussian cut at two standard
// deviations s = h/2: s^2 (1 - 4 phi(2) / (2 Phi(2) - 1)).
template <Placement placement>
void expect_box(double of_half) {
    const Moments m = moments<placement>(box(6.0f), 30.0f, 20.0f);
    EXPECT_NEAR(m.x, 0.0, 0.03);
    EXPECT_NEAR(m.y, 0.0, 0.06);
    EXPECT_NEAR(m.xx, 9 * of_half, 9 * 0.01);
    EXPECT_NEAR(m.yy, 36 * of_half, 36 * 0.01);
    EXPECT_NEAR(m.xy, 0.0, 0.1);
    EXPECT_NEAR(m.mean_u, 0.5, 0.01);
    EXPECT_LT(m.low_u, 0.001);
    EXPECT_GT(m.high_u, 0.999);
    EXPECT_LT(m.high_u, 1.0);
}

TEST(Placement, UniformSamplesFillTheBoxEvenly) {
    expect_box<Placement::uniform>(1.0 / 3);
}
TEST(Placement, JitteredSamplesFillTheBoxEvenly) {
    expect_box<Placement::jittered>(1.0 / 3);
}
TEST(Placement, GaussianSamplesCrowdInTheMiddleOfTheBox) {
    const double phi = std::exp(-2.0) / std::sqrt(2.0 * std::acos(-1.0));
    expect_box<Placement::gaussian>(0.25 * (1.0 - 4.0 * phi / std::erf(std::sqrt(2.0))));
}

TEST(Placement, JitterPutsOneSampleIntoEachPart) {
    const Region r = box(6.0f);
    for (std::uint64_t key = 0; key < 50; ++key) {
        std::vector<int> parts(r.ns * r.nt, 0);
        for_each_sample<Placement::jittered>(r, 0.0f, 0.0f, base::hash(key), [&](float x, float y, float) {
            const int i = std::min(static_cast<int>((x - r.left) / r.ax), r.ns - 1);
            const int j = std::min(static_cast<int>((y - r.bottom) / r.by), r.nt - 1);
            ++parts[j * r.ns + i];
        });
        for (const int count : parts) EXPECT_EQ(count, 1);
    }
}

// The code of figure 4: smin = s - sres + js with js = ds * .5, then iu = s + Rand() * js for s = smin + i * ds. So the
// samples lie a quarter of a part further up, on average, than the lookup.
TEST(Placement, PublishedJitterIsThatOfFigure4) {
    const Region r = box(6.0f);
    const double sres = 3, tres = 6, ds = 2 * sres / r.ns, dt = 2 * tres / r.nt, s = 30, t = 20;
    for (std::uint64_t lookup = 0; lookup < 200; ++lookup) {
        int number = 0;
        for_each_sample<Placement::published>(r, 30.0f, 20.0f, base::hash(lookup), [&](float x, float y, float) {
            const double from_x = s - sres + 0.5 * ds + number % r.ns * ds,
                         from_y = t - tres + 0.5 * dt + number / r.ns * dt;
            EXPECT_GE(x, from_x - 1e-5);
            EXPECT_LE(x, from_x + 0.5 * ds + 1e-5);
            EXPECT_GE(y, from_y - 1e-5);
            EXPECT_LE(y, from_y + 0.5 * dt + 1e-5);
            ++number;
        });
        EXPECT_EQ(number, r.ns * r.nt);
    }
    const Moments m = moments<Placement::published>(r, 30.0f, 20.0f);
    EXPECT_NEAR(m.x, 0.25 * ds, 0.01);
    EXPECT_NEAR(m.y, 0.25 * dt, 0.02);
}

TEST(Placement, NoSampleLeavesTheExtentItIsPromisedTo) {
    const Footprint tilted{3.0f, 1.0f, -1.0f, 2.0f};
    const CellGrid grid{4096, 4096, 4.0f, 4.0f};
    Region shape;
    ASSERT_TRUE(footprint_region(figure_4, grid, tilted, true, shape));
    base::Random random(2);
    for (int lookup = 0; lookup < 2000; ++lookup) {
        const float x = static_cast<float>(random.uniform(0, 16384)), y = static_cast<float>(random.uniform(0, 16384));
        const auto inside = [&](const Region& r) {
            return [e = extent(r, x, y)](float sx, float sy, float) {
                EXPECT_TRUE(sx >= e.x0 && sx <= e.x1 && sy >= e.y0 && sy <= e.y1) << sx << " " << sy;
            };
        };
        const Region square = square_region(figure_4, grid, static_cast<float>(random.uniform(0.1, 5)));
        for_each_sample<Placement::uniform>(square, x, y, lookup, inside(square));
        for_each_sample<Placement::gaussian>(square, x, y, lookup, inside(square));
        for_each_sample<Placement::jittered>(square, x, y, lookup, inside(square));
        for_each_sample<Placement::published>(square, x, y, lookup, inside(square));
        for_each_sample<Placement::shape>(shape, x, y, lookup, inside(shape));
    }
}

TEST(Placement, SamplesOfAShapeStayInItsParallelogram) {
    const Footprint f{3.0f, 1.0f, -1.0f, 2.0f};
    const PcfSettings settings{16, 2, 0, 2, 0, 0};
    Region r;
    ASSERT_TRUE(footprint_region(settings, {64, 64, 1.0f, 1.0f}, f, true, r));
    EXPECT_NEAR(r.ns * r.nt, 16, 2);
    for (std::uint64_t key = 0; key < 500; ++key)
        for_each_sample<Placement::shape>(r, 10.0f, 10.0f, base::hash(key), [&](float x, float y, float) {
            // In the frame of the doubled edges: x = a 2u + b 2v, a and b in [-1/2, 1/2].
            const double dx = (x - 10.0) / 2, dy = (y - 10.0) / 2, det = f.ux * f.vy - f.vx * f.uy;
            const double a = (dx * f.vy - dy * f.vx) / det, b = (dy * f.ux - dx * f.uy) / det;
            EXPECT_LE(std::abs(a), 0.5 + 1e-5);
            EXPECT_LE(std::abs(b), 0.5 + 1e-5);
        });
    // a and b uniform and independent: covariances of the sheared distribution.
    const Moments m = moments<Placement::shape>(r, 10.0f, 10.0f);
    EXPECT_NEAR(m.x, 0.0, 0.03);
    EXPECT_NEAR(m.y, 0.0, 0.03);
    EXPECT_NEAR(m.xx, 4 * (9 + 1) / 12.0, 0.05);
    EXPECT_NEAR(m.yy, 4 * (1 + 4) / 12.0, 0.05);
    EXPECT_NEAR(m.xy, 4 * (3 - 2) / 12.0, 0.05);
}

TEST(Region, OfAFootprintHasItsBoundingBox) {
    const CellGrid grid{64, 64, 2.0f, 1.0f};
    const PcfSettings settings{16, 3, 0, 2, 0, 0};
    Region r;
    ASSERT_TRUE(footprint_region(settings, grid, {3.0f, 1.0f, -1.0f, 2.0f}, false, r));
    EXPECT_FLOAT_EQ(r.left, -0.5f * (3 + 1) * 2 * 3);
    EXPECT_FLOAT_EQ(r.bottom, -0.5f * (1 + 2) * 3);
    EXPECT_FLOAT_EQ(r.ax * static_cast<float>(r.ns), -2 * r.left);
    EXPECT_FLOAT_EQ(r.by * static_cast<float>(r.nt), -2 * r.bottom);
}

TEST(Region, OfASmallShapeIsStretchedToMinSize) {
    const CellGrid grid{64, 64, 1.0f, 1.0f};
    Region r;
    ASSERT_TRUE(footprint_region(figure_4, grid, {0.02f, 0.01f, -0.01f, 0.03f}, true, r));
    const Extent e = extent(r, 0.0f, 0.0f);
    EXPECT_NEAR(e.x1, 2.0, 1e-5);
    EXPECT_NEAR(e.x0, -2.0, 1e-5);
    EXPECT_NEAR(e.y1, 2.0, 1e-5);
    EXPECT_NEAR(e.y0, -2.0, 1e-5);
    // A line along x has no shape to stretch: its box counts.
    ASSERT_TRUE(footprint_region(figure_4, grid, {4.0f, 0.0f, 1.0f, 0.0f}, true, r));
    EXPECT_FLOAT_EQ(r.left, -7.5f);
    EXPECT_FLOAT_EQ(r.bottom, -2.0f);
    EXPECT_EQ(r.ay, 0.0f);
    EXPECT_EQ(r.bx, 0.0f);
}

TEST(Region, OfAnUnknownFootprintIsRefused) {
    const CellGrid grid{64, 64, 1.0f, 1.0f};
    const float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    Region r;
    EXPECT_FALSE(footprint_region(figure_4, grid, {}, false, r));
    EXPECT_FALSE(footprint_region(figure_4, grid, {infinite, 0, 0, 1}, false, r));
    EXPECT_FALSE(footprint_region(figure_4, grid, {1, nan, 0, 1}, true, r));
}

// By hand from the printed code, whole numbers cut as C does.
TEST(Partition, FollowsFigure4) {
    const auto expect = [](PcfSettings s, float sres, float tres, int ns, int nt) {
        const Partition p = partition(s, sres, tres);
        EXPECT_EQ(p.ns, ns) << sres << " x " << tres;
        EXPECT_EQ(p.nt, nt) << sres << " x " << tres;
    };
    expect(figure_4, 2.0f, 2.0f, 4, 4);              // 16 cells are not fewer than 16: sqrt(16) + .5
    expect(figure_4, 1.9f, 2.0f, 4, 4);              // fewer: 3.8 + .5, 4 + .5
    expect(figure_4, 0.6f, 5.0f, 2, 10);             // fewer: 1.2 + .5 = 1, at least MinSamples
    expect(figure_4, 0.1f, 30.0f, 2, 16);            // fewer: 60 + .5, at most NumSamples
    expect(figure_4, 12.0f, 3.0f, 8, 2);             // sqrt(4) + .5 = 2; 16/2 + .5
    expect(figure_4, 3.0f, 12.0f, 2, 8);             // sqrt(64) + .5 = 8; 16/8 + .5
    expect(figure_4, 1000.0f, 2.0f, 8, 2);           // sqrt(.032) + .5 = 0, at least MinSamples
    expect(figure_4, 2.0f, 1000.0f, 2, 16);          // sqrt(8000) + .5 = 89, at most NumSamples; 1 + .5, at least 2
    expect({17, 1, 0, 1, 0, 0}, 9.0f, 9.0f, 4, 4);   // sqrt(17) + .5 = 4; 4.25 + .5
    expect({15, 1, 0, 3, 0, 0}, 20.0f, 9.0f, 5, 3);  // sqrt(6.75) + .5 = 3; 5 + .5
    expect({1, 1, 0, 1, 0, 0}, 0.2f, 9.0f, 1, 1);    // NumSamples 1: a point sample
}

}  // namespace
}  // namespace shadowbench::techniques

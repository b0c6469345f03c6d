// The 95 % interval that the truth states (value -+ t standard errors) holds closed forms in 93 to 97 % of cases.
//
// Rules, chosen before any case was looked at:
//  - A case counts if its footprint has a part on either side of the edge, and a set of rays is expected to have at
//    least 5 rays in each part: the usual rule for a binomial's normal approximation. With fewer, the sets' means take
//    too few values for Student's t. Footprints without an edge, where all rays see the same, hold trivially.
//  - 3,000 cases a family. Their share in the interval then has a standard deviation of 0.4 % if it is 95 % (binomial);
//    the bounds of 2 % are five of them.
//  - The squared errors add up to the squared standard errors, within 15 %: with 7 degrees of freedom their ratio has a
//    standard deviation of about 3 % in 3,000 cases (sqrt((2 + 2/7) / 3000)), or twice that as the cases differ in
//    size.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/half_space.h"
#include "bench/reference.h"
#include "rays/scenes.h"

namespace shadowbench::bench {
namespace {

using base::Vec2d;
using base::Vec3d;
using base::Vec3f;
using techniques::Query;
using testing::Polygon;

constexpr int resolution = 12, samples = 256, wanted = 3000;
constexpr double rays_of_a_set = samples / 8.0, least_rays = 5.0;
constexpr double student = 2.36462;  // exceeded with probability 5 % for 7 degrees of freedom

struct Box {  // of the map, in pixels
    Vec2d low, high;

    double area() const { return (high.x - low.x) * (high.y - low.y); }
    Polygon polygon() const { return {low, {high.x, low.y}, high, {low.x, high.y}}; }
};

// Where n . p < d, in map pixels.
struct HalfPlane {
    Vec2d n;
    double d;

    double area_in(const Box& box) const { return testing::area(testing::clip(box.polygon(), n, d)); }
    bool counts(const Box& box) const {
        const double inside = area_in(box) * rays_of_a_set, all = box.area() * rays_of_a_set;
        return std::min(inside, all - inside) >= least_rays;
    }
};

// Nine footprints that share no rays, one in each block of 4 x 4 pixels: within pixels and across them, of widths from
// 0.6 to 4. `overhang`: up to so far over the border of the map.
std::vector<Query> footprints(base::Random& random, float z, double overhang) {
    std::vector<Query> queries;
    for (int block = 0; block < 9; ++block) {
        const double width = block % 3 ? random.uniform(0.6, 4.0) : 1.0, free = 4.0 - width;
        double x = block % 3 * 4 + 0.5 * width, y = block / 3 * 4 + 0.5 * width;
        x += block % 3 ? random.uniform(0, free) : std::floor(random.uniform(0, 4));  // whole pixels, and others
        y += block % 3 ? random.uniform(0, free) : std::floor(random.uniform(0, 4));
        if (overhang > 0.0) {
            if (block % 3 == 2) x = resolution - 0.5 * width + random.uniform(0, overhang * width);
            if (block / 3 == 0) y = 0.5 * width - random.uniform(0, overhang * width);
        }
        queries.push_back({static_cast<float>(x), static_cast<float>(y), z, static_cast<float>(width)});
    }
    return queries;
}

Box box_of(const Query& q) {
    const auto inside = [](double place) { return std::clamp(place, 0.0, static_cast<double>(resolution)); };
    const double h = 0.5 * static_cast<double>(q.width);
    return {{inside(q.x - h), inside(q.y - h)}, {inside(q.x + h), inside(q.y + h)}};
}

// Half planes whose edge passes within `off` of a place, at all angles; every fourth along an axis or a diagonal.
HalfPlane half_plane_by(const Vec2d& place, double off, base::Random& random) {
    constexpr double eighth = 0.78539816339744831;
    const double angle =
        random.below(4) ? random.uniform(0, 8 * eighth) : static_cast<double>(random.below(8)) * eighth;
    const Vec2d n(std::cos(angle), std::sin(angle));
    return {n, n.dot(place) + random.uniform(-off, off)};
}

HalfPlane any_half_plane(base::Random& random) {
    return half_plane_by({6, 6}, 5.0, random);
}

// The surface over a half plane of the map of rays::testing::directional(), which looks along -z at [-1, 1]^2.
scene::Object surface(const HalfPlane& half, double height, const Vec3f& opacity) {
    const Vec2d across = half.n, along(-half.n.y, half.n.x);
    const auto world = [&](double u, double v) {
        const Vec2d p = (across * u + along * v) * (2.0 / resolution) - Vec2d(1, 1);
        return Vec3f(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(height));
    };
    const Vec3f corner = world(half.d - 60, -60);
    scene::Object object = rays::testing::quad(corner, world(half.d, -60) - corner, world(half.d - 60, 60) - corner);
    object.opacity = opacity;
    return object;
}

class Coverage {
public:
    void add(double value, double error, double expected) {
        const double off = value - expected;
        held_ += std::abs(off) <= student * error;
        squares_ += off * off;
        stated_ += error * error;
        ++cases_;
    }
    bool enough() const { return cases_ >= wanted; }
    void check() const {
        const double share = static_cast<double>(held_) / cases_, ratio = squares_ / stated_;
        ::testing::Test::RecordProperty("share", std::to_string(share));
        ::testing::Test::RecordProperty("ratio", std::to_string(ratio));
        EXPECT_GE(share, 0.93) << "errors are larger than stated";
        EXPECT_LE(share, 0.97) << "errors are smaller than stated";
        EXPECT_NEAR(ratio, 1.0, 0.15) << "squared errors over those stated";
    }

private:
    int held_ = 0, cases_ = 0;
    double squares_ = 0.0, stated_ = 0.0;
};

scene::RaySettings settings_of(std::uint64_t seed) {
    scene::RaySettings settings = rays::testing::rays(resolution, samples);
    settings.seed = seed;
    return settings;
}

rays::LightView view_of(const scene::Light& light, const scene::Scene& scene) {
    return rays::make_light_view(light, scene, {resolution, resolution}, "/lights/0");
}

// The map's x and y grow along the world's, or against it; half planes are given in pixels of a map that grows with it.
void check_orientation(const rays::LightView& view) {
    const Vec3d low = rays::to_light(view, {-1, -1, 0}), high = rays::to_light(view, {1, 1, 0});
    ASSERT_NEAR(low.x, 0, 1e-9);
    ASSERT_NEAR(low.y, 0, 1e-9);
    ASSERT_NEAR(high.x, resolution, 1e-9);
    ASSERT_NEAR(high.y, resolution, 1e-9);
}

void edges(double overhang, std::uint64_t key) {
    Coverage coverage;
    for (std::uint64_t seed = 0; !coverage.enough(); ++seed) {
        ASSERT_LT(seed, 5000u);
        base::Random random(base::hash(seed, key));
        std::vector<Query> queries = footprints(random, 0.0f, overhang);
        const auto at_border = [&](std::size_t q) { return q % 3 == 2 || q / 3 == 0; };
        if (overhang > 0.0)
            for (std::size_t q = queries.size(); q-- > 0;)
                if (!at_border(q)) queries.erase(queries.begin() + static_cast<std::ptrdiff_t>(q));
        const Box one = box_of(queries[random.below(queries.size())]);
        const HalfPlane half = half_plane_by((one.low + one.high) * 0.5, 1.0, random);
        scene::Scene scene;
        scene.objects.push_back(surface(half, 0.0, Vec3f(1)));
        const rays::LightView view = view_of(rays::testing::directional(), scene);
        check_orientation(view);
        for (Query& query : queries) query.z = static_cast<float>(rays::to_light(view, {0, 0, -1}).z);
        const Truth truth = reference_visibility(scene, view, settings_of(seed), queries, {});
        ASSERT_EQ(truth.degrees, 7);
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const Box box = box_of(queries[q]);
            if (!half.counts(box)) continue;
            coverage.add(truth.value[q], truth.standard_error[q], 1.0 - half.area_in(box) / box.area());
        }
    }
    coverage.check();
}

TEST(TruthCoverage, OfAnEdge) {
    edges(0.0, 101);
}

TEST(TruthCoverage, OfAnEdgeInAFootprintThatTheBorderOfTheMapCuts) {
    edges(0.7, 102);
}

TEST(TruthCoverage, OfTwoCoatsThatOverlap) {
    const Vec3f first(0.6f, 0.25f, 0.9f), second(0.5f, 0.8f, 0.1f);
    Coverage coverage;
    for (std::uint64_t seed = 0; !coverage.enough(); ++seed) {
        ASSERT_LT(seed, 5000u);
        base::Random random(base::hash(seed, 103));
        const HalfPlane a = any_half_plane(random), b = any_half_plane(random);
        scene::Scene scene;
        scene.objects = {surface(a, 0.2, first), surface(b, -0.3, second)};
        const rays::LightView view = view_of(rays::testing::directional(), scene);
        const std::vector<Query> queries =
            footprints(random, static_cast<float>(rays::to_light(view, {0, 0, -1}).z), 0.0);
        const Truth truth = reference_visibility(scene, view, settings_of(seed), queries, {});
        ASSERT_EQ(truth.channels, 3);
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const Box box = box_of(queries[q]);
            if (!a.counts(box) && !b.counts(box)) continue;
            const std::size_t c = seed % 3;
            const double both = testing::area(testing::clip(testing::clip(box.polygon(), a.n, a.d), b.n, b.d));
            const double of_a = static_cast<double>(first[static_cast<int>(c)]),
                         of_b = static_cast<double>(second[static_cast<int>(c)]);
            const double absorbed = of_a * a.area_in(box) + of_b * b.area_in(box) - of_a * of_b * both;
            const std::size_t i = c * queries.size() + q;
            coverage.add(truth.value[i], truth.standard_error[i], 1.0 - absorbed / box.area());
        }
    }
    coverage.check();
}

// The mean over a box of f(n . p), where f is smooth between `breaks`: its area below n . p = s grows by a trapezoid's
// height, linear between the corners. Gauss-Legendre quadrature of five points between all of these.
template <class F>
double mean_across(const Box& box, const Vec2d& n, std::vector<double> breaks, const F& f) {
    for (const Vec2d& corner : box.polygon()) breaks.push_back(n.dot(corner));
    std::sort(breaks.begin(), breaks.end());
    const double a = std::abs(n.x) * (box.high.x - box.low.x), b = std::abs(n.y) * (box.high.y - box.low.y);
    const double middle = 0.5 * n.dot(box.low + box.high), top = std::min(a, b), whole = a + b;
    const auto height = [&](double s) {  // of the trapezoid, of area 1
        const double out = std::abs(s - middle) - 0.5 * (whole - 2 * top);
        return std::clamp(1.0 - out / top, 0.0, 1.0) / std::max(a, b);
    };
    constexpr std::array<double, 5> at = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                          0.9061798459386640};
    constexpr std::array<double, 5> weight = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                              0.4786286704993665, 0.2369268850561891};
    double sum = 0.0;
    for (std::size_t i = 1; i < breaks.size(); ++i) {
        const double half = 0.5 * (breaks[i] - breaks[i - 1]), from = 0.5 * (breaks[i] + breaks[i - 1]);
        if (half <= 0.0) continue;
        for (std::size_t k = 0; k < at.size(); ++k) {
            const double s = from + half * at[k];
            sum += half * weight[k] * f(s) * height(s);
        }
    }
    return sum;
}

TEST(TruthCoverage, MeansAcrossABoxAreRight) {
    const Box box{{1, 2}, {2.5, 2.7}};
    const Vec2d n = Vec2d(0.3, -0.8);
    EXPECT_NEAR(mean_across(box, n, {}, [](double) { return 1.0; }), 1.0, 1e-12);
    EXPECT_NEAR(mean_across(box, n, {}, [](double s) { return s; }), n.dot(Vec2d(1.75, 2.35)), 1e-12);
    const HalfPlane half{n, -1.2};
    EXPECT_NEAR(mean_across(box, n, {-1.2}, [](double s) { return s < -1.2 ? 1.0 : 0.0; }),
                half.area_in(box) / box.area(), 1e-12);
}

// A layer of media below a light that is tilted: rays near the layer's border, which is slanted in the map, pass
// through a part of it.
TEST(TruthCoverage, OfALayerOfMediaWithASlantedBorder) {
    Coverage coverage;
    for (std::uint64_t seed = 0; !coverage.enough(); ++seed) {
        ASSERT_LT(seed, 5000u);
        base::Random random(base::hash(seed, 104));
        scene::GridVolume layer = rays::testing::slab();
        const double border = random.uniform(-0.7, 0.7), thick = random.uniform(0.05, 0.6);
        layer.upper = {border, 6, 0.5 * thick};
        layer.lower = {-6, -6, -0.5 * thick};
        scene::Scene scene;
        scene.objects.emplace_back();
        scene.objects[0].shape = layer;
        scene.objects[0].extinction = Vec3f(static_cast<float>(random.uniform(0.5, 6)));
        scene::Light light = rays::testing::directional();
        light.target = {0, 0, 0};
        const double tilt = random.uniform(0.2, 1.0), turn = random.uniform(0.05, 1.5);
        light.direction = Vec3d(tilt, 0, -1).normalized();
        light.up = Vec3d(std::sin(turn), std::cos(turn), 0);
        const rays::LightView view = view_of(light, scene);
        // The ray at map position p enters the layer where x = entry(p), affine in p, and leaves it tilt * thick later.
        const auto entry = [&](double x, double y) {
            const Vec3d on = rays::to_world(view, rays::unproject(view, x, y, 1.0));
            return on.x + tilt * (on.z - 0.5 * thick);
        };
        const double at_0 = entry(0, 0);
        const Vec2d n(entry(1, 0) - at_0, entry(0, 1) - at_0);
        const double first = border - tilt * thick - at_0, last = border - at_0;  // of n . p: all of the layer, nothing
        const double depth =
            2.0 * static_cast<double>(scene.objects[0].extinction.x) * thick * std::sqrt(1.0 + tilt * tilt);
        const auto through = [&](double s) {
            return std::exp(-depth * std::clamp((last - s) / (last - first), 0.0, 1.0));
        };
        const std::vector<Query> queries =
            footprints(random, static_cast<float>(rays::to_light(view, {0, 0, -3}).z) + 4.0f, 0.0);
        const Truth truth = reference_visibility(scene, view, settings_of(seed), queries, {});
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const Box box = box_of(queries[q]);
            const HalfPlane whole{n, first}, none{n, last};
            if (!whole.counts(box) && !none.counts(box)) continue;
            coverage.add(truth.value[q], truth.standard_error[q], mean_across(box, n, {first, last}, through));
        }
    }
    coverage.check();
}

TEST(TruthCoverage, OfAMovingEdge) {
    Coverage coverage;
    for (std::uint64_t seed = 0; !coverage.enough(); ++seed) {
        ASSERT_LT(seed, 5000u);
        base::Random random(base::hash(seed, 105));
        std::vector<Query> queries = footprints(random, 0.0f, 0.0);
        const Query& one = queries[random.below(queries.size())];
        HalfPlane half;
        const double speed = std::exp(random.uniform(std::log(0.1), std::log(8.0)));  // pixels a shutter
        const double angle = random.uniform(0.01, 1.56) + 1.5707963267948966 * static_cast<double>(random.below(4));
        half.n = {std::cos(angle), std::sin(angle)};  // the closed form divides by both parts
        half.d = half.n.dot(Vec2d(one.x, one.y)) + random.uniform(-1, 1) - 0.5 * speed;
        scene::Scene scene;
        scene.objects.push_back(surface(half, 0.0, Vec3f(1)));
        const Vec2d motion = half.n * (speed * 2.0 / resolution);
        scene.objects[0].motion = {static_cast<float>(motion.x), static_cast<float>(motion.y), 0.0f};
        const rays::LightView view = view_of(rays::testing::directional(), scene);
        for (Query& query : queries) query.z = static_cast<float>(rays::to_light(view, {0, 0, -1}).z);
        const Truth truth = reference_visibility(scene, view, settings_of(seed), queries, {});
        for (std::size_t q = 0; q < queries.size(); ++q) {
            const Box box = box_of(queries[q]);
            const double covered = testing::half_space_in_cube(
                {half.n.x * (box.high.x - box.low.x), half.n.y * (box.high.y - box.low.y), -speed},
                half.d - half.n.dot(box.low));
            if (std::min(covered, 1.0 - covered) * box.area() * rays_of_a_set < least_rays) continue;
            coverage.add(truth.value[q], truth.standard_error[q], 1.0 - covered);
        }
    }
    coverage.check();
}

}  // namespace
}  // namespace shadowbench::bench

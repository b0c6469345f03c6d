// Light rays that the contract of rays/light_rays.h allows and no scene should contain: every row keeps its promises.
#include <gtest/gtest.h>

#include <cmath>

#include "curves/curve.h"
#include "techniques/hand_rays.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using testing::Segment;
using testing::Segments;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float denormal = std::numeric_limits<float>::denorm_min();

float next(float z) {
    return std::nextafter(z, infinity);
}

// Transmittance of a ray up to each of some depths, from optical depths in long double.
std::vector<double> exact(const Segments& segments, const std::vector<float>& depths) {
    std::vector<long double> all, inside;  // optical depth of the whole segment, and what counts inside it
    for (const Segment& s : segments) {
        all.push_back(-std::log(static_cast<long double>(s.through)));
        inside.push_back(-std::log(static_cast<long double>(std::max(s.through, std::numeric_limits<float>::min()))));
    }
    std::vector<double> result;
    for (const long double z : depths) {
        long double depth = 0.0L;
        for (std::size_t i = 0; i < segments.size(); ++i) {
            const long double front = segments[i].front, back = segments[i].back;
            if (front < z) depth += back <= z ? all[i] : inside[i] * ((z - front) / (back - front));
        }
        result.push_back(static_cast<double>(std::exp(-depth)));
    }
    return result;
}

// Ends of segments with the floats around them, depths between, and some before and behind all.
std::vector<float> depths_of(const Segments& segments) {
    std::vector<float> depths = {-infinity, -3e38f, -1, 0, denormal, 1e-3f, 1, 1e6f, 3e38f, infinity};
    const std::size_t stride = segments.size() / 40 + 1;
    for (std::size_t i = 0; i < segments.size(); i += stride)
        for (const float z : {segments[i].front, segments[i].back}) {
            depths.insert(depths.end(), {std::nextafter(z, -infinity), z, next(z), next(next(z))});
            for (const float share : {0.03f, 0.5f, 0.9f})
                depths.push_back(segments[i].front * (1 - share) + segments[i].back * share);
        }
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    return depths;
}

struct HardRay {
    HardRay(const char* its_name, Segments its_segments)
        : name(its_name),
          segments(std::move(its_segments)),
          depths(depths_of(segments)),
          truth(exact(segments, depths)) {}

    const char* name;
    Segments segments;
    std::vector<float> depths;  // the depths of the queries, from -infinity to infinity
    std::vector<double> truth;  // the transmittance there
};

Segments repeated(int count, const Segment& segment) {
    return Segments(static_cast<std::size_t>(count), segment);
}

// One on every float from `start` on; media reach to the next one.
Segments on_floats(float start, int count, bool media, float through) {
    Segments result;
    for (float front = start; count > 0; --count, front = next(front))
        result.push_back({front, media ? next(front) : front, through});
    return result;
}

Segments joined(Segments a, const Segments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const std::vector<HardRay>& hard_rays() {
    static const float least = std::numeric_limits<float>::min();
    static const std::vector<HardRay> rays = {
        {"nothing", {}},
        {"a wall at depth 0", {{0, 0, 0}}},
        {"a wall at one depth, which is all depths", {{3, 3, 0}}},
        {"several things at one depth", {{3, 3, 0.5f}, {3, 3, 0.25f}, {3, 3, 1.0f}}},
        {"a wall in front of the light", {{-5, -5, 0}}},
        {"depths of 1e-3 and 1e6", {{1e-3f, 1e-3f, 0.5f}, {1e-3f, 2e-3f, 0.5f}, {1, 1e6f, 0.3f}, {1e6f, 1e6f, 0}}},
        {"walls at 1e-3 and 1e6", {{1e-3f, 1e-3f, 0.5f}, {1e6f, 1e6f, 0.5f}}},
        {"depths of 1e30", {{1, 1, 0.5f}, {2, 1e30f, 0.2f}, {1e30f, 1e30f, 0.5f}}},
        {"depths from -1e30 to 1e30", {{-1e30f, -1, 0.5f}, {-1e30f, 1e30f, 0.5f}, {3, 3, 0.5f}}},
        {"denormal depths",
         {{0, 0, 0.9f}, {denormal, denormal, 0.5f}, {denormal, 4 * denormal, 0.5f}, {0, 1e-39f, 0.5f}}},
        {"a denormal slab", {{0, 1e-40f, 0.1f}}},
        {"denormal depths before ordinary ones", {{0, denormal, 0.5f}, {1e-40f, 1e-40f, 0.5f}, {1, 2, 0.5f}}},
        {"opaque media", {{1, 2, 0}, {1.5f, 3, 0}, {2, 2, 0}, {2.5f, 2.5f, 0.5f}}},
        {"an opaque slab", {{1, 2, 0}}},
        {"an opaque surface", {{1, 2, 0.5f}, {1.5f, 1.5f, 0.0f}, {3, 4, 0.5f}}},
        {"dark media one in the other", joined(repeated(50, {1, 3, 1e-30f}), {{1, 4, 0.5f}})},
        {"dark media one behind the other", {{1, 2, 1e-25f}, {2, 3, 1e-25f}, {3, 4, 1e-25f}}},
        {"denormal transmittance", {{1, 1, denormal}, {2, 3, 1e-40f}, {3, 3, least}}},
        {"media of denormal transmittance", {{1, 2, denormal}, {1.5f, 3, 1e-40f}, {4, 5, 0.5f}}},
        {"clear segments", {{1, 1, 1}, {2, 3, 1}, {3, 3, 1}}},
        {"nearly clear surfaces", repeated(3000, {1, 1, std::nextafter(1.0f, 0.0f)})},
        {"nearly clear media", repeated(3000, {1, 2, std::nextafter(1.0f, 0.0f)})},
        {"coincident surfaces", repeated(5000, {2, 2, 0.999f})},
        {"coincident surfaces inside media", joined(repeated(1000, {2, 2, 0.999f}), repeated(100, {1, 3, 0.99f}))},
        {"surfaces on neighbouring floats", on_floats(1, 2000, false, 0.999f)},
        {"media a float thin", on_floats(1, 2000, true, 0.999f)},
        {"media a float thin, far away", on_floats(1e6f, 500, true, 0.99f)},
        {"media a float thin beside a wide one", joined(on_floats(1, 50, true, 0.9f), {{0.5f, 2, 0.5f}})},
        {"one medium a float thin", {{1, std::nextafter(1.0f, 2.0f), 0.3f}}},
        {"a dark medium a float thin", {{1, std::nextafter(1.0f, 2.0f), 0}}},
        {"steep beside flat", {{1, std::nextafter(1.0f, 2.0f), 1e-3f}, {1, 1e6f, 0.9f}, {5e5f, 5e5f, 0.9f}}},
        {"hair", testing::random_segments(5, 60, 0.5, 4)}};
    return rays;
}

Segments spaced(int count, float through, bool media) {
    Segments result;
    for (int i = 0; i < count; ++i) {
        const auto front = static_cast<float>(1.0 + i * 1e-4);
        result.push_back({front, media ? static_cast<float>(1.0 + (i + 1) * 1e-4) : front, through});
    }
    return result;
}

const std::vector<HardRay>& long_rays() {
    static const std::vector<HardRay> rays = {
        {"100,000 surfaces of opacity 1e-4", spaced(100000, 1.0f - 1e-4f, false)},
        {"100,000 surfaces of opacity 0.999", spaced(100000, 1e-3f, false)},
        {"100,000 media of optical depth 1e-5", spaced(100000, static_cast<float>(std::exp(-1e-5)), true)},
        {"100,000 media that are nearly clear", spaced(100000, std::nextafter(1.0f, 0.0f), true)}};
    return rays;
}

bool is_opaque(const Segments& segments) {
    return std::all_of(segments.begin(), segments.end(),
                       [](const Segment& s) { return s.front == s.back && (s.through == 0.0f || s.through == 1.0f); });
}

class HostileRays : public ::testing::TestWithParam<const Technique*> {
protected:
    const Technique& row() const { return *GetParam(); }

    std::string text(const ParameterValues& values, const HardRay& ray) const {
        return testing::text_of(row(), values) + ": " + ray.name;
    }

    // Calls visit for a map of one such ray in its least bounds of depth, and one in bounds as those of captured maps.
    template <class Visit>
    void for_each_map(const Visit& visit) const {
        if (row().traits.traces) return;
        for (const ParameterValues& values : testing::variants(row())) {
            const bool defaults = values.values == testing::defaults(row()).values;
            for (const HardRay& ray : hard_rays()) visit_maps_of(ray, values, visit);
            if (!defaults) continue;
            for (const HardRay& ray : long_rays()) visit_maps_of(ray, values, visit);
        }
    }

private:
    template <class Visit>
    void visit_maps_of(const HardRay& ray, const ParameterValues& values, const Visit& visit) const {
        const testing::HandRays given{1, 1, 1, {ray.segments}};
        const rays::LightRays tile = testing::light_rays(given);
        for (const rays::MapLayout& layout : {testing::layout_of(given), testing::outward(testing::layout_of(given))})
            visit(testing::make_map(row(), values, tile, layout), values, ray);
    }
};

TEST_P(HostileRays, AnswersNeverRiseNorLeaveTheRange) {
    for_each_map([&](const testing::HandMap& built, const ParameterValues& values, const HardRay& ray) {
        const Promises promised = promises(row(), values);
        const double least = testing::least_answer(row(), values, built.layout);
        const std::vector<float>& depths = ray.depths;
        std::vector<Query> queries;
        for (const float z : depths) queries.push_back({0.5f, 0.5f, z, 0.0f});
        const std::vector<float> answers = built.lookup(queries);
        const bool draws = row().traits.draws_samples;  // at other positions for each depth
        for (std::size_t i = 0; i < answers.size(); ++i) {
            ASSERT_TRUE(answers[i] >= least && std::isfinite(answers[i])) << text(values, ray) << " at " << depths[i];
            if (promised.unit_range) {
                ASSERT_LE(answers[i], 1.0f) << text(values, ray) << " at " << depths[i];
            }
            if (promised.monotone && i > 0 && !draws) {
                ASSERT_LE(answers[i], answers[i - 1]) << text(values, ray) << " at " << depths[i];
            }
        }
        if (!promised.early) {
            EXPECT_EQ(answers.front(), 1.0f) << text(values, ray);
        }
    });
}

TEST_P(HostileRays, StoredFunctionsKeepTheirPromises) {
    for_each_map([&](const testing::HandMap& built, const ParameterValues& values, const HardRay& ray) {
        const Promises promised = promises(row(), values);
        const double bound = promised.opaque_only && !is_opaque(ray.segments) ? std::numeric_limits<double>::infinity()
                                                                              : row().error_bound(values, built.layout);
        const double least = testing::least_answer(row(), values, built.layout);
        const std::vector<float> depths(ray.depths.begin() + 1, ray.depths.end() - 1);  // those that are finite
        curves::Curve stored;
        built.map->stored(0, 0, 0, depths, stored);
        for (std::size_t i = 0; i < stored.size(); ++i) {
            ASSERT_TRUE(std::isfinite(stored[i].z) && std::isfinite(stored[i].value)) << text(values, ray);
            ASSERT_GE(stored[i].value, least) << text(values, ray);
            if (promised.unit_range) {
                ASSERT_LE(stored[i].value, 1.0f) << text(values, ray);
            }
            if (i > 0) {
                ASSERT_GE(stored[i].z, stored[i - 1].z) << text(values, ray);
                if (promised.monotone) {
                    ASSERT_LE(stored[i].value, stored[i - 1].value) << text(values, ray) << " at " << stored[i].z;
                }
            }
        }
        for (std::size_t i = 0; i < depths.size(); ++i)
            ASSERT_NEAR(curves::evaluate(stored, depths[i]), ray.truth[i + 1], bound + 1e-6)
                << text(values, ray) << " at " << depths[i];
    });
}

TEST_P(HostileRays, AreFeltBehindAllOfThem) {
    for_each_map([&](const testing::HandMap& built, const ParameterValues& values, const HardRay& ray) {
        const Promises promised = promises(row(), values);
        // Where a lookup sees more than this ray.
        if (row().traits.beyond_footprint && testing::pointwise(row(), values).values != values.values) return;
        if (promised.opaque_only && !is_opaque(ray.segments)) return;
        const double bound = row().error_bound(values, built.layout);
        double allowed = std::isfinite(bound) ? bound + 1e-6 : 1e-5 + promised.leak;
        allowed += row().traits.segment_rounding * static_cast<double>(ray.segments.size());
        const auto behind = static_cast<float>(next(built.layout.z_max) + 1.01 * testing::bias_of(row(), values));
        for (const float z : {behind, infinity})
            ASSERT_NEAR(built({0.5f, 0.5f, z, 0.0f}), ray.truth.back(), allowed) << text(values, ray) << " at " << z;
        if (!promised.unit_range) return;
        curves::Curve stored;
        built.map->stored(0, 0, 0, {}, stored);
        EXPECT_NEAR(stored.empty() ? 1.0f : stored.back().value, built({0.5f, 0.5f, infinity, 0.0f}), 1e-6)
            << text(values, ray);
    });
}

INSTANTIATE_TEST_SUITE_P(Registry, HostileRays, ::testing::ValuesIn(testing::rows()), testing::name_of_row);

}  // namespace
}  // namespace shadowbench::techniques

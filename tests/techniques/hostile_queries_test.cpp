// Numbers that no caller should ask for: every row answers them as technique.h says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "techniques/built.h"
#include "techniques/hand_rays.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using testing::HandRays;
using testing::Segments;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float largest = std::numeric_limits<float>::max();
constexpr float denormal = std::numeric_limits<float>::denorm_min();

std::vector<float> hostile_places(int pixels) {
    const auto side = static_cast<float>(pixels);
    std::vector<float> places = {0.5f * side, nan,    infinity, -infinity, largest, -largest,   denormal,
                                 -denormal,   1e-30f, 1e9f,     -1e9f,     -0.0f,   side - 0.3f};
    for (const float border : {0.0f, 1.0f, std::floor(0.5f * side), side - 1.0f, side})
        places.insert(places.end(), {std::nextafter(border, -infinity), border, std::nextafter(border, infinity)});
    return places;
}

std::vector<float> hostile_depths(const rays::MapLayout& layout) {
    const float middle = 0.5f * (layout.z_min + layout.z_max);
    std::vector<float> depths = {
        middle,    nan,  infinity, -infinity, largest, -largest, denormal,
        -denormal, 0.0f, -0.0f,    1e30f,     -1e30f,  -1.0f,    std::numeric_limits<float>::min()};
    for (const float bound : {layout.z_min, layout.z_max})
        depths.insert(depths.end(), {std::nextafter(bound, -infinity), bound, std::nextafter(bound, infinity)});
    return depths;
}

const std::vector<float> hostile_widths = {1.0f,
                                           nan,
                                           infinity,
                                           -infinity,
                                           largest,
                                           -largest,
                                           denormal,
                                           -1.0f,
                                           -0.0f,
                                           0.0f,
                                           1e-30f,
                                           1e30f,
                                           1e9f,
                                           -1e30f,
                                           0.999f,
                                           1.5f,
                                           2.5f,
                                           7.25f,
                                           std::nextafter(1.0f, 2.0f)};

// Each number with each other one; the others are ordinary.
std::vector<Query> hostile_queries(const rays::MapLayout& layout) {
    const std::vector<float> xs = hostile_places(layout.width), ys = hostile_places(layout.height),
                             zs = hostile_depths(layout);
    std::vector<Query> queries;
    for (const float x : xs) {
        for (const float y : ys) queries.push_back({x, y, layout.z_max, 2.0f});
        for (const float z : zs) queries.push_back({x, ys[0], z, 0.0f});
        for (const float width : hostile_widths) queries.push_back({x, ys[0], zs[0], width});
    }
    for (const float width : hostile_widths) {
        for (const float y : ys) queries.push_back({xs[0], y, layout.z_max, width});
        for (const float z : zs) queries.push_back({xs[0], ys[0], z, width});
    }
    return queries;
}

std::vector<Query> every(std::size_t step, const std::vector<Query>& queries) {
    std::vector<Query> result;
    for (std::size_t i = 0; i < queries.size(); i += step) result.push_back(queries[i]);
    return result;
}

std::string text_of(const Query& q) {
    return fmt::format("x {} y {} z {} width {}", q.x, q.y, q.z, q.width);
}

class HostileQueries : public ::testing::TestWithParam<const Technique*> {
protected:
    const Technique& row() const { return *GetParam(); }
    // A row that traces takes as many rays per lookup as its largest number.
    bool costly(const ParameterValues& values) const {
        return row().traits.traces && std::any_of(values.values.begin(), values.values.end(), [](const auto& value) {
                   const double* number = std::get_if<double>(&value.second);
                   return number && *number > 1000.0;
               });
    }
    std::string text(const ParameterValues& values) const { return testing::text_of(row(), values); }
};

// A pixel of hair, media, walls and nothing, at least one of each per sample.
Segments any_ray(std::uint64_t seed) {
    switch (seed % 4) {
        case 0:
            return {};
        case 1:
            return {{1.5f, 1.5f, 0.0f}};
        case 2:
            return {{1.0f, 3.0f, 0.2f}};
        default:
            return testing::random_segments(seed, 12, 0.5, 4);
    }
}

HandRays any_rays(int width, int height, int samples, bool coloured = false) {
    HandRays given{width, height, samples, {}, coloured};
    for (int ray = 0; ray < width * height * samples; ++ray)
        given.rays.push_back(any_ray(base::hash(static_cast<std::uint64_t>(ray))));
    return given;
}

HandRays same_rays(int width, int height, int samples, const Segments& ray) {
    return {width, height, samples, std::vector<Segments>(static_cast<std::size_t>(width) * height * samples, ray)};
}

// Calls visit(map, layout, settings) for maps of many rays and settings.
template <class Visit>
void for_each_map(const Technique& row, const Visit& visit) {
    const HandRays given[] = {same_rays(3, 2, 4, {}),
                              same_rays(4, 4, 1, {{2.0f, 2.0f, 0.0f}}),
                              same_rays(2, 3, 6, {{1.0f, 3.0f, 0.1f}}),
                              any_rays(4, 3, 4),
                              any_rays(5, 5, 2, true),
                              any_rays(1, 1, 1),
                              any_rays(1, 1, 9)};
    for (const ParameterValues& values : testing::variants(row)) {
        if (row.traits.traces) {
            for (const bool media : {false, true}) {
                const auto b = testing::build(row, testing::hairy_scene(media), rays::testing::directional(),
                                              rays::testing::rays(4, 1), to_json(values).dump().c_str());
                visit(*b.map, b.rays.layout, values);
            }
            continue;
        }
        for (const HandRays& rays : given) visit(*make_map(row, values, rays).map, layout_of(rays), values);
        if (values.values == testing::defaults(row).values) {
            const HandRays narrow = any_rays(1, 4096, 1);
            visit(*make_map(row, values, narrow).map, layout_of(narrow), values);
        }
    }
}

std::vector<float> ask(const Map& map, std::span<const Query> queries) {
    std::vector<float> answers(queries.size() * static_cast<std::size_t>(map.channels()), -1.0f);
    map.lookup(queries, answers);
    return answers;
}

bool inside(const Query& q, const rays::MapLayout& layout) {
    return q.x >= 0 && q.y >= 0 && q.x < static_cast<float>(layout.width) && q.y < static_cast<float>(layout.height);
}

// The depth and width for which the contract takes a query's.
Query understood(Query q, bool draws_samples) {
    if (!(q.width > 0.0f)) q.width = 0.0f;
    if (q.width > 1e30f) q.width = 1e30f;
    if (q.z == infinity && !draws_samples) q.z = largest;
    return q;
}

TEST_P(HostileQueries, AreAnsweredAsTheContractSays) {
    for_each_map(row(), [&](const Map& map, const rays::MapLayout& layout, const ParameterValues& values) {
        std::vector<Query> queries = hostile_queries(layout), meant;
        if (costly(values)) queries = every(600, queries);
        const Promises promised = promises(row(), values);
        for (const Query& q : queries) meant.push_back(understood(q, row().traits.draws_samples));
        const std::vector<float> answers = ask(map, queries), expected = ask(map, meant);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const Query& q = queries[i % queries.size()];
            ASSERT_TRUE(std::isfinite(answers[i])) << text(values) << ": " << text_of(q) << " gives " << answers[i];
            ASSERT_GE(answers[i], testing::least_answer(row(), values, layout)) << text(values) << ": " << text_of(q);
            if (promised.unit_range) {
                ASSERT_LE(answers[i], 1.0f) << text(values) << ": " << text_of(q);
            }
            ASSERT_EQ(answers[i], expected[i]) << text(values) << ": " << text_of(q);
            if (!inside(q, layout)) {
                ASSERT_EQ(answers[i], 1.0f) << text(values) << ": outside is lit, " << text_of(q);
            }
            if (!promised.early && (std::isnan(q.z) || q.z == -infinity)) {
                ASSERT_EQ(answers[i], 1.0f) << text(values) << ": nothing lies before " << text_of(q);
            }
        }
    });
}

TEST_P(HostileQueries, TouchLinesOfTheMapAlone) {
    for_each_map(row(), [&](const Map& map, const rays::MapLayout& layout, const ParameterValues& values) {
        std::size_t sum = 0, found = 0;
        std::vector<const void*> lines;
        for (const Query& q : every(3, hostile_queries(layout))) {
            lines.clear();
            map.touched(q, lines);
            // Reading these addresses must be allowed, which the address sanitizer checks.
            for (const void* line : lines) sum += *static_cast<const volatile unsigned char*>(line);
            found += lines.size();
            if (!inside(q, layout)) {
                ASSERT_TRUE(lines.empty()) << text(values) << ": " << text_of(q);
            }
            ASSERT_LE(lines.size(), map.bytes() / 64 + 16) << text(values) << ": no line twice, " << text_of(q);
        }
        EXPECT_LE(sum, 255 * found);
    });
}

TEST_P(HostileQueries, MayHaveFootprintsThatAreNone) {
    const float numbers[] = {1.0f, nan, infinity, -infinity, largest, -largest, denormal, 1e-44f, 0.0f, 1e9f, -1e30f};
    std::vector<Footprint> footprints;
    for (const float a : numbers)
        for (const float b : numbers) {
            footprints.insert(footprints.end(), {{a, 0, 0, b}, {a, b, a, b}, {a, b, -b, a}, {0, a, b, 0}});
            footprints.push_back({a, 1, 1, b});
        }
    for_each_map(row(), [&](const Map& map, const rays::MapLayout& layout, const ParameterValues& values) {
        if (costly(values) || layout.height > 100) return;
        for (const float width : {1.0f, nan, 1e30f}) {
            const Query q{0.4f * static_cast<float>(layout.width), 0.7f * static_cast<float>(layout.height),
                          layout.z_max, width};
            const std::vector<Query> queries(footprints.size(), q);
            std::vector<float> answers(queries.size() * static_cast<std::size_t>(map.channels()), -1.0f);
            map.lookup_shaped(queries, footprints, answers);
            const float unknown = ask(map, {&q, 1})[0];
            std::vector<const void*> lines;
            for (std::size_t i = 0; i < answers.size(); ++i) {
                const Footprint& f = footprints[i % footprints.size()];
                ASSERT_TRUE(answers[i] >= testing::least_answer(row(), values, layout) && std::isfinite(answers[i]))
                    << text(values) << ": " << f.ux << " " << f.uy << " " << f.vx << " " << f.vy << " gives "
                    << answers[i];
                const bool finite =
                    std::isfinite(f.ux) && std::isfinite(f.uy) && std::isfinite(f.vx) && std::isfinite(f.vy);
                if (!finite && i < footprints.size()) {
                    ASSERT_EQ(answers[i], unknown) << text(values);
                }
                lines.clear();
                if (i % 5 == 0) map.touched_shaped(q, f, lines);
                ASSERT_LE(lines.size(), map.bytes() / 64 + 16) << text(values);
            }
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Registry, HostileQueries, ::testing::ValuesIn(testing::rows()), testing::name_of_row);

}  // namespace
}  // namespace shadowbench::techniques

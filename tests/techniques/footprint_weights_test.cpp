// The weights of a lookup's footprint: every function counts by the part of its cell that the footprint covers, cut to
// the map, as the truth counts rays. Compared with sums over all cells, in double.
#include <gtest/gtest.h>

#include <cmath>

#include "techniques/built.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/tile_cache.h"
#include "techniques/deep_levels.h"
#include "techniques/store/cells.h"

namespace shadowbench::techniques {
namespace {

using nlohmann::json;
using rays::testing::directional;
using testing::build;
using testing::Built;

// The length in [low, high) of the part of [0, size) within width / 2 of `place`.
double covered(double low, double high, double place, double width, double size) {
    return std::max(std::min({high, place + 0.5 * width, size}) - std::max({low, place - 0.5 * width, 0.0}), 0.0);
}

// The mean of value(x, y) over cells `cell` map pixels wide, by area.
template <class Value>
double mean_over(const Query& q, double cell, double map_width, double map_height, const Value& value) {
    double sum = 0.0, area = 0.0;
    for (int y = 0; y * cell < map_height; ++y)
        for (int x = 0; x * cell < map_width; ++x) {
            const double a = covered(x * cell, (x + 1) * cell, q.x, q.width, map_width) *
                             covered(y * cell, (y + 1) * cell, q.y, q.width, map_height);
            if (a == 0.0) continue;
            sum += a * value(x, y);
            area += a;
        }
    return sum / area;
}

// The same for the cells of a map whose centres lie within width / 2, counted whole; at the very border only upper
// ones.
template <class Value>
double mean_of_centres(const Query& q, double cell, double map_width, double map_height, const Value& value) {
    double sum = 0.0, weights = 0.0;
    for (int y = 0; y * cell < map_height; ++y)
        for (int x = 0; x * cell < map_width; ++x) {
            const double dx = (x + 0.5) * cell - q.x, dy = (y + 0.5) * cell - q.y, reach = 0.5 * q.width;
            if (dx <= -reach || dx > reach || dy <= -reach || dy > reach) continue;
            const double w = covered(x * cell, (x + 1) * cell, 0, 1e9, map_width) *
                             covered(y * cell, (y + 1) * cell, 0, 1e9, map_height);
            sum += w * value(x, y);
            weights += w;
        }
    return sum / weights;
}

// Anywhere in the map and at its borders and corners; widths 0.3 to 9 and whole ones; depths among the scene's.
std::vector<Query> any_queries(int width, int height, int count) {
    std::vector<Query> queries;
    base::Random random(23);
    const auto place = [&](int size) {
        const double at = random.uniform(0, size);
        const std::uint64_t kind = random.below(6);
        return static_cast<float>(kind == 0   ? 0.3 * random.uniform()
                                  : kind == 1 ? size - 0.001 - 0.3 * random.uniform()
                                  : kind == 2 ? std::floor(at)
                                              : at);
    };
    for (int i = 0; i < count; ++i) {
        const float w = static_cast<float>(random.uniform(0.3, 9));
        queries.push_back({place(width), place(height), static_cast<float>(random.uniform(0.5, 1.6)),
                           random.below(4) == 0 ? std::ceil(w) : w});
    }
    return queries;
}

scene::RaySettings oblong(int width, int height, int samples) {
    scene::RaySettings settings = rays::testing::rays(width, samples);
    settings.resolution = {width, height};
    return settings;
}

scene::Scene coloured_scene() {
    scene::Scene scene = testing::hairy_scene(true);
    scene.objects[0].opacity = base::Vec3f(0.7f, 0.3f, 0.5f);
    return scene;
}

struct Answers {
    std::vector<float> values;
    std::size_t queries;
    float operator()(std::size_t query, int channel) const {
        return values[static_cast<std::size_t>(channel) * queries + query];
    }
};
Answers ask(const Map& map, const std::vector<Query>& queries) {
    Answers answers{std::vector<float>(queries.size() * static_cast<std::size_t>(map.channels())), queries.size()};
    map.lookup(queries, answers.values);
    return answers;
}

TEST(FootprintWeights, OfDeepMapsAreThePartsOfThePixelsAtEveryLevel) {
    constexpr int width = 21, height = 13;
    for (const bool coloured : {false, true})
        for (const char* mip : {"none", "nearest", "blend"})
            for (const char* search : {"binary", "linear", "cached"}) {
                const json parameters{{"mip", mip}, {"search", search}, {"tolerance", 0.01}};
                const Built b = build(find("deep", ""), coloured ? coloured_scene() : testing::hairy_scene(true),
                                      directional(), oblong(width, height, 4), parameters.dump().c_str());
                const auto stored = levels(*b.map);
                const std::vector<Query> queries = any_queries(width, height, 600);
                const Answers answers = ask(*b.map, queries);
                for (std::size_t i = 0; i < queries.size(); ++i)
                    for (int c = 0; c < b.map->channels(); ++c) {
                        const Query& q = queries[i];
                        const auto of_level = [&](int l) {
                            return mean_over(q, std::ldexp(1.0, l), width, height, [&](int x, int y) {
                                return curves::evaluate(testing::curve_of(stored[static_cast<std::size_t>(l)], x, y, c),
                                                        q.z);
                            });
                        };
                        const double l = std::string(mip) == "none" ? 0.0 : std::max(std::log2(q.width / 1.5), 0.0);
                        double expected = of_level(static_cast<int>(l));
                        if (std::string(mip) == "blend" && l > 0.0)
                            expected += (l - std::floor(l)) * (of_level(static_cast<int>(l) + 1) - expected);
                        ASSERT_NEAR(answers(i, c), expected, 2e-6)
                            << parameters << " at " << q.x << " " << q.y << " width " << q.width;
                    }
            }
}

// Lokovic and Veach 2000, section 3.4: f(i + 1/2 - x, j + 1/2 - y) with f a box.
TEST(FootprintWeights, OfThePapersKernelAreWholePixelsWithinTheFilterRadius) {
    constexpr int width = 21, height = 13;
    for (const char* mip : {"none", "nearest"}) {
        const json parameters{{"kernel", "pixels"}, {"mip", mip}, {"tolerance", 0.01}};
        const Built b = build(find("deep", ""), testing::hairy_scene(true), directional(), oblong(width, height, 4),
                              parameters.dump().c_str());
        std::vector<Query> queries = any_queries(width, height, 600);
        for (Query& q : queries) q.width = std::max(q.width, 2.1f);  // no corner without a centre
        const Answers answers = ask(*b.map, queries);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& q = queries[i];
            const int l = std::string(mip) == "none" ? 0 : static_cast<int>(std::log2(q.width / 1.5));
            const double expected = mean_of_centres(q, std::ldexp(1.0, l), width, height, [&](int x, int y) {
                return curves::evaluate(testing::curve_of(levels(*b.map)[static_cast<std::size_t>(l)], x, y, 0), q.z);
            });
            if (std::isnan(expected)) continue;  // all centres near it lie outside the map
            ASSERT_NEAR(answers(i, 0), expected, 2e-6) << mip << " " << q.x << " " << q.y << " width " << q.width;
        }
    }
    const Built b = build(find("deep", ""), testing::hairy_scene(true), directional(), oblong(width, height, 4),
                          R"({"kernel": "pixels", "tolerance": 0.01})");
    for (const Query& q : any_queries(width, height, 100))
        EXPECT_EQ(b.lookup(q.x, q.y, q.z, 1.0f),
                  curves::evaluate(
                      testing::curve_of(levels(*b.map)[0], static_cast<int>(q.x), static_cast<int>(q.y), 0), q.z))
            << "one pixel wide: the nearest";
}

TEST(FootprintWeights, OfTilesReadFromAFileAreThePartsOfThePixelsAtEveryLevel) {
    constexpr int width = 21, height = 13;
    for (const int channels : {1, 3}) {
        std::vector<DeepLevel> written;
        for (int l = 0; l < 6; ++l)
            written.push_back(testing::random_level((width + (1 << l) - 1) >> l, (height + (1 << l) - 1) >> l, channels,
                                                    40u + static_cast<unsigned>(l)));
        const testing::TestFile path;
        write_deep_file(path.path, written, 4, {});
        const DeepFile file(path.path);
        TileCache cache(file, 5);
        std::vector<Query> queries = any_queries(width, height, 600);
        for (std::size_t i = 0; i < queries.size(); i += 2) queries[i].width *= 7.0f;  // up to the level of one pixel
        Answers answers{std::vector<float>(queries.size() * static_cast<std::size_t>(channels)), queries.size()};
        lookup(cache, {.mip = Mip::nearest}, queries, {}, answers.values);
        std::vector<int> asked(6);
        for (std::size_t i = 0; i < queries.size(); ++i)
            for (int c = 0; c < channels; ++c) {
                const Query& q = queries[i];
                const int l = static_cast<int>(std::clamp(std::log2(q.width / 1.5), 0.0, 5.0));
                ++asked[static_cast<std::size_t>(l)];
                const double expected = mean_over(q, std::ldexp(1.0, l), width, height, [&](int x, int y) {
                    return curves::evaluate(testing::curve_of(written[static_cast<std::size_t>(l)], x, y, c), q.z);
                });
                ASSERT_NEAR(answers(i, c), expected, 2e-6) << "level " << l << " at " << q.x << " " << q.y;
            }
        for (const int count : asked) EXPECT_GT(count, 0);
    }
}

class FootprintWeightsOfTexels : public ::testing::TestWithParam<const char*> {};

TEST_P(FootprintWeightsOfTexels, AreThePartsOfTheTexels) {
    constexpr int width = 11, height = 7;
    for (const char* cells : {"sample", "centre"})
        for (const int samples : {1, 4, 6}) {
            json parameters{{"cells", cells}, {"filter", "footprint"}};
            const auto build_map = [&] {
                return build(find(GetParam(), ""), testing::hairy_scene(true), directional(),
                             oblong(width, height, samples), parameters.dump().c_str());
            };
            const Built b = build_map();
            parameters["filter"] = "point";
            const Built point = build_map();
            const auto& layout = b.rays.layout;
            const bool each = b.map->cells() == Cells::sample;
            const int nx = each ? layout.samples_x : 1, ny = each ? layout.samples_y : 1;
            const std::vector<Query> queries = any_queries(width, height, 300);
            const Answers answers = ask(*b.map, queries);
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const Query& q = queries[i];
                double sum = 0.0, area = 0.0;
                for (int y = 0; y < height * ny; ++y)
                    for (int x = 0; x < width * nx; ++x) {
                        const double a = covered(static_cast<double>(x) / nx, (x + 1.0) / nx, q.x, q.width, width) *
                                         covered(static_cast<double>(y) / ny, (y + 1.0) / ny, q.y, q.width, height);
                        if (a <= 0.0) continue;
                        sum += a * point.lookup(static_cast<float>((x + 0.5) / nx), static_cast<float>((y + 0.5) / ny),
                                                q.z);
                        area += a;
                    }
                ASSERT_NEAR(answers(i, 0), sum / area, 4e-6)
                    << cells << " " << samples << " at " << q.x << " " << q.y << " width " << q.width;
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Techniques, FootprintWeightsOfTexels,
                         ::testing::Values("avsm", "opacity", "fourier", "volume_deep"),
                         [](const auto& test) { return std::string(test.param); });

// Outside the map nothing is covered: a footprint that the map's edge cuts has its samples inside.
TEST(FootprintWeights, OfAKernelSpreadOverTheWidthStayInsideTheMap) {
    scene::Scene scene;  // all in shade
    scene.objects.push_back(rays::testing::quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}));
    const Built b =
        build(find("multi_depth", ""), scene, directional(), oblong(16, 16, 1), R"({"region": "query", "kernel": 4})");
    for (const Query& q : any_queries(16, 16, 200))
        ASSERT_EQ(b.lookup(q.x, q.y, 5.0f, q.width), 0.0f) << q.x << " " << q.y << " width " << q.width;
    scene::Scene half;  // the left half in shade
    half.objects.push_back(rays::testing::quad({-2, -2, 0}, {2, 0, 0}, {0, 4, 0}));
    const Built left = build(find("multi_depth", ""), half, directional(), oblong(16, 16, 1),
                             R"({"region": "query", "kernel": 4, "n": 1})");
    EXPECT_EQ(left.lookup(0.5f, 8.0f, 5.0f, 31.0f), 0.5f) << "of the whole map";
}

// Every footprint covers something, however narrow and wherever it is.
TEST(FootprintWeights, ANarrowFootprintIsTheCellThatItLiesIn) {
    const Stretch inside = stretch(3.25, 0.0, 8.0);
    EXPECT_EQ(inside.begin, 3);
    EXPECT_EQ(inside.end, 4);
    EXPECT_EQ(inside.weight(3), 1.0);
    const Stretch border = stretch(3.0, 1e-3, 8.0);
    EXPECT_EQ(border.begin, 2);
    EXPECT_EQ(border.end, 4);
    EXPECT_NEAR(border.weight(2) / border.weight(3), 1.0, 1e-9);
    const Stretch corner = stretch(0.0, 0.5, 8.0);
    EXPECT_EQ(corner.begin, 0);
    EXPECT_EQ(corner.end, 1);
    const Stretch all = stretch(3.0, std::numeric_limits<double>::infinity(), 4.5);
    EXPECT_EQ(all.begin, 0);
    EXPECT_EQ(all.end, 5);
    EXPECT_EQ(all.weight(2), 1.0);
    EXPECT_EQ(all.weight(4), 0.5) << "a pixel that the map's edge cuts";
}

}  // namespace
}  // namespace shadowbench::techniques

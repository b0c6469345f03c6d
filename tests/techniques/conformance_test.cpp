// What every row of the registry must do, whatever it stores.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/external/library.h"
#include "techniques/live_bytes.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using rays::testing::quad;
using testing::build;
using testing::Built;

class Conformance : public ::testing::TestWithParam<const Technique*> {
protected:
    const Technique& row() const { return *GetParam(); }
    const Promises& promised() const { return row().promises; }
    bool opaque_only() const { return row().promises.opaque_only; }
    // How far an answer behind everything may lie from the truth, where `through` is the truth.
    double allowed_behind(double through) const {
        return promised().approximate || through == 0.0 ? promised().leak + 1e-6 : 1e-6;
    }
    // Techniques that spread samples beyond a footprint are queried in the middle of wide walls.
    static scene::RaySettings small() { return rays::testing::rays(16, 4); }
};

scene::Scene wall(float opacity, int count = 1) {
    scene::Scene scene;
    for (int i = 0; i < count; ++i) scene.objects.push_back(quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, opacity));
    return scene;
}

// The reference function of one cell: the same rays, uncompressed.
curves::Curve reference(const Built& b, int x, int y, double linearisation) {
    const rays::MapLayout& layout = b.rays.layout;
    const Cells cells = b.map->cells();
    const int px = cells == Cells::sample ? x / layout.samples_x : x,
              py = cells == Cells::sample ? y / layout.samples_y : y;
    const rays::LightRays& tile = b.rays.tiles[(py / layout.tile_height) * layout.tiles_x() + px / layout.tile_width];
    std::size_t first = (static_cast<std::size_t>(py - tile.y0) * tile.width + (px - tile.x0)) * tile.samples;
    std::size_t count = tile.samples;
    if (cells == Cells::sample) first += (y % layout.samples_y) * layout.samples_x + x % layout.samples_x;
    if (cells == Cells::centre) first += (layout.samples_y / 2) * layout.samples_x + layout.samples_x / 2;
    if (cells != Cells::pixel) count = 1;
    curves::SweepScratch scratch;
    curves::Curve out;
    curves::visibility(tile, first, count, linearisation, scratch, out);
    return out;
}

template <class Visit>
void for_each_cell(const Built& b, const Visit& visit) {
    const rays::MapLayout& layout = b.rays.layout;
    const Cells cells = b.map->cells();
    if (cells == Cells::none) return;
    const int nx = cells == Cells::sample ? layout.samples_x : 1, ny = cells == Cells::sample ? layout.samples_y : 1;
    for (int y = 0; y < layout.height * ny; ++y)
        for (int x = 0; x < layout.width * nx; ++x) visit(x, y);
}

TEST_P(Conformance, AnEmptyPixelIsLitAtEveryDepth) {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {0.5, 0, 0}, {0, 2, 0}));  // the left quarter of the map
    const Built b = build(row(), scene, directional(), small());
    for (const float z : {0.0f, 0.5f, 1.0f, 1e6f}) EXPECT_EQ(b.lookup(12.5f, 8.5f, z), 1.0f) << z;
}

TEST_P(Conformance, AMapThatNoRayHitsIsLit) {
    scene::Scene scene;  // two walls left and right of what the light sees
    scene.objects.push_back(quad({-9, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    scene.objects.push_back(quad({9, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    const Built b = build(row(), scene, directional(), small());
    EXPECT_EQ(b.lookup(8.5f, 8.5f, 1e6f), 1.0f);
}

TEST_P(Conformance, AWallShadesOnlyWhatIsStrictlyBehindIt) {
    const Built b = build(row(), wall(1.0f), directional(), small());
    const float z = b.rays.tiles[0].z_front[0];
    const double dark = allowed_behind(0.0);
    if (!promised().early) {
        EXPECT_EQ(b.lookup(8.5f, 8.5f, 0.5f * z), 1.0f);
    }
    EXPECT_NEAR(b.lookup(8.5f, 8.5f, 100.0f), 0.0f, dark);
    if (!promised().localised || promised().approximate) return;
    if (!promised().early) {
        EXPECT_EQ(b.lookup(8.5f, 8.5f, z), 1.0f) << "the wall itself is lit";
    }
    EXPECT_NEAR(b.lookup(8.5f, 8.5f, std::nextafter(z, 2 * z)), 0.0f, dark);
}

TEST_P(Conformance, TwoWallsAtOneDepthBothCount) {
    const Built b = build(row(), wall(0.5f, 2), directional(), small());
    const float z = b.rays.tiles[0].z_front[0];
    if (!promised().early) {
        EXPECT_EQ(b.lookup(8.5f, 8.5f, promised().localised ? z : b.rays.layout.z_min), 1.0f);
    }
    const double through = opaque_only() ? 0.0 : 0.25;
    EXPECT_NEAR(b.lookup(8.5f, 8.5f, z * 1.01f), through, allowed_behind(through));
}

TEST_P(Conformance, AUniformSlabFollowsItsExponential) {
    scene::Scene scene;
    scene.objects.push_back(testing::slab(1.5f, 0.5, -0.5, 0.05));
    const Built b = build(row(), scene, directional(), small());
    const double front = to_light(b.rays.view, {0, 0, 0.5}).z;
    if (opaque_only()) {  // the medium counts as opaque from where it begins
        EXPECT_EQ(b.lookup(8.5f, 8.5f, static_cast<float>(front - 0.001)), 1.0f);
        EXPECT_EQ(b.lookup(8.5f, 8.5f, static_cast<float>(front + 0.001)), 0.0f);
        return;
    }
    if (!promised().localised || promised().approximate) {
        const double allowed = 1e-5 + (promised().approximate ? promised().leak : 0.0);
        if (!promised().early) {
            EXPECT_EQ(b.lookup(8.5f, 8.5f, b.rays.layout.z_min), 1.0f);
        }
        if (!promised().approximate) {
            EXPECT_NEAR(b.lookup(8.5f, 8.5f, b.rays.layout.z_max), std::exp(-1.5), allowed);
        }
        EXPECT_NEAR(b.lookup(8.5f, 8.5f, std::nextafter(b.rays.layout.z_max, 100.0f)), std::exp(-1.5), allowed);
        EXPECT_NEAR(b.lookup(8.5f, 8.5f, 100.0f), std::exp(-1.5), allowed);
        return;
    }
    const double bound = row().error_bound(b.values, b.rays.layout);
    const double allowed = (std::isfinite(bound) ? bound : 0.02) + 1e-5;
    for (double d = -0.1; d < 1.5; d += 0.07)
        EXPECT_NEAR(b.lookup(8.5f, 8.5f, static_cast<float>(front + d)), std::exp(-1.5 * std::clamp(d, 0.0, 1.0)),
                    allowed);
}

TEST_P(Conformance, StoredFunctionsKeepThePromises) {
    for (const bool media : {false, true}) {
        if (opaque_only() && media) continue;
        const Built b = build(row(), testing::hairy_scene(media, opaque_only() ? 1.0f : 0.5f), directional(), small());
        const double bound = row().error_bound(b.values, b.rays.layout);
        double worst = 0.0;
        int cells = 0, broken = 0;
        curves::Curve stored;
        std::vector<float> depths;
        for_each_cell(b, [&](int x, int y) {
            const curves::Curve exact = reference(b, x, y, 1e-5);
            depths.clear();
            for (const curves::Vertex& v : exact) depths.push_back(v.z);
            b.map->stored(x, y, 0, depths, stored);
            worst = std::max(worst, curves::distance(stored, exact, 0, 4).max);
            const curves::Vertex* before = nullptr;
            bool kept = true;
            for (const curves::Vertex& v : stored) {
                const bool rises = promised().monotone && before && v.value > before->value;
                const bool leaves = promised().unit_range && !(v.value >= 0.0f && v.value <= 1.0f);
                if ((rises || leaves) && kept && broken < 3)
                    ADD_FAILURE() << "cell (" << x << ", " << y << ") at depth " << v.z << ": " << v.value
                                  << (rises ? " rises above the value before" : " is not in [0, 1]");
                kept = kept && !rises && !leaves;
                before = &v;
            }
            broken += !kept;
            ++cells;
        });
        EXPECT_EQ(broken, 0) << "of " << cells << " functions rise or leave [0, 1]";
        EXPECT_LE(worst, bound + 1.1e-5);
    }
}

TEST_P(Conformance, TheOrderOfTilesChangesNothing) {
    scene::RaySettings settings = rays::testing::rays(80, 4);
    const Built a = build(row(), testing::hairy_scene(true), directional(), settings);
    ASSERT_GT(a.rays.tiles.size(), 1u);
    const auto again = row().create(a.values);
    again->begin({a.rays.layout, a.rays.view, a.tracer.get(), 0});
    for (auto tile = a.rays.tiles.rbegin(); tile != a.rays.tiles.rend(); ++tile) again->add(*tile);
    again->finish();
    EXPECT_EQ(a.map->bytes(), again->bytes());
    EXPECT_EQ(a.map->nodes().total, again->nodes().total);
    EXPECT_EQ(a.map->nodes().histogram, again->nodes().histogram);
    std::vector<Query> queries;
    base::Random random(1);
    for (int i = 0; i < 500; ++i)
        queries.push_back({static_cast<float>(random.uniform(0, 80)), static_cast<float>(random.uniform(0, 80)),
                           static_cast<float>(random.uniform(0, 2)), static_cast<float>(random.uniform(0.1, 3))});
    std::vector<float> one(queries.size()), two(queries.size());
    a.map->lookup(queries, one);
    again->lookup(queries, two);
    EXPECT_EQ(one, two);
    // Nor does an answer depend on the other queries of the batch.
    for (std::size_t i = 0; i < queries.size(); i += 7) {
        float alone;
        a.map->lookup({&queries[i], 1}, {&alone, 1});
        EXPECT_EQ(alone, one[i]);
    }
    for (const float v : one) {
        EXPECT_GE(v, 0.0f);
        EXPECT_LE(v, 1.0f);
    }
}

TEST_P(Conformance, OutsideTheMapIsLit) {
    const Built b = build(row(), wall(1.0f), directional(), small());
    for (const auto& [x, y] : {std::pair{-0.5f, 8.0f}, {16.5f, 8.0f}, {8.0f, -1e9f}, {8.0f, 1e30f}})
        EXPECT_EQ(b.lookup(x, y, 100.0f), 1.0f) << x << " " << y;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(b.lookup(nan, 8.0f, 100.0f), 1.0f) << "a position that is NaN is outside";
}

TEST_P(Conformance, BytesAreWhatTheMapHolds) {
    const Built b = build(row(), testing::hairy_scene(false), directional(), rays::testing::rays(64, 4));
    const std::size_t before = testing::live_bytes();
    auto map = row().create(b.values);
    map->begin({b.rays.layout, b.rays.view, b.tracer.get(), 0});
    for (const auto& tile : b.rays.tiles) map->add(tile);
    map->finish();
    const std::size_t held = testing::live_bytes() - before;
    EXPECT_NEAR(static_cast<double>(map->bytes()), static_cast<double>(held), 4096 + 0.01 * static_cast<double>(held));
    EXPECT_GE(map->working_bytes(), map->bytes());
}

TEST_P(Conformance, TouchedLinesLieInTheMap) {
    const Built b = build(row(), testing::hairy_scene(false), directional(), rays::testing::rays(32, 4));
    std::vector<const void*> lines;
    std::size_t found = 0, sum = 0;
    for (int i = 0; i < 200; ++i) {
        base::Random random(i);
        lines.clear();
        b.map->touched(
            {static_cast<float>(random.uniform(0, 32)), static_cast<float>(random.uniform(0, 32)), 1.0f, 1.0f}, lines);
        // Reading these addresses must be allowed, which the address sanitizer checks. A line may begin before the
        // memory that it holds a part of.
        for (const void* line : lines) sum += *static_cast<const volatile unsigned char*>(line);
        found += lines.size();
    }
    EXPECT_LE(sum, 255 * found);
    EXPECT_EQ(found > 0, b.map->cells() != Cells::none);
}

TEST_P(Conformance, TheRowDescribesItself) {
    EXPECT_NE(row().id[0], '\0');
    EXPECT_NE(row().title[0], '\0');
    EXPECT_NE(row().paper[0], '\0');
    EXPECT_GE(row().version, 1);
    if (row().library.file.empty()) {
        EXPECT_EQ(&find(row().id, "/x"), GetParam());
    }
    for (const Parameter& p : row().parameters) EXPECT_GT(std::string(p.doc).size(), 10u) << p.name;
}

// A misspelt setting would set nothing, and the tests that rely on it would test something else.
TEST_P(Conformance, TheTraitsSetDeclaredParameters) {
    const ParameterValues defaults = read_parameters(row().parameters, nlohmann::json::object(), "");
    const Traits& traits = row().traits;
    for (const auto* settings : {&traits.pointwise, &traits.order_free, &traits.whole_pixel})
        EXPECT_NO_THROW(read_parameters(row().parameters, to_json(with(defaults, *settings)), "")) << row().id;
    for (const char* bias : traits.biases) EXPECT_EQ(defaults.values.count(bias), 1u) << bias;
}

TEST_P(Conformance, ARowThatTracesStoresNothing) {
    const Built b = build(row(), wall(1.0f), directional(), small());
    EXPECT_EQ(b.map->cells() == Cells::none, row().traits.traces);
    if (!row().traits.traces) return;
    const auto map = row().create(b.values);
    EXPECT_THROW(map->begin({b.rays.layout, b.rays.view, nullptr, 0}), base::Error);
}

INSTANTIATE_TEST_SUITE_P(Registry, Conformance, ::testing::ValuesIn([] {
                             std::vector<const Technique*> rows;
                             for (const Technique& row : all()) rows.push_back(&row);
                             return rows;
                         }()),
                         [](const auto& test) { return std::string(test.param->id); });

// A technique from outside that keeps its promises: the way over the border adds and loses nothing.
INSTANTIATE_TEST_SUITE_P(Outside, Conformance, ::testing::ValuesIn([] {
                             static const OpenLibrary library = open_library(SHADOWBENCH_STAIRS);
                             static const Technique row = make_row(library.techniques.at(0), library.library);
                             return std::vector<const Technique*>{&row};
                         }()),
                         [](const auto& test) { return std::string(test.param->id); });

}  // namespace
}  // namespace shadowbench::techniques

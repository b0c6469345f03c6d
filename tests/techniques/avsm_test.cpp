#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "techniques/built.h"
#include "techniques/live_bytes.h"
#include "techniques/one_ray.h"

namespace shadowbench::techniques {
namespace {

using testing::Segment;

double mean_curve_error(const testing::Built& b) {
    double sum = 0.0;
    curves::SweepScratch scratch;
    curves::Curve exact, stored;
    rays::testing::for_each_ray(b.rays, [&](const rays::LightRays& tile, std::size_t ray, int i, int j) {
        curves::visibility(tile, ray, 1, 1e-5, scratch, exact);
        b.map->stored(i, j, 0, {}, stored);
        sum += curves::distance(stored, exact, 0, 4).max;
    });
    return sum;
}

TEST(Avsm, MoreNodesLeaveLessError) {
    for (const bool media : {false, true}) {
        double before = std::numeric_limits<double>::infinity();
        for (const int nodes : {2, 4, 8, 16, 64}) {
            const auto b = testing::build(
                find("avsm", ""), testing::hairy_scene(media), rays::testing::directional(), rays::testing::rays(24, 4),
                ("{\"cells\": \"sample\", \"nodes\": " + std::to_string(nodes) + "}").c_str());
            const double error = mean_curve_error(b);
            if (nodes <= 16)
                EXPECT_LT(error, before) << nodes;
            else
                EXPECT_LE(error, before) << "everything fits, and what is left is that media are not linear";
            before = error;
        }
    }
}

// The same rays in several orders of insertion; `submission` is filled back to front.
struct Orders {
    testing::Built sorted;
    Orders(int nodes, const char* sampling) : nodes_(nodes), sampling_(sampling) {
        sorted = testing::build(find("avsm", ""), testing::hairy_scene(true), rays::testing::directional(),
                                rays::testing::rays(24, 4), parameters("sorted", 1).c_str());
    }
    std::unique_ptr<Map> map(const char* order, int seed, bool reversed) const {
        const Technique& row = find("avsm", "");
        auto result = row.create(
            read_parameters(row.parameters, nlohmann::json::parse(parameters(order, seed)), "/techniques/0"));
        result->begin({sorted.rays.layout, sorted.rays.view, nullptr, 0});
        for (rays::LightRays tile : sorted.rays.tiles) {
            if (result->needs().submission) fill(tile, reversed);
            result->add(tile);
        }
        result->finish();
        return result;
    }
    // Largest difference to the sorted map, over depths and texels.
    double difference(const Map& other) const {
        double largest = 0.0;
        std::vector<Query> queries;
        for (float y = 0.25f; y < 24.0f; y += 0.5f)
            for (float x = 0.25f; x < 24.0f; x += 0.5f)
                for (float z = 0.0f; z < 2.5f; z += 0.05f) queries.push_back({x, y, z, 0.1f});
        std::vector<float> a(queries.size()), b(queries.size());
        sorted.map->lookup(queries, a);
        other.lookup(queries, b);
        for (std::size_t i = 0; i < a.size(); ++i) largest = std::max<double>(largest, std::abs(a[i] - b[i]));
        return largest;
    }

private:
    std::string parameters(const char* order, int seed) const {
        return "{\"cells\": \"sample\", \"nodes\": " + std::to_string(nodes_) + ", \"order\": \"" + order +
               "\", \"sampling\": \"" + sampling_ + "\", \"seed\": " + std::to_string(seed) + "}";
    }
    static void fill(rays::LightRays& tile, bool reversed) {
        tile.submission.resize(tile.segments());
        for (std::size_t r = 0; r < tile.rays(); ++r)
            for (std::uint32_t s = tile.begin[r]; s < tile.begin[r + 1]; ++s)
                tile.submission[s] = reversed ? tile.begin[r] + tile.begin[r + 1] - 1 - s : s;
    }

    int nodes_;
    const char* sampling_;
};

TEST(Avsm, TheOrderChangesNothingWhileAllNodesFit) {
    const Orders orders(64, "exponential");
    EXPECT_LE(orders.difference(*orders.map("captured", 1, true)), 1e-5);
    for (const int seed : {1, 2, 3}) EXPECT_LE(orders.difference(*orders.map("shuffled", seed, false)), 1e-5);
}

TEST(Avsm, TheOrderChangesResultsWhenNodesAreFew) {
    for (const char* sampling : {"linear", "exponential"}) {
        const Orders orders(4, sampling);
        const auto captured = orders.map("captured", 1, true), shuffled = orders.map("shuffled", 1, false);
        EXPECT_GT(orders.difference(*captured), 0.01);
        EXPECT_GT(orders.difference(*shuffled), 0.01);
        const auto again = orders.map("shuffled", 1, false), other = orders.map("shuffled", 2, false);
        EXPECT_EQ(orders.difference(*again), orders.difference(*shuffled)) << "one seed, one order";
        EXPECT_NE(orders.difference(*other), orders.difference(*shuffled));
    }
}

TEST(Avsm, SegmentsSubmittedInOrderOfDepthGiveTheSortedMap) {
    const Orders orders(4, "linear");
    EXPECT_EQ(orders.difference(*orders.map("captured", 1, false)), 0.0);
}

TEST(Avsm, SubmissionOrderIsAskedForAndMissed) {
    const Technique& row = find("avsm", "");
    const auto make = [&](const char* parameters) {
        return row.create(read_parameters(row.parameters, nlohmann::json::parse(parameters), ""));
    };
    EXPECT_FALSE(make("{}")->needs().submission);
    EXPECT_FALSE(make(R"({"order": "shuffled"})")->needs().submission);
    EXPECT_TRUE(make(R"({"order": "captured"})")->needs().submission);
    try {
        const testing::HandRays given{1, 1, 1, {{{1, 2, 0.5f}}}};
        rays::LightRays rays = light_rays(given);
        rays.submission.clear();
        testing::make_map(row, read_parameters(row.parameters, {{"order", "captured"}}, ""), rays, layout_of(given));
        FAIL() << "rays without an order were accepted";
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::internal);
    }
}

TEST(Avsm, BuildingInAnyOrderNeedsNoMemoryButTheMap) {
    const Orders orders(8, "linear");
    for (const char* order : {"sorted", "captured", "shuffled"}) {
        const Technique& row = find("avsm", "");
        const ParameterValues values = read_parameters(row.parameters, {{"order", order}, {"cells", "sample"}}, "");
        std::vector<rays::LightRays> tiles = orders.sorted.rays.tiles;
        for (rays::LightRays& tile : tiles)
            for (std::uint32_t s = 0; s < tile.segments(); ++s) tile.submission.push_back(s);
        const std::size_t before = testing::live_bytes();
        testing::forget_peak();
        const auto map = row.create(values);
        map->begin({orders.sorted.rays.layout, orders.sorted.rays.view, nullptr, 0});
        for (const rays::LightRays& tile : tiles) map->add(tile);
        map->finish();
        EXPECT_LE(testing::peak_bytes() - before, map->bytes() + 1024) << order;
        EXPECT_EQ(map->working_bytes(), map->bytes());
    }
}

TEST(Avsm, ExponentialSamplingFollowsAMediumWithItsEndsAlone) {
    const std::vector<Segment> slab = {{2, 8, 0.05f}};
    const testing::OneRay exponential("avsm", R"({"nodes": 4, "sampling": "exponential"})", slab, 0, 10);
    const testing::OneRay linear("avsm", R"({"nodes": 4})", slab, 0, 10);
    for (float z = 0.0f; z < 12.0f; z += 0.1f) EXPECT_NEAR(exponential(z), exponential.exact(z), 1e-6) << z;
    EXPECT_NEAR(linear(5), (1 + 0.05) / 2, 1e-6);
}

TEST(Avsm, ExponentialSamplingTakesATransmittanceOfZero) {
    for (const std::vector<Segment>& segments : {std::vector<Segment>{{2, 8, 0.0f}},
                                                 {{3, 3, 0.0f}},
                                                 {{2, 8, 0.5f}, {5, 6, 0.0f}},
                                                 {{2, 8, 1e-38f}, {8, 8, 0.0f}},
                                                 {{1, 2, 0.5f}, {2.5f, 2.6f, 0.5f}, {3, 3, 0.0f}, {4, 5, 0.5f}}})
        for (const char* parameters :
             {R"({"sampling": "exponential"})", R"({"nodes": 2, "sampling": "exponential"})"}) {
            const testing::OneRay ray("avsm", parameters, segments, 0, 10);
            float before = 1.0f;
            for (float z = 0.0f; z < 12.0f; z += 0.01f) {
                const float v = ray(z);
                ASSERT_TRUE(v >= 0.0f && v <= before) << z << ": " << v << " after " << before;
                before = v;
            }
            EXPECT_EQ(before, 0.0f) << "black behind";
            if (parameters[2] == 's') {
                for (float z = 0.0f; z < 12.0f; z += 0.1f) EXPECT_NEAR(ray(z), ray.exact(z), 1e-5) << z;
            }
        }
}

TEST(Avsm, AnExponentialFunctionIsStoredAsLookupsAnswer) {
    for (const char* parameters : {R"({"sampling": "exponential", "nodes": 5})", R"({"nodes": 5})"}) {
        const testing::OneRay ray("avsm", parameters, testing::random_segments(3, 12, 1, 9), 0, 10);
        std::vector<float> depths;
        for (float z = -0.5f; z < 12.0f; z += 0.25f) depths.push_back(z);
        curves::Curve stored;
        ray.map->stored(0, 0, 0, depths, stored);
        EXPECT_TRUE(curves::is_visibility(stored));
        for (const float z : depths) EXPECT_EQ(curves::evaluate(stored, z), ray(z)) << z;
    }
}

TEST(Avsm, BytesAreEightANodeWhateverTheScene) {
    for (const int nodes : {2, 4, 8, 12, 64}) {
        const auto b = testing::build(find("avsm", ""), testing::hairy_scene(false), rays::testing::directional(),
                                      rays::testing::rays(16, 4),
                                      ("{\"cells\": \"sample\", \"nodes\": " + std::to_string(nodes) + "}").c_str());
        EXPECT_EQ(b.map->bytes(), 16u * 16 * 4 * nodes * 8) << "table 1 counts 8 bytes a node";
    }
}

}  // namespace
}  // namespace shadowbench::techniques

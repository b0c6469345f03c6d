#include "bench/lookup_timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bench/fake_map.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

Maps fake_maps(int lines) {
    Maps maps;
    maps.parts.push_back(std::make_unique<FakeMap>(FakeAnswers{.function = {}, .lines = lines}));
    return maps;
}

std::vector<Query> some_queries(int count) {
    std::vector<Query> queries;
    for (int i = 0; i < count; ++i) queries.push_back({static_cast<float>(i), 0.0f, 0.0f, 1.0f});
    return queries;
}

TEST(ChooseRuns, takes_everything_when_it_may) {
    const std::vector<std::size_t> all = choose_runs(200, 1000);
    ASSERT_EQ(all.size(), 200u);
    for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(all[i], i);
}

TEST(ChooseRuns, spreads_runs_of_neighbours_over_the_whole) {
    const std::vector<std::size_t> chosen = choose_runs(64 * 100, 256);
    ASSERT_EQ(chosen.size(), 256u);
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
    EXPECT_EQ(std::set<std::size_t>(chosen.begin(), chosen.end()).size(), 256u) << "no query twice";
    EXPECT_EQ(chosen[63], 63u);
    EXPECT_EQ(chosen[64], 64u * 25);
    EXPECT_GT(chosen.back(), 64u * 74);
}

TEST(LookupPlan, looks_up_the_same_queries_in_both_orders) {
    const Maps maps = fake_maps(2);
    const LookupPlan plan = plan_lookups(maps, some_queries(1000), 640, 3);
    ASSERT_EQ(plan.image.queries.size(), 640u);
    const auto places = [](const LookupOrder& order) {
        std::vector<float> x;
        for (const Query& q : order.queries) x.push_back(q.x);
        return x;
    };
    const std::vector<float> image = places(plan.image), random = places(plan.random);
    EXPECT_TRUE(std::is_sorted(image.begin(), image.end()));
    ASSERT_EQ(random.size() % 640, 0u);
    std::set<std::vector<float>> orders{image};
    for (auto first = random.begin(); first != random.end(); first += 640) {
        std::vector<float> order(first, first + 640);
        EXPECT_TRUE(orders.insert(order).second) << "a processor would learn it";
        std::sort(order.begin(), order.end());
        EXPECT_EQ(order, image);
    }
    EXPECT_EQ(plan.image.lines.size(), 2 * plan.image.covered);
    EXPECT_EQ(plan.image.covered, 640u);
}

TEST(LookupPlan, looks_up_more_in_a_row_than_a_processor_learns) {
    EXPECT_EQ(random_orders(65536, 5e-9), 1u);
    EXPECT_EQ(random_orders(1'000'000, 5e-9), 1u);
    EXPECT_EQ(random_orders(1000, 5e-9), 66u);
    EXPECT_EQ(random_orders(1, 5e-9), 65536u);
    EXPECT_EQ(random_orders(1000, 1e-6), 10u) << "10 ms";
    EXPECT_EQ(random_orders(1000, 1e-3), 1u) << "at least one";
    EXPECT_EQ(random_orders(1000, 0.0), 66u) << "faster than the clock";
}

TEST(LookupPlan, shuffles_footprints_with_their_queries) {
    const Maps maps = fake_maps(2);
    const std::vector<Query> queries = some_queries(500);
    std::vector<techniques::Footprint> footprints;
    for (const Query& q : queries) footprints.push_back({q.x + 1.0f, 0, 0, 1});
    const LookupPlan plan = plan_lookups(maps, {queries, footprints}, 500, 3);
    for (const LookupOrder* order : {&plan.image, &plan.random}) {
        ASSERT_GE(order->footprints.size(), 500u);
        ASSERT_EQ(order->footprints.size(), order->queries.size());
        for (std::size_t i = 0; i < order->queries.size(); ++i)
            EXPECT_EQ(order->footprints[i].ux, order->queries[i].x + 1.0f);
    }
}

TEST(LookupPlan, keeps_one_time_and_one_floor_a_repetition) {
    const Maps maps = fake_maps(3);
    LookupPlan plan = plan_lookups(maps, some_queries(100), 100, 3);
    for (int r = 0; r < 4; ++r) time_repetition(maps, plan, r % 2 == 1);
    EXPECT_EQ(plan.image.answers, std::vector<float>(100, 1.0f));
    EXPECT_EQ(plan.random.answers, std::vector<float>(plan.random.queries.size(), 1.0f));
    const results::LookupTimes times = summarise(plan.random);
    EXPECT_EQ(times.ns.raw.size(), 4u);
    ASSERT_TRUE(times.floor && times.ratio);
    EXPECT_EQ(times.floor->raw.size(), 4u);
    EXPECT_DOUBLE_EQ(times.ratio->raw[2], times.ns.raw[2] / times.floor->raw[2]);
}

TEST(LookupPlan, warms_up_at_least_twice_whichever_goes_first) {
    const Maps maps = fake_maps(3);
    const auto& map = static_cast<const FakeMap&>(*maps.parts[0]);
    LookupPlan plan = plan_lookups(maps, some_queries(100), 100, 3);
    plan.warm = true;
    for (const bool floor_first : {false, true}) {
        const int before = map.lookups();
        time_repetition(maps, plan, floor_first);
        EXPECT_GE(map.lookups() - before, 2 + plan.image.rounds + 2 + plan.random.rounds);
    }
}

// A search times only the order that it ranks by.
TEST(LookupPlan, times_one_order_without_a_floor) {
    const Maps maps = fake_maps(3);
    LookupPlan plan = plan_lookups(maps, some_queries(100), 100, 3, false);
    for (int r = 0; r < 3; ++r) time_order(maps, plan, plan.random, false);
    EXPECT_EQ(plan.random.answers, std::vector<float>(plan.random.queries.size(), 1.0f));
    EXPECT_EQ(plan.random.ns.size(), 3u);
    EXPECT_TRUE(plan.random.floor_ns.empty());
    EXPECT_TRUE(plan.image.ns.empty());
}

TEST(LookupPlan, has_no_floor_for_a_technique_without_a_map) {
    const Maps maps = fake_maps(0);
    LookupPlan plan = plan_lookups(maps, some_queries(100), 100, 3);
    time_repetition(maps, plan, true);
    const results::LookupTimes times = summarise(plan.image);
    EXPECT_EQ(times.ns.raw.size(), 1u);
    EXPECT_FALSE(times.floor);
    EXPECT_FALSE(times.ratio);
}

}  // namespace
}  // namespace shadowbench::bench

#include "results/fronts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "results/settled.h"

namespace shadowbench::results {
namespace {

using metrics::OnFront;

// A cell whose values differ between seeds, and whose times between repetitions, by about this share.
struct Made {
    double ns, bytes, error;
    double noise = 0.001;
    std::size_t repetitions = 9;
};

Cell cell(const Made& made, int number) {
    const auto stray = [&](int i) { return 1.0 + made.noise * std::sin(1.0 + 7.0 * number + 3.0 * i); };
    Cell result;
    result.bytes = static_cast<std::size_t>(made.bytes);
    result.lookup = LookupErrors{};
    result.lookup->norms.rms = made.error;
    result.lookup->interval = {made.error, made.error, true};
    for (int s = 0; s < 4; ++s) {
        result.over_seeds.push_back({{}, static_cast<std::size_t>(made.bytes * stray(s))});
        result.over_seeds.back().lookup.rms = made.error * stray(s + 10);
    }
    std::vector<double> raw, floor;
    for (std::size_t r = 0; r < made.repetitions; ++r) {
        raw.push_back(made.ns * stray(static_cast<int>(r) + 20));
        floor.push_back(1.0);
    }
    result.times = CellTimes{};
    result.times->random_order.ns = summarise(raw);
    result.times->random_order.floor = summarise(floor);
    return result;
}

LightResult light_of(const std::vector<Made>& made) {
    LightResult light;
    for (std::size_t i = 0; i < made.size(); ++i) light.cells.push_back(cell(made[i], static_cast<int>(i)));
    return light;
}

std::vector<OnFront> times(const LightResult& light) {
    std::vector<OnFront> marks;
    for (const Cell& cell : light.cells) marks.push_back(cell.times->on_front);
    return marks;
}

std::vector<OnFront> bytes(const LightResult& light) {
    std::vector<OnFront> marks;
    for (const Cell& cell : light.cells) marks.push_back(cell.on_bytes_front);
    return marks;
}

constexpr OnFront no = OnFront::no, perhaps = OnFront::perhaps, certainly = OnFront::certainly;
const std::vector<Made> apart{{5, 10000, 0.3}, {10, 40000, 0.1}, {20, 30000, 0.2}, {30, 5000, 0.05}};

TEST(MarkFronts, marks_cells_that_no_other_cell_beats) {
    LightResult light = light_of(apart);
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, certainly, no, certainly}));
    EXPECT_EQ(bytes(light), (std::vector{no, no, no, certainly})) << "the last is smaller and more accurate than all";
}

TEST(MarkFronts, does_not_count_failed_cells) {
    LightResult light = light_of({{5, 100, 0.3}, {1, 1, 0.01}});
    light.cells[1].status = CellStatus::failed;
    light.cells[1].times.reset();
    mark_fronts(light);
    EXPECT_EQ(light.cells[0].times->on_front, certainly);
    EXPECT_EQ(bytes(light), (std::vector{certainly, no}));
}

TEST(MarkFronts, calls_what_the_noise_of_the_rays_hides_perhaps) {
    LightResult light = light_of({{5, 10000, 0.1, 0.05}, {10, 9000, 0.101, 0.05}});
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, perhaps})) << "faster, and perhaps more accurate";
    // Sizes are far apart, errors are not: the smaller one stays, the larger is perhaps more accurate.
    light = light_of({{5, 100000, 0.1, 0.02}, {10, 50000, 0.1, 0.02}});
    mark_fronts(light);
    EXPECT_EQ(bytes(light), (std::vector{perhaps, certainly}));
}

TEST(MarkFronts, keeps_both_of_two_equal_cells) {
    LightResult light = light_of({{5, 10000, 0.1}, {5, 10000, 0.1}});
    light.cells[1] = light.cells[0];
    mark_fronts(light);
    EXPECT_EQ(bytes(light), (std::vector{certainly, certainly}));
    EXPECT_EQ(times(light), (std::vector{perhaps, perhaps})) << "no two times are certainly equal";
    light.cells[0].lookup->truth_sd = light.cells[1].lookup->truth_sd = 1.0;
    mark_fronts(light);
    EXPECT_EQ(bytes(light), (std::vector{certainly, certainly})) << "a tie, whatever the truth";
}

TEST(MarkFronts, counts_the_uncertainty_of_the_truth) {
    LightResult light = light_of(apart);
    for (Cell& cell : light.cells) cell.lookup->truth_sd = 0.1;
    mark_fronts(light);
    EXPECT_EQ(bytes(light), (std::vector{perhaps, perhaps, perhaps, certainly}))
        << "the last is certainly the smallest";
}

TEST(MarkFronts, says_nothing_of_other_rays_that_were_not_measured) {
    LightResult light = light_of(apart);
    for (Cell& cell : light.cells) {
        cell.over_seeds.clear();
        cell.lookup->interval->covers_rays = false;
    }
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, perhaps, perhaps, perhaps}))
        << "the first is certainly the fastest";
    EXPECT_EQ(bytes(light), std::vector(4, perhaps));
    // Rays that are not random are the only ones.
    for (Cell& cell : light.cells) cell.lookup->interval->covers_rays = true;
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, certainly, no, certainly}));
    EXPECT_EQ(bytes(light), (std::vector{no, no, no, certainly}));
}

TEST(MarkFronts, does_not_rely_on_times_of_an_unsettled_machine) {
    LightResult light = light_of(apart);
    std::vector<double> floor{1, 2, 1, 2, 1, 2, 1, 2, 1};
    light.cells[0].times->random_order.floor = summarise(floor);
    ASSERT_FALSE(settling(light).settled());
    mark_fronts(light);
    EXPECT_EQ(times(light), std::vector(4, perhaps));
    EXPECT_EQ(bytes(light), (std::vector{no, no, no, certainly}));
}

TEST(MarkFronts, does_not_rely_on_few_repetitions) {
    LightResult light = light_of({{5, 1, 0.3, 0.001, 4}, {10, 1, 0.1, 0.001, 4}});
    mark_fronts(light);
    EXPECT_EQ(times(light), std::vector(2, perhaps)) << "no floor says that the machine was quiet";
    light = light_of({{5, 10, 0.3}, {10, 10, 0.3}, {20, 10, 0.1}});
    light.cells[1].times->random_order.ns = summarise({10, 10, 10, 10});
    light.cells[1].lookup->norms.rms = 0.4;
    for (SeedErrors& seed : light.cells[1].over_seeds) seed.lookup.rms *= 4.0 / 3.0;
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, perhaps, certainly}))
        << "less accurate than the others, whether faster or not";
}

// One process cannot measure a ratio of two times better than to process_luck.
TEST(MarkFronts, calls_times_equal_that_the_luck_of_a_process_may_part) {
    LightResult light = light_of({{100, 1, 0.2}, {103, 1, 0.3}});
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, perhaps}));
    light = light_of({{100, 1, 0.2}, {108, 1, 0.3}});
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, no}));
}

// The pace of a machine changes all cells of a repetition alike, and cancels.
TEST(MarkFronts, compares_the_times_of_the_same_repetition) {
    LightResult light = light_of({{100, 1, 0.2}, {120, 1, 0.3}});
    for (Cell& cell : light.cells) {
        std::vector<double> raw = cell.times->random_order.ns.raw;
        for (std::size_t r = 0; r < raw.size(); ++r) raw[r] *= 1.0 + static_cast<double>(r) / 4.0;
        cell.times->random_order.ns = summarise(raw);
    }
    mark_fronts(light);
    EXPECT_EQ(times(light), (std::vector{certainly, no}));
}

}  // namespace
}  // namespace shadowbench::results

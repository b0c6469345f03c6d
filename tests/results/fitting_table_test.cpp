// The table that fits a terminal, and the words about what it means.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "results/fronts.h"
#include "results/report.h"
#include "results/result.h"

namespace shadowbench::results {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct Made {
    const char* technique;
    const char* parameters;
    double ns, bytes, error;
    double noise = 0.001;  // between seeds, and between repetitions
};

Cell cell(const Made& made, int number) {
    const auto stray = [&](int i) { return 1.0 + made.noise * std::sin(1.0 + 7.0 * number + 3.0 * i); };
    Cell cell;
    cell.technique = made.technique;
    cell.parameters = made.parameters;
    cell.bytes = static_cast<std::size_t>(made.bytes);
    cell.lookup = LookupErrors{};
    cell.lookup->norms.rms = made.error;
    cell.lookup->interval = {made.error * 0.99, made.error * 1.01, true};
    std::vector<double> raw, floor;
    for (int i = 0; i < 9; ++i) {
        raw.push_back(made.ns * stray(i + 20));
        floor.push_back(1.0);
    }
    for (int s = 0; s < 4; ++s) {
        cell.over_seeds.push_back({{}, cell.bytes});
        cell.over_seeds.back().lookup.rms = made.error * stray(s + 10);
    }
    cell.times = CellTimes{};
    cell.times->random_order.ns = summarise(raw);
    cell.times->random_order.floor = cell.times->random_order.ratio = summarise(floor);
    return cell;
}

Result result_of(const std::vector<Made>& made, int lights = 1) {
    LightResult light;
    light.segments = 1;
    light.rays = 1;
    for (std::size_t i = 0; i < made.size(); ++i) light.cells.push_back(cell(made[i], static_cast<int>(i)));
    mark_fronts(light);
    Result result;
    result.name = "small";
    result.purpose = "a purpose of more words than a line of a narrow terminal has room for, and then some more";
    result.variants = {{{}, std::vector<LightResult>(static_cast<std::size_t>(lights), light)}};
    for (int i = 0; i < lights; ++i) result.variants[0].lights[i].name = std::to_string(i);
    return result;
}

const std::vector<Made> some{{"shadow_map", "", 2.5, 1e6, 0.25},
                             {"deep", "tolerance=0.02 kernel=tent mip=blend compression=published", 53.5, 6e5, 0.04},
                             {"uncompressed", "", 734.0, 2e6, 0.1}};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

// The line of the table that begins with this, without what is beside it.
std::string line_with(const std::string& text, const std::string& start) {
    for (const std::string& line : lines_of(text))
        if (line.rfind("  " + start, 0) == 0) return line;
    return "";
}

TEST(FittingTable, fits_every_width) {
    for (const std::size_t width : {60u, 70u, 80u, 90u, 100u, 110u, 120u, 200u})
        for (const std::string& line : lines_of(to_fitting_table(result_of(some), {width, false})))
            EXPECT_LE(line.size(), width) << width << ": " << line;
    EXPECT_EQ(to_fitting_table(result_of(some), {1, false}), to_fitting_table(result_of(some), {60, false}));
}

TEST(FittingTable, leaves_out_columns_that_have_no_room) {
    const auto header = [](std::size_t width) {
        return line_with(to_fitting_table(result_of(some), {width, false}), "technique");
    };
    const auto squeezed = [](const std::string& line) {
        std::istringstream words(line);
        std::string all;
        for (std::string word; words >> word;) all += (all.empty() ? "" : " ") + word;
        return all;
    };
    EXPECT_EQ(squeezed(header(120)), "technique bytes lookup ns 95 % x floor error 95 % front verdict");
    EXPECT_EQ(squeezed(header(95)), "technique bytes lookup ns 95 % x floor error front verdict");
    EXPECT_EQ(squeezed(header(85)), "technique bytes lookup ns 95 % error front verdict");
    EXPECT_EQ(squeezed(header(60)), "technique bytes lookup ns error front verdict");
}

// Otherwise it explains what the reader looks for in vain.
TEST(FittingTable, explains_the_columns_that_it_shows) {
    const auto legend = [](std::size_t width) {
        const std::string text = to_fitting_table(result_of(some), {width, false});
        std::string words;
        for (const std::string& line : lines_of(text.substr(text.find("lookup ns: "))))
            words += line.substr(line.find_first_not_of(' ')) + " ";
        return words;
    };
    EXPECT_THAT(legend(120), HasSubstr("in random order, with its 95 % interval. x floor: its ratio"));
    EXPECT_THAT(legend(120), HasSubstr("against the truth, with the 95 % interval expected"));
    EXPECT_THAT(legend(95), HasSubstr("against the truth. front: T"));
    EXPECT_THAT(legend(85), HasSubstr("interval. error: "));
    EXPECT_THAT(legend(60), HasSubstr("in random order. error: "));
}

TEST(FittingTable, breaks_long_settings_and_loses_none) {
    const std::string narrow = to_fitting_table(result_of(some), {80, false});
    std::string words;
    bool inside = false;
    for (const std::string& line : lines_of(narrow)) {
        if (line.rfind("  deep", 0) == 0) inside = true;
        if (line.rfind("  uncompressed", 0) == 0) inside = false;
        if (!inside) continue;
        const std::size_t first = line.find_first_not_of(' ');
        std::istringstream in(line.substr(first, line.find("  ", first) - first));
        for (std::string word; in >> word;) words += word + " ";
    }
    EXPECT_EQ(words, "deep tolerance=0.02 kernel=tent mip=blend compression=published ");
    EXPECT_THAT(line_with(narrow, "deep"), EndsWith("kept"));
    EXPECT_THAT(line_with(to_fitting_table(result_of(some), {200, false}), "deep"), HasSubstr("compression=published"))
        << "one line where there is room";
}

TEST(FittingTable, names_what_failed_and_what_was_not_made_for_the_scene) {
    Result result = result_of(some);
    std::vector<Cell>& cells = result.variants[0].lights[0].cells;
    cells[0].outside_promise = true;
    cells[2].status = CellStatus::failed;
    cells[2].verdict = Verdict::failed;
    cells[2].reason = "cell (3, 4): it rises";
    cells[2].times.reset();
    const std::string table = to_fitting_table(result);
    EXPECT_THAT(table, HasSubstr("\n    failed: uncompressed: cell (3, 4): it rises\n"));
    EXPECT_THAT(table, HasSubstr("\n    promised for opaque scenes only: shadow_map\n"));
    EXPECT_THAT(line_with(table, "uncompressed"), Not(HasSubstr("734"))) << "no time of what failed";
    EXPECT_THAT(line_with(table, "uncompressed"), EndsWith("failed"));
}

TEST(FittingTable, has_colours_only_where_they_are_asked_for) {
    EXPECT_THAT(to_fitting_table(result_of(some), {100, false}), Not(HasSubstr("\x1b")));
    const std::string coloured = to_fitting_table(result_of(some), {100, true});
    EXPECT_THAT(coloured, HasSubstr("\x1b[32mkept\x1b[0m"));
    std::string plain;
    for (std::size_t i = 0; i < coloured.size(); ++i)
        if (coloured[i] == '\x1b')
            i = coloured.find('m', i);
        else
            plain += coloured[i];
    EXPECT_EQ(plain, to_fitting_table(result_of(some), {100, false})) << "and the same columns";
}

TEST(Meaning, names_the_smallest_error_and_its_costs) {
    EXPECT_EQ(meaning_text(result_of({{"deep", "", 50, 1 << 20, 0.04}, {"pcf", "", 5, 1 << 10, 0.2}})),
              "light 0: deep has the smallest error (rms 0.04). It takes 1 MiB and 50.0 ns a lookup.\n");
}

TEST(Meaning, calls_open_what_the_intervals_leave_open) {
    // Their errors cannot be told apart. One is smaller, the other faster.
    const std::string text = meaning_text(result_of({{"deep", "", 50, 1 << 20, 0.04, 0.02},
                                                     {"avsm", "", 20, 1 << 21, 0.0401, 0.02},
                                                     {"pcf", "", 5, 1 << 10, 0.2}}),
                                          {1000, false});
    EXPECT_THAT(
        text,
        HasSubstr("deep has the smallest error (rms 0.04, undecided against avsm at rms 0.04). Of these, deep takes "
                  "the fewest bytes (1 MiB), and avsm answers fastest (19.7 ns)."));
    EXPECT_THAT(text, Not(HasSubstr("pcf"))) << "cheap, but certainly less accurate";
}

// A cheap map of ten times the error would look like a good choice.
TEST(Meaning, says_which_error_is_undecided_and_what_would_decide) {
    Result result = result_of({{"fourier", "", 50, 1 << 20, 0.03}, {"shadow_map", "", 5, 1 << 10, 0.4}});
    std::vector<Cell>& cells = result.variants[0].lights[0].cells;
    const auto give_seeds = [&](std::initializer_list<double> strays) {
        for (Cell& cell : cells) cell.over_seeds.clear();
        for (const double stray : strays) {
            cells[0].over_seeds.push_back({{}, cells[0].bytes});
            cells[0].over_seeds.back().lookup.rms = 0.03;
            cells[1].over_seeds.push_back({{}, cells[1].bytes});
            cells[1].over_seeds.back().lookup.rms = 0.4 * stray;
        }
    };
    give_seeds({0.1, 0.5});
    EXPECT_EQ(meaning_text(result, {1000, false}),
              "light 0: fourier has the smallest error (rms 0.03, undecided against shadow_map at rms 0.4). Of these, "
              "shadow_map takes the fewest bytes (1 KiB), and shadow_map answers fastest (5.00 ns). "
              "reference.spread_seeds 2 are too few to decide between errors that differ by more than a factor of 2: "
              "ask for 5.\n");
    give_seeds({0.1, 0.1, 0.1, 0.1, 0.1, 0.1});
    EXPECT_THAT(meaning_text(result, {1000, false}), HasSubstr("reference.spread_seeds 6 are too few"));
    EXPECT_THAT(meaning_text(result, {1000, false}), HasSubstr("ask for 12.\n"));
    for (Cell& cell : cells) cell.lookup->truth_sd = 0.05;  // of squares
    EXPECT_THAT(meaning_text(result, {1000, false}), HasSubstr("ask for more reference.samples_per_pixel."));
    for (Cell& cell : cells) {
        cell.lookup->truth_sd = 0.0;
        cell.lookup->interval->covers_rays = false;
    }
    give_seeds({});
    EXPECT_THAT(meaning_text(result, {1000, false}), HasSubstr("ask for reference.spread_seeds 5."));
    give_seeds({1.0, 1.0});
    EXPECT_THAT(meaning_text(result, {1000, false}), Not(HasSubstr("ask for"))) << "this decides";
}

// Otherwise an error below the one asked for seems to be above it, by the noise of the truth.
TEST(Meaning, says_how_much_of_the_errors_a_noisy_truth_makes) {
    Result result = result_of({{"deep", "", 50, 1 << 20, 0.021}, {"pcf", "", 5, 1 << 10, 0.2}});
    LightResult& light = result.variants[0].lights[0];
    light.reference.error_rms = 0.0065;
    EXPECT_THAT(meaning_text(result, {1000, false}), Not(HasSubstr("truth itself")));
    light.reference.error_rms = 0.011;
    EXPECT_THAT(
        meaning_text(result, {1000, false}),
        HasSubstr("The truth itself has a standard error of 0.011, which each error includes: an exact one would "
                  "be about sqrt(error^2 - 0.011^2)."));
}

TEST(Meaning, names_the_error_of_whom_it_has_not_named_yet) {
    const std::vector<Made> five{{"deep", "", 50, 5 << 20, 0.04, 0.02},
                                 {"a", "", 60, 4 << 20, 0.0401, 0.02},
                                 {"b", "", 60, 4 << 20, 0.0401, 0.02},
                                 {"c", "", 60, 4 << 20, 0.0401, 0.02},
                                 {"avsm", "", 60, 1 << 20, 0.0406, 0.05}};
    const std::string text = meaning_text(result_of(five), {1000, false});
    EXPECT_THAT(text, HasSubstr(" and 1 more). Of these, avsm at rms 0.041 takes the fewest bytes (1 MiB)"));
    EXPECT_THAT(text, Not(HasSubstr("ask for"))) << "they are close to each other";
}

TEST(Meaning, calls_ties_ties) {
    Result result = result_of({{"deep", "", 50, 1 << 20, 0.04}, {"avsm", "", 50, 1 << 20, 0.04}});
    result.variants[0].lights[0].cells[1] = result.variants[0].lights[0].cells[0];
    result.variants[0].lights[0].cells[1].technique = "avsm";
    EXPECT_EQ(meaning_text(result, {1000, false}),
              "light 0: deep has the smallest error (rms 0.04, a tie with avsm). Of these, deep takes the fewest bytes "
              "(1 MiB, a tie with avsm), and deep answers fastest (50.0 ns, undecided against avsm).\n");
}

TEST(Meaning, ranks_no_bytes_of_what_stores_no_map_and_no_times_of_a_busy_machine) {
    Result result = result_of({{"ray_traced", "", 900, 0, 0.04, 0.02}, {"deep", "", 50, 1 << 20, 0.0401, 0.02}});
    std::vector<Cell>& cells = result.variants[0].lights[0].cells;
    cells[1].times->random_order.floor = summarise({1, 2, 3, 4, 5, 6, 7, 8, 9});
    const std::string text = meaning_text(result, {1000, false});
    EXPECT_THAT(text, HasSubstr("deep takes the fewest bytes (1 MiB); which answers fastest is undecided, since the "
                                "machine was not quiet."));
    cells[1].status = CellStatus::failed;
    EXPECT_THAT(meaning_text(result, {1000, false}), HasSubstr("ray_traced has the smallest error (rms 0.04)."));
    cells[0].status = CellStatus::failed;
    EXPECT_THAT(meaning_text(result), HasSubstr("no technique has an error to compare"));
}

TEST(Meaning, of_many_lights_counts_who_is_the_smallest) {
    const std::vector<Made> two{{"deep", "", 50, 1 << 20, 0.04, 0.02}, {"avsm", "", 20, 1 << 21, 0.0401, 0.02}};
    EXPECT_THAT(meaning_text(result_of(two, 4)), StartsWith("light 0: deep"));
    Result result = result_of(two, 6);
    result.variants[0].lights[5].cells[1] = result.variants[0].lights[5].cells[0];
    EXPECT_EQ(meaning_text(result, {1000, false}),
              "The fewest bytes of those that may have the smallest error, in 6 tables: deep in 5, undecided or a tie "
              "in 1.\n");
}

}  // namespace
}  // namespace shadowbench::results

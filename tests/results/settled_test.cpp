// The rule by which a run is called unsettled, on synthetic floors.
#include "results/settled.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "base/random.h"
#include "results/report.h"

namespace shadowbench::results {
namespace {

// The floor of a cell in one order and repetition.
using Floor = std::function<double(int cell, int order, int repetition)>;

LightResult light_of(int cells, int repetitions, const Floor& floor) {
    LightResult light;
    light.name = "key";
    for (int c = 0; c < cells; ++c) {
        Cell cell;
        cell.technique = "technique" + std::to_string(c);
        cell.parameters_json = "{}";
        cell.times = CellTimes{};
        for (int order = 0; order < 2; ++order) {
            std::vector<double> raw;
            for (int r = 0; r < repetitions; ++r) raw.push_back(floor(c, order, r));
            (order ? cell.times->random_order : cell.times->image_order).floor = summarise(raw);
        }
        cell.times->build_ms = summarise({1.0});
        cell.times->image_order.ns = cell.times->random_order.ns = summarise({10.0});
        light.cells.push_back(std::move(cell));
    }
    return light;
}

bool is_settled(const LightResult& light) {
    return settling(light).settled();
}

double normal(base::Random& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(6.283185307179586 * random.uniform());
}

// A machine that its neighbours disturb a little: its speed follows a slow autoregression, each pass has noise of its
// own, and an interrupt hits one pass in fifty. Standard deviations of the logarithms.
class QuietMachine {
public:
    explicit QuietMachine(std::uint64_t seed) : random_(seed), pace_(slow * normal(random_)) {}
    double pass() {
        pace_ = keep * pace_ + std::sqrt(1.0 - keep * keep) * slow * normal(random_);
        const double late = random_.uniform() < 0.02 ? random_.uniform(1.0, 3.0) : 1.0;
        return std::exp(pace_ + own * normal(random_)) * late;
    }
    base::Random& random() { return random_; }

private:
    static constexpr double slow = 0.05, own = 0.05, keep = 0.9;
    base::Random random_;
    double pace_;
};

int count_settled(int runs, const std::function<LightResult(std::uint64_t seed)>& make) {
    int settled = 0;
    for (int i = 0; i < runs; ++i) settled += is_settled(make(static_cast<std::uint64_t>(i) + 1));
    return settled;
}

TEST(Settled, ConstantFloorsAreQuiet) {
    const Settling found = settling(light_of(7, 9, [](int c, int o, int) { return 4.0 + c + o; }));
    EXPECT_EQ(found.floors, 14u);
    EXPECT_TRUE(found.settled());
    EXPECT_EQ(found.pace, 0.0);
    EXPECT_EQ(unsettled_text(found), "");
}

TEST(Settled, OrdinaryNoiseIsQuiet) {
    for (const int cells : {1, 3, 7})
        for (const int repetitions : {5, 7, 9, 21}) {
            const int settled = count_settled(400, [&](std::uint64_t seed) {
                QuietMachine machine(seed);
                return light_of(cells, repetitions, [&](int, int, int) { return 5.0 * machine.pass(); });
            });
            EXPECT_GE(settled, 392) << cells << " cells, " << repetitions
                                    << " repetitions: 2 % of false alarms at most";
        }
}

// Memory traffic of another core comes and goes. While it lasts, floors of maps that do not fit the caches take up to
// two and a half times as long; those of small maps do not change.
TEST(Settled, MemoryTrafficOnTheOtherCoreIsNotQuiet) {
    const int settled = count_settled(400, [](std::uint64_t seed) {
        QuietMachine machine(seed);
        return light_of(7, 9, [&](int cell, int, int) {
            const bool large = cell >= 5, busy = machine.random().uniform() < 0.5;
            const double slower = large && busy ? machine.random().uniform(1.3, 2.5) : 1.0;
            return 5.0 * machine.pass() * slower;
        });
    });
    EXPECT_LE(settled, 20) << "at least 95 % of such runs are named";
}

// Seen in practice: one floor of 20 ns took 86 ns in most repetitions, and a front was drawn through it.
TEST(Settled, OneFloorDisturbedInHalfOfItsRepetitionsIsNamed) {
    const LightResult light =
        light_of(7, 9, [](int c, int o, int r) { return c == 3 && o == 1 && r % 2 == 0 ? 86.0 : 20.0; });
    const Settling found = settling(light);
    EXPECT_FALSE(found.settled());
    ASSERT_EQ(found.unsteady.size(), 1u);
    EXPECT_EQ(found.unsteady[0].cell, "technique3");
    EXPECT_STREQ(found.unsteady[0].order, "random");
    EXPECT_EQ(unsettled_text(found), "1 of 14 floors spreads by more than 25 % (technique3, random order: 77 %)");
}

TEST(Settled, AMachineThatChangesItsSpeedIsNotQuiet) {
    const auto pace = [](double slower) {
        return light_of(7, 9, [=](int c, int o, int r) { return (4.0 + c + o) * (r >= 5 ? slower : 1.0); });
    };
    EXPECT_TRUE(is_settled(pace(1.1)));
    const Settling found = settling(pace(1.2));
    EXPECT_FALSE(found.settled());
    EXPECT_TRUE(found.unsteady.empty()) << "no floor is worse than the others";
    EXPECT_NEAR(*found.pace, 0.2, 1e-9);
    EXPECT_EQ(unsettled_text(found), "the pace of all floors together spreads by 20 %, more than 15 %");
}

TEST(Settled, ALateInterruptDoesNotCount) {
    EXPECT_TRUE(is_settled(light_of(7, 9, [](int c, int, int r) { return c == 2 && r == 4 ? 500.0 : 5.0; })));
    EXPECT_TRUE(is_settled(light_of(7, 9, [](int, int, int r) { return r == 4 ? 500.0 : 5.0; })));
}

TEST(Settled, FewRepetitionsOrNoFloorsAreNotJudged) {
    const Settling few = settling(light_of(7, 4, [](int, int, int r) { return 5.0 + 5.0 * r; }));
    EXPECT_EQ(few.floors, 0u);
    EXPECT_EQ(few.unjudged, 14u);
    EXPECT_EQ(unsettled_text(few), "");
    Result result;
    result.variants.resize(1);
    result.variants[0].lights.resize(1);
    EXPECT_FALSE(settled(result).has_value());
    result.variants[0].lights[0].cells.resize(2);  // one failed, one that reads no map
    result.variants[0].lights[0].cells[1].times = CellTimes{};
    EXPECT_FALSE(settled(result).has_value());
    EXPECT_FALSE(settling(light_of(2, 9, [](int, int, int) { return 5.0; })).pace) << "four floors give no pace";
    EXPECT_EQ(settling(light_of(1, 9, [](int, int, int) { return 0.0; })).floors, 0u) << "a time of 0 is not usable";
}

// A quiet light with the passes of 9 repetitions.
LightResult timed_light() {
    LightResult light = light_of(7, 9, [](int, int, int) { return 5.0; });
    for (Cell& cell : light.cells) {
        cell.times->build_ms = summarise(std::vector<double>(9, 2.0));
        cell.times->image_order.ns = cell.times->random_order.ns = summarise(std::vector<double>(9, 10.0));
    }
    light.timing = TimingReport{0.05, 10.0, {63, 0, 0}, {252, 0, 0}, 0.0};
    return light;
}

// The interval of nine times reaches from the second to the eighth.
Sample spread_sample(double half_width) {
    return summarise({1.0, 1.0 - half_width, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 + half_width, 1.0 + half_width});
}

TEST(Settled, ATimeIsUncertainIfItsIntervalIsWiderThanTheGoal) {
    EXPECT_TRUE(is_settled(timed_light()));
    EXPECT_EQ(unsettled_text(settling(timed_light())), "");
    EXPECT_TRUE(is_narrow(Sample{{}, 1.0, {0.96, 1.05}}, 0.05));
    EXPECT_FALSE(is_narrow(Sample{{}, 1.0, {0.94, 1.05}}, 0.05));
    EXPECT_TRUE(is_narrow(Sample{{}, 0.003, {0.001, 0.01}}, 0.05)) << "a table shows 0.00";

    LightResult light = timed_light();
    light.cells[2].times->random_order.ns = Sample{std::vector<double>(9, 10.0), 10.0, {8.0, 12.4}};
    light.cells[4].times->build_ms = Sample{std::vector<double>(9, 2.0), 2.0, {1.8, 2.0}};
    EXPECT_EQ(is_settled(light.cells[4].times->build_ms, light), true) << "5 % is still narrow";
    EXPECT_EQ(is_settled(light.cells[2].times->random_order.ns, light), false);
    light.cells[4].times->build_ms.interval.low = 1.7;
    light.timing->goal = 0.06;
    Settling found = settling(light);
    EXPECT_EQ(found.times, 21u);
    EXPECT_FALSE(found.disturbed());
    EXPECT_FALSE(found.settled());
    EXPECT_EQ(disturbance_text(found), "");
    EXPECT_EQ(unsettled_text(found),
              "2 of 21 times are uncertain by more than 6 % (technique2, random order: 22 %; technique4, build: 8 %), "
              "though nothing shows that the machine was disturbed: allow more repetitions (timing.most_repetitions, "
              "timing.seconds)");
    light.timing->steal_seconds = 0.5;
    EXPECT_EQ(unsettled_text(settling(light)),
              "the host of this virtual machine took 5.0 % of the time (steal), more than 2 %, and 2 of 21 times are "
              "uncertain by more than 6 % (technique2, random order: 22 %; technique4, build: 8 %)");

    light.cells[2].times->random_order.ns.raw.resize(4);
    EXPECT_FALSE(is_settled(light.cells[2].times->random_order.ns, light).has_value()) << "too few to judge";
    light.timing.reset();
    EXPECT_FALSE(is_settled(light.cells[4].times->build_ms, light).has_value()) << "the goal is not known";
    EXPECT_TRUE(is_settled(light)) << "and an old result is judged by its floors";
}

TEST(Settled, InterruptedPassesAndStealAreNamed) {
    LightResult light = timed_light();
    light.timing->builds.interrupted = 12;   // 19 %
    light.timing->lookups.interrupted = 50;  // 19.8 %
    light.timing->steal_seconds = 0.2;       // 2 %
    EXPECT_TRUE(is_settled(light));
    light.timing->steal_seconds.reset();
    EXPECT_TRUE(is_settled(light)) << "not every system tells";
    light.timing->builds.interrupted = 13;
    EXPECT_EQ(unsettled_text(settling(light)),
              "other programs interrupted 21 % of the timed passes of builds, more than 20 %");
    light.timing->builds.interrupted = 0;
    light.timing->lookups.interrupted = 126;
    light.timing->steal_seconds = 0.31;
    EXPECT_EQ(unsettled_text(settling(light)),
              "other programs interrupted 50 % of the timed passes of lookups, more than 20 %, and the host of this "
              "virtual machine took 3.1 % of the time (steal), more than 2 %");
    for (Cell& cell : light.cells) cell.times.reset();
    EXPECT_EQ(unsettled_text(settling(light)), "") << "nothing is known of no times";
}

TEST(Settled, FloorsThatDriftAreNamed) {
    const auto pace = [](double slower) {
        return light_of(7, 11, [=](int c, int o, int r) { return (4.0 + c + o) * (1.0 + slower * r / 10.0); });
    };
    EXPECT_TRUE(is_settled(pace(0.14)));
    EXPECT_EQ(unsettled_text(settling(pace(0.2))),
              "the floors became 20 % slower from the first repetition to the last");
    EXPECT_EQ(unsettled_text(settling(pace(-0.2))),
              "the floors became 20 % faster from the first repetition to the last");
}

TEST(Settled, OneLineAtTheEndNamesWhatIsUnsettled) {
    Result quiet, busy;
    quiet.name = "quiet";
    quiet.variants = {{{}, {timed_light()}}};
    busy.name = "busy";
    LightResult light = timed_light();
    light.name = "fill";
    light.timing->steal_seconds = 1.0;
    busy.variants = {{{{"/rays/seed", "2"}}, {timed_light(), light}}};
    EXPECT_EQ(unsettled_line({&quiet}), "");
    EXPECT_EQ(unsettled_line({}), "");
    EXPECT_EQ(unsettled_line({&quiet, &busy}),
              "UNSETTLED times of 1 of 3 lights: busy /rays/seed=2 light fill: the host of this virtual machine took "
              "10.0 % of the time (steal), more than 2 %. Run again on a quiet machine.\n");
    const std::string many = unsettled_line({&busy, &busy, &busy, &busy});
    EXPECT_EQ(many.rfind("UNSETTLED times of 4 of 8 lights: ", 0), 0u) << many;
    EXPECT_NE(many.find("; and 1 more. Run again on a quiet machine.\n"), std::string::npos) << many;
    EXPECT_EQ(many.find('\n'), many.size() - 1) << "one line";
}

TEST(Settled, EveryReportMarksUncertainTimes) {
    Result result;
    result.document = "{}";
    LightResult light = timed_light();
    EXPECT_EQ(spread_sample(0.25).interval.high, 1.25);
    light.cells[1].times->image_order.ns = spread_sample(0.25);
    light.cells[1].times->build_ms = spread_sample(0.01);
    result.variants = {{{}, {light}}};
    const std::string table = to_table(result), csv = to_csv(result);
    EXPECT_NE(table.find(" ~1.00 "), std::string::npos) << table;
    EXPECT_EQ(table.find('~'), table.find("~1.00")) << "only that time";
    EXPECT_NE(table.find("~: a time whose 95 % interval is wider"), std::string::npos);
    EXPECT_NE(csv.find(",0,lookup_image_ns,ns,1,1,1.25,repetitions,0\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find(",0,lookup_image_ns,ns,10,10,10,repetitions,1\n"), std::string::npos)
        << "quiet is of the light, narrow of the time: " << csv;
    nlohmann::ordered_json json = to_json(result);
    EXPECT_EQ(json["times"]["settled"], false);
    const auto& written = json["variants"][0]["lights"][0];
    EXPECT_EQ(written["cells"][1]["times"]["settled"].dump(),
              R"({"build":true,"lookup_image_order":false,"lookup_random_order":true})");
    EXPECT_EQ(written["times"]["goal"], 0.05);
    EXPECT_EQ(written["times"]["lookups"]["passes"], 252);
    EXPECT_EQ(written["times"]["steal_seconds"], 0.0);
    EXPECT_EQ(written["times"]["settled"], false);
    strip_times(json);
    EXPECT_FALSE(json["variants"][0]["lights"][0].contains("times")) << "baselines hold nothing of the clock";
    result.variants[0].lights[0] = timed_light();
    EXPECT_EQ(to_table(result).find('~'), std::string::npos) << "no legend for a mark that is not there";
}

TEST(Settled, EveryReportSaysThatARunIsUnsettled) {
    Result result;
    result.document = "{}";
    result.variants.resize(1);
    result.variants[0].lights = {light_of(7, 9, [](int, int, int) { return 5.0; }),
                                 light_of(7, 9, [](int c, int, int r) { return c == 1 && r % 2 ? 9.0 : 5.0; })};
    result.variants[0].lights[1].name = "fill";
    EXPECT_EQ(settled(result), false);
    const std::string table = to_table(result), csv = to_csv(result);
    const std::size_t fill = table.find("light fill");
    EXPECT_EQ(table.rfind("UNSETTLED", fill), std::string::npos) << "the first light was quiet";
    EXPECT_NE(table.find("    UNSETTLED: 2 of 14 floors spread by more than 25 % (technique1, image order: 80 %; "
                         "technique1, random order: 80 %)",
                         fill),
              std::string::npos)
        << table;
    EXPECT_NE(csv.find(",1,lookup_image_ns,"), std::string::npos);
    EXPECT_NE(csv.find(",0,lookup_image_ns,"), std::string::npos);
    nlohmann::ordered_json json = to_json(result);
    EXPECT_EQ(json["times"]["settled"], false);
    ASSERT_EQ(json["times"]["unsettled"].size(), 1u);
    EXPECT_EQ(json["times"]["unsettled"][0]["light"], "fill");
    EXPECT_EQ(json["times"]["unsettled"][0]["variant"], 0);
    EXPECT_EQ(from_json(json, "").times.seconds, 0.0) << "derived values are not read";
    result.variants[0].lights.pop_back();
    json = to_json(result);
    EXPECT_EQ(json["times"]["settled"], true);
    EXPECT_TRUE(json["times"]["unsettled"].empty());
    result.variants[0].lights = {light_of(7, 1, [](int, int, int) { return 5.0; })};
    EXPECT_TRUE(to_json(result)["times"]["settled"].is_null());
    EXPECT_NE(to_table(result).find("Fewer than 5 repetitions cannot show whether the machine was quiet"),
              std::string::npos)
        << "front T must not stand there without a word";
    strip_times(json);
    EXPECT_EQ(json.dump().find("settled"), std::string::npos) << "baselines hold nothing that depends on the clock";
}

}  // namespace
}  // namespace shadowbench::results

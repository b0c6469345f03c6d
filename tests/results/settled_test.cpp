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
    EXPECT_NE(csv.find(",1\n"), std::string::npos);
    EXPECT_NE(csv.find(",0\n"), std::string::npos);
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

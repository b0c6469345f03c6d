#include "compare/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "compare/made.h"
#include "temporary_folder.h"

namespace shadowbench::compare {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Ordered = nlohmann::ordered_json;

class History : public ::testing::Test {
protected:
    // Writes a result of this day; the days are not written in order.
    void write(int day, json result) const {
        const std::string text = std::to_string(day);
        result["times"]["started"] = "2026-11-" + std::string(day < 10 ? "0" : "") + text + "T02:00:00Z";
        result["program"]["commit"] = "c" + text;
        std::ofstream(folder_ / (std::to_string(day * 7 % 11) + ".json")) << result.dump();
    }
    static Ordered measure(const Ordered& history, const std::string& title, const std::string& name) {
        for (const Ordered& cell : history.at("cells"))
            if (cell.at("title") == title)
                for (const Ordered& measure : cell.at("measures"))
                    if (measure.at("name") == name) return measure;
        ADD_FAILURE() << title << " " << name;
        return {};
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

const char* const deep = "made / key / deep tolerance=0.02";

// 1 % more a day: too little for a comparison of neighbours.
json on_day(int day, double growth) {
    json result = made_result();
    for (json& value : cell_of(result, 0)["times"]["lookup_random_order"]["ratio_to_floor"]["raw"])
        value = 7.5 * std::pow(growth, day);
    return result;
}

TEST_F(History, OrdersResultsByWhenTheyWereStarted) {
    for (int day = 1; day <= 10; ++day) write(day, on_day(day, 1.01));
    const Ordered history = history_json(folder_, {});
    ASSERT_EQ(history.at("runs").size(), 10u);
    EXPECT_EQ(history.at("runs")[0].at("commit"), "c1");
    EXPECT_EQ(history.at("runs")[9].at("started"), "2026-11-10T02:00:00Z");
    const Ordered lookup = measure(history, deep, "lookup_random");
    ASSERT_EQ(lookup.at("points").size(), 10u);
    EXPECT_EQ(lookup.at("unit"), "x floor");
    EXPECT_EQ(lookup.at("points")[9].at("commit"), "c10");
    EXPECT_NEAR(lookup.at("points")[9].at("value").get<double>(), 7.5 * std::pow(1.01, 10), 1e-9);
    EXPECT_FALSE(lookup.at("points")[0].at("low").is_null());
    EXPECT_TRUE(measure(history, deep, "bytes").at("points")[0].at("low").is_null());
}

TEST_F(History, SeesASlowDrift) {
    for (int day = 1; day <= 10; ++day) write(day, on_day(day, 1.01));
    const Ordered history = history_json(folder_, {});
    const Ordered drift = measure(history, deep, "lookup_random").at("drift");
    ASSERT_FALSE(drift.is_null());
    EXPECT_NEAR(drift.at("ratio").get<double>(), std::pow(1.01, 9), 0.005);
    EXPECT_EQ(drift.at("since"), "2026-11-01T02:00:00Z");
    EXPECT_TRUE(measure(history, deep, "bytes").at("drift").is_null());
    EXPECT_THAT(history_text(history), ::testing::HasSubstr("deep tolerance=0.02: lookup_random drifts: 7.5"));
    EXPECT_THAT(history_text(history), ::testing::HasSubstr("10 results, 2 cells, 30 measures; 1 drift\n"));
    // Over the last five results it is below the minimum effect.
    EXPECT_TRUE(measure(history_json(folder_, {5, 0.05}), deep, "lookup_random").at("drift").is_null());
}

TEST_F(History, ExactMeasuresDriftByAnyAmount) {
    for (int day = 1; day <= 10; ++day) {
        json result = made_result();
        cell_of(result, 0)["bytes"] = 1000 + day;
        write(day, result);
    }
    EXPECT_EQ(measure(history_json(folder_, {}), deep, "bytes").at("drift").at("to"), 1010.0);
}

// Another machine or scenario is another series.
TEST_F(History, ComparesOnlyWithTheLatestKind) {
    for (int day = 1; day <= 10; ++day) {
        json result = on_day(day, 1.01);
        if (day == 10) result["machine"]["cpu"] = "another";
        write(day, result);
    }
    const Ordered lookup = measure(history_json(folder_, {}), deep, "lookup_random");
    EXPECT_EQ(lookup.at("points").size(), 10u);
    EXPECT_TRUE(lookup.at("drift").is_null());
}

TEST_F(History, WithoutResultsIsRefused) {
    EXPECT_THROW(history_json(folder_, {}), base::Error);
    EXPECT_THROW(history_json(folder_ / "nowhere", {}), base::Error);
    std::ofstream(folder_ / "images.json") << "{}";
    EXPECT_THROW(history_json(folder_, {}), base::Error);
}

}  // namespace
}  // namespace shadowbench::compare

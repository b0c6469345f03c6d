// The scenarios of the project, as a user gets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> committed_scenarios() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(SHADOWBENCH_SOURCE_DIR) / "scenarios"))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

class CommittedScenario : public testing::TestWithParam<fs::path> {
protected:
    nlohmann::json document() const { return parse_json(test::read_bytes(GetParam()), GetParam().filename().string()); }
};

TEST_P(CommittedScenario, PassesTheSchemaAndSaysItsPurpose) {
    const nlohmann::json scenario = document();
    EXPECT_NO_THROW(check_schema(scenario, scenario_schema()));
    EXPECT_EQ(scenario["name"], GetParam().stem().string());
    EXPECT_GT(scenario.value("purpose", "").size(), 20u);
}

TEST_P(CommittedScenario, Loads) {
    const nlohmann::json scenario = document();
    const fs::path probe = test::data_file("README.md");
    try {
        const Scenario loaded =
            load_scenario(scenario, {GetParam().parent_path(), probe.empty() ? fs::path(".") : probe.parent_path()});
        EXPECT_FALSE(loaded.lights.empty());
        EXPECT_EQ(loaded.techniques.size(), scenario["techniques"].size());
    } catch (const base::Error& error) {
        ASSERT_EQ(error.code(), base::ErrorCode::no_such_file) << error.what();
        GTEST_SKIP() << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, CommittedScenario, testing::ValuesIn(committed_scenarios()),
                         [](const auto& scenario) { return scenario.param.stem().string(); });

TEST(CommittedScenarios, Exist) {
    int hard = 0;
    for (const fs::path& file : committed_scenarios()) hard += file.parent_path().filename() == "hard";
    EXPECT_GE(hard, 20);
    EXPECT_GE(static_cast<int>(committed_scenarios().size()) - hard, 8);
}

}  // namespace
}  // namespace shadowbench::scene

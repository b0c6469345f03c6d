#include "scene/named_scenarios.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "temporary_folder.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;

class NamedScenarios : public ::testing::Test {
protected:
    fs::path write(const std::string& file, const std::string& text) {
        const fs::path path = folder_.path() / file;
        fs::create_directories(path.parent_path());
        std::ofstream(path) << text;
        return path;
    }
    fs::path scenario(const std::string& file, const std::string& name) {
        return write(file, R"({"name": ")" + name + R"(", "purpose": "of )" + file + "\"}");
    }
    std::vector<fs::path> folders(const std::vector<std::string>& names) const {
        std::vector<fs::path> paths;
        for (const std::string& name : names) paths.push_back(folder_.path() / name);
        return paths;
    }
    // What the list holds: names in order. Each finds the file beside it, and no name stands twice.
    static std::vector<std::string> listed(const std::vector<fs::path>& folders) {
        std::vector<std::string> names;
        for (const NamedScenario& one : list_scenarios(folders)) {
            EXPECT_EQ(find_scenario(folders, one.name), one.file) << one.name;
            names.push_back(one.name);
        }
        EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
        return names;
    }

private:
    TemporaryFolder folder_;
};

using Names = std::vector<std::string>;

TEST_F(NamedScenarios, AreFoundByTheirOwnNamesAtAnyDepthAndByTheirPaths) {
    const fs::path deep = scenario("a/papers/file.json", "own"), top = scenario("a/top.json", "top");
    const std::vector<fs::path> in = folders({"a"});
    EXPECT_EQ(listed(in), (Names{"own", "top"}));
    EXPECT_EQ(find_scenario(in, "own"), deep);
    EXPECT_EQ(find_scenario(in, "papers/file"), deep);
    EXPECT_EQ(find_scenario(in, "papers/file.json"), deep);
    EXPECT_EQ(find_scenario(in, "top"), top);
    EXPECT_EQ(find_scenario(in, "file"), fs::path());
    EXPECT_EQ(find_scenario(in, "papers"), fs::path()) << "a folder";
    EXPECT_EQ(find_scenario(in, ""), fs::path());
}

TEST_F(NamedScenarios, OfTheFirstFolderCount) {
    const fs::path first = scenario("a/x.json", "same");
    scenario("b/x.json", "same");
    const fs::path other = scenario("b/y.json", "same");
    const std::vector<fs::path> in = folders({"a", "b"});
    EXPECT_EQ(listed(in), (Names{"same", "y"})) << "y is found by its path, b/x by nothing";
    EXPECT_EQ(find_scenario(in, "same"), first);
    EXPECT_EQ(find_scenario(in, "x"), first);
    EXPECT_EQ(find_scenario(in, "y"), other);
}

TEST_F(NamedScenarios, OfOneFolderPathsCountBeforeNames) {
    const fs::path path = scenario("a/one.json", "other"), name = scenario("a/two.json", "one");
    const std::vector<fs::path> in = folders({"a"});
    EXPECT_EQ(find_scenario(in, "one"), path);
    EXPECT_EQ(find_scenario(in, "two"), name);
    EXPECT_EQ(listed(in), (Names{"other", "two"}));
    scenario("a/b.json", "other");
    EXPECT_EQ(listed(in), (Names{"other", "one", "two"})) << "b.json comes first, so one.json is listed by its path";
}

TEST_F(NamedScenarios, ThatCannotBeReadAreListedWithTheReason) {
    write("a/sub/broken.json", "{");
    write("a/list.json", "[1]");
    write("a/unnamed.json", R"({"name": 7})");
    scenario("a/data/inside.json", "inside");
    const std::vector<fs::path> in = folders({"a", "gone"});
    EXPECT_EQ(listed(in), (Names{"list", "sub/broken", "unnamed"})) << "data/ is not looked into";
    EXPECT_NE(list_scenarios(in)[1].fault, "");
    EXPECT_EQ(list_scenarios(in)[0].fault, "");
}

TEST_F(NamedScenarios, ThatAreCommittedAreAllFoundByTheirOwnNames) {
    const std::vector<fs::path> in{fs::path(SHADOWBENCH_SOURCE_DIR) / "scenarios"};
    const Names names = listed(in);
    EXPECT_GT(names.size(), 40u);
    for (const char* name : {"quickstart", "pagot2004_flat", "reeves1987_sphere", "few_nodes"})
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
    for (const NamedScenario& one : list_scenarios(in)) {
        EXPECT_EQ(one.fault, "") << one.file;
        EXPECT_EQ(one.name.find('/'), std::string::npos) << one.file << ": another scenario has its name";
    }
}

}  // namespace
}  // namespace shadowbench::scene

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "service/api/describe.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

TEST(Scenarios, OfOneNameTheFirstFoldersIsListed) {
    const TemporaryFolder temporary;
    const fs::path& top = temporary.path();
    for (const char* one : {"first", "second"}) {
        fs::create_directories(top / one);
        std::ofstream(top / one / "same.json") << R"({"name": "same", "purpose": ")" << one << "\"}";
    }
    std::ofstream(top / "second" / "other.json") << R"({"name": "other"})";
    const nlohmann::json list = nlohmann::json::parse(read_scenarios({top / "first", top / "second"}))["scenarios"];
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0]["name"], "other");
    EXPECT_EQ(list[1]["name"], "same");
    EXPECT_EQ(list[1]["purpose"], "first");
}

// As on the command line: by the name that a scenario gives itself, at any depth.
TEST(Scenarios, AreListedUnderTheNamesThatFindThem) {
    const TemporaryFolder temporary;
    const fs::path& top = temporary.path();
    fs::create_directories(top / "papers");
    std::ofstream(top / "papers" / "file.json") << R"({"name": "own", "purpose": "deep"})";
    std::ofstream(top / "a.json") << R"({"name": "twice", "purpose": "a"})";
    std::ofstream(top / "b.json") << R"({"name": "twice", "purpose": "b"})";
    std::ofstream(top / "broken.json") << "{";
    std::ofstream(top / "unnamed.json") << "{}";
    const nlohmann::json list = nlohmann::json::parse(read_scenarios({top}))["scenarios"];
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0]["name"], "own");
    EXPECT_EQ(list[0]["document"]["purpose"], "deep");
    EXPECT_EQ(list[1]["name"], "twice");
    EXPECT_EQ(list[1]["purpose"], "a");
}

}  // namespace
}  // namespace shadowbench::service

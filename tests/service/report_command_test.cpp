#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "service/cli/cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ReportCommand : public ::testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    int report(std::vector<std::string> arguments) {
        std::vector<const char*> argv{"shadowbench", "report"};
        for (const std::string& argument : arguments) argv.push_back(argument.c_str());
        out_.str({}), err_.str({});
        return cli_main(static_cast<int>(argv.size()), argv.data(), out_, err_);
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
    std::ostringstream out_, err_;
};

TEST_F(ReportCommand, WritesBesideTheResultOrWhereItIsTold) {
    write("result.json", R"({"schema_version": 1, "name": "tiny", "variants": []})");
    EXPECT_EQ(report({folder_.string()}), 0) << err_.str();
    EXPECT_TRUE(fs::exists(folder_ / "report.html"));
    EXPECT_THAT(out_.str(), HasSubstr("without pictures"));
    EXPECT_EQ(report({folder_.string(), "--out", (folder_ / "new" / "page.html").string()}), 0) << err_.str();
    EXPECT_TRUE(fs::exists(folder_ / "new" / "page.html"));
}

// Otherwise results that others send would be seen by nobody.
TEST_F(ReportCommand, MakesOnePageOfTheResultsOfMachines) {
    const fs::path released = fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/released/0.2.0/result.json";
    for (const char* name : {"one", "two<b>"}) {
        fs::create_directories(folder_ / name);
        fs::copy_file(released, folder_ / name / "2026-11-30.json");
    }
    EXPECT_EQ(report({folder_.string()}), 0) << err_.str();
    EXPECT_THAT(out_.str(), HasSubstr("(2 results)"));
    std::ifstream stream(folder_ / "report.html");
    const std::string page{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    EXPECT_THAT(page, HasSubstr("<h2>two_sheets, light sun</h2>"));
    EXPECT_THAT(page, HasSubstr("<th scope=\"col\">deep tolerance=0.01</th>"));
    EXPECT_THAT(page, HasSubstr("~ one, AMD EPYC, ")) << "of a machine that was not quiet";
    EXPECT_THAT(page, HasSubstr("two&lt;b&gt;"));
    EXPECT_THAT(page, testing::Not(HasSubstr("<b>"))) << "names are no HTML";
    write("one/2026-12-01.json", "{}");
    EXPECT_EQ(report({folder_.string()}), 65);
    EXPECT_THAT(err_.str(), HasSubstr("2026-12-01.json"));
}

// Else the message would be about a file that is no result.
TEST_F(ReportCommand, TakesNoPicturesForResultsOfMachines) {
    write("images/images.json", "{}");
    EXPECT_EQ(report({folder_.string()}), 66);
    EXPECT_THAT(err_.str(), HasSubstr("result.json"));
}

TEST_F(ReportCommand, TakesPicturesFromItsFolderOrAnother) {
    write("result.json", R"({"schema_version": 1, "name": "tiny", "variants": []})");
    const std::string images = R"({"reference": {"files": ["a.png"]}, "techniques": []})";
    write("other/images.json", images);
    write("other/a.png", "abc");
    EXPECT_EQ(report({folder_.string(), "--images", (folder_ / "other").string()}), 0) << err_.str();
    EXPECT_EQ(out_.str().find("without pictures"), std::string::npos);
    write("images/images.json", images);
    EXPECT_EQ(report({folder_.string()}), 0) << err_.str();
    EXPECT_EQ(out_.str().find("without pictures"), std::string::npos);
}

TEST_F(ReportCommand, WhatIsNoResultIsNamed) {
    EXPECT_EQ(report({(folder_ / "nowhere").string()}), 66);
    EXPECT_EQ(report({folder_.string()}), 66);
    EXPECT_THAT(err_.str(), HasSubstr("result.json"));
    for (const char* text : {"", "{", "[]", "{}", R"({"schema_version": 1})"}) {
        write("result.json", text);
        EXPECT_EQ(report({folder_.string()}), 65) << text;
        EXPECT_THAT(err_.str(), HasSubstr("not a result of run")) << text;
    }
    write("result.json", R"({"schema_version": 7, "variants": []})");
    EXPECT_EQ(report({folder_.string()}), 65);
    EXPECT_THAT(err_.str(), HasSubstr("version 7, but this program reads version 1"));
    EXPECT_FALSE(fs::exists(folder_ / "report.html"));
}

TEST_F(ReportCommand, ImagesThatAreToldMustBeThere) {
    write("result.json", R"({"schema_version": 1, "variants": []})");
    EXPECT_EQ(report({folder_.string(), "--images", folder_.string()}), 66);
    EXPECT_THAT(err_.str(), HasSubstr("images.json"));
}

}  // namespace
}  // namespace shadowbench::service

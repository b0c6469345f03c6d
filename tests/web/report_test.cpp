#include "service/web/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/web/history_page.h"
#include "temporary_folder.h"
#include "web/external.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Report : public ::testing::Test {
protected:
    void SetUp() override { fs::create_directories(images()); }

    fs::path images() const { return folder_ / "images"; }
    void write(const std::string& name, const std::string& text) const { std::ofstream(images() / name) << text; }
    void write_images(const json& names) const {
        const json files = {{"reference", {{"files", json::array()}}}, {"techniques", {{{"files", names}}}}};
        write("images.json", files.dump());
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

// The data as the page's script reads it.
json data_of(const std::string& page) {
    const std::string start = "id=\"data\">";
    const std::size_t from = page.find(start) + start.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from));
}

// Everything but what stands between the tags of its scripts.
std::string without_scripts(const std::string& page) {
    std::string rest;
    for (std::size_t at = 0;;) {
        const std::size_t open = page.find("<script", at);
        rest += page.substr(at, open - at);
        if (open == std::string::npos) return rest;
        const std::size_t body = page.find('>', open);
        rest += page.substr(open, body - open);
        at = page.find("</script>", body);
    }
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++n;
    return n;
}

TEST_F(Report, HoldsTheWholeResultAndLoadsNothing) {
    const json result = {{"name", "tiny"}, {"variants", json::array()}, {"value", 0.1}};
    const std::string page = report_html(result, images());
    EXPECT_EQ(data_of(page)["result"], result);
    EXPECT_TRUE(data_of(page)["images"].is_null());
    // The licences contain the addresses of the packages as text; nothing is loaded from them.
    const std::string loaded = std::regex_replace(page, std::regex("<script type=\"text/plain\"[^<]*</script>"), "");
    EXPECT_THAT(external_addresses(loaded), ::testing::IsEmpty());
    EXPECT_FALSE(std::regex_search(without_scripts(page), std::regex("<script[^>]* src=|<link|<img|url\\(|@import")));
    EXPECT_NE(page.find("Content-Security-Policy"), std::string::npos);
}

TEST_F(Report, HostileNamesStayText) {
    const std::string hostile = "</script><script>alert(1)</script><!--<b>&\"'";
    const std::string plain = report_html({{"name", "x"}}, images());
    const json result = {{"name", hostile}, {"variants", {{{"settings", {{hostile, "\u2028"}}}}}}};
    const std::string page = report_html(result, images());
    EXPECT_EQ(data_of(page)["result"], result);
    // As many of each as a page without them.
    for (const char* what : {"<script", "</script", "<!--", "</title", "<b>", "alert(1)<"})
        EXPECT_EQ(count(page, what), count(plain, what)) << what;
    EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&lt;!--&lt;b&gt;&amp;&quot;'"),
              std::string::npos);
}

TEST_F(Report, NamesThatAreNoUtf8DoNotBreakIt) {
    json result = {{"name", "ok"}};
    result["purpose"] = std::string("caf\xe9");
    EXPECT_NE(report_html(result, images()).find("\xef\xbf\xbd"), std::string::npos);
}

TEST_F(Report, PicturesAreInIt) {
    write("a.shaded.png", std::string("\x89PNG\r\n\0\xff", 8));
    write("b.png", "x");
    write("c.png", "xy");
    write("a.shaded.exr", "not for a page");
    write_images({"a.shaded.exr", "a.shaded.png", "b.png", "c.png", "missing.png"});
    const json pictures = data_of(report_html({{"name", "x"}}, images()))["pictures"];
    EXPECT_EQ(pictures, (json{{"a.shaded.png", "data:image/png;base64,iVBORw0KAP8="},
                              {"b.png", "data:image/png;base64,eA=="},
                              {"c.png", "data:image/png;base64,eHk="}}));
}

TEST_F(Report, OnlyFilesOfTheFolderAreTaken) {
    std::ofstream(folder_ / "secret.png") << "secret";
    write("own.png", "x");
    fs::create_symlink(folder_ / "secret.png", images() / "link.png");
    fs::create_directory(images() / "folder.png");
    write_images({"../secret.png", (folder_ / "secret.png").string(), "link.png", "folder.png", "..", "", "own.png"});
    const json pictures = data_of(report_html({{"name", "x"}}, images()))["pictures"];
    EXPECT_EQ(pictures.size(), 1u);
    EXPECT_TRUE(pictures.contains("own.png"));
}

TEST_F(Report, BrokenImagesJsonIsNamed) {
    for (const char* text : {"{", "[]", "{}", R"({"reference": {"files": [1]}, "techniques": []})",
                             R"({"reference": {}, "techniques": [1]})", R"({"reference": 1, "techniques": {}})"}) {
        write("images.json", text);
        try {
            report_html({{"name", "x"}}, images());
            ADD_FAILURE() << text;
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << text;
            EXPECT_EQ(error.where(), (images() / "images.json").string());
        }
    }
}

TEST_F(Report, AResultThatIsNoObjectStillGivesAPage) {
    EXPECT_NE(report_html(json::array(), images() / "nowhere").find("<title>unnamed"), std::string::npos);
    EXPECT_NE(report_html({{"name", 3}}, images()).find("<title>unnamed"), std::string::npos);
}

TEST(HistoryPage, HoldsTheHistoryAndLoadsNothing) {
    const json history = {{"cells", {{{"title", "</script><i>"}, {"measures", json::array()}}}},
                          {"runs", json::array()}};
    const std::string page = history_html(history);
    EXPECT_EQ(data_of(page), history);
    EXPECT_EQ(count(page, "<i>"), 0u);
    EXPECT_FALSE(std::regex_search(without_scripts(page), std::regex("<script[^>]* src=|<link|<img|url\\(|@import")));
}

}  // namespace
}  // namespace shadowbench::service

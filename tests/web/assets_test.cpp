#include "service/web/assets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "web/external.h"

namespace shadowbench::service {
namespace {

std::string file_text(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string name_of(const Asset& asset) {
    return asset.path == "/" ? "index.html" : std::string(asset.path.substr(asset.path.rfind('/') + 1));
}

TEST(Assets, ThePageIsThereAndNothingElseAnswersToWrongPaths) {
    const Asset* page = find_asset("/");
    ASSERT_NE(page, nullptr);
    EXPECT_EQ(page->type, "text/html; charset=utf-8");
    EXPECT_FALSE(page->gzip) << "what reads the page without decompressing finds it";
    for (const char* path :
         {"", "/index.html", "/assets", "/assets/", "/assets/../", "/assets/app.js.gz", "assets/app.js"})
        EXPECT_EQ(find_asset(path), nullptr) << path;
}

TEST(Assets, EveryFileThatThePageNamesIsEmbedded) {
    const std::string page = text_of(*find_asset("/"));
    static const std::regex reference("(?:src|href)=\"([^\"#]+)\"");
    std::set<std::string> named;
    for (std::sregex_iterator it(page.begin(), page.end(), reference), end; it != end; ++it) named.insert((*it)[1]);
    EXPECT_EQ(named, (std::set<std::string>{"/assets/app.js", "/assets/icon.svg", "/assets/style.css"}));
    for (const std::string& path : named) EXPECT_NE(find_asset(path), nullptr) << path;
}

TEST(Assets, ThePageHasNothingInlineThatThePolicyRefuses) {
    const std::string page = text_of(*find_asset("/"));
    EXPECT_EQ(page.find("<style"), std::string::npos);
    EXPECT_EQ(page.find(" style="), std::string::npos);
    EXPECT_EQ(page.find("<script>"), std::string::npos);
    EXPECT_FALSE(std::regex_search(page, std::regex("\\son[a-z]+=")));
}

TEST(Assets, TypesFollowTheNames) {
    const std::map<std::string, std::string> types = {{"html", "text/html; charset=utf-8"},
                                                      {"js", "text/javascript; charset=utf-8"},
                                                      {"css", "text/css; charset=utf-8"},
                                                      {"svg", "image/svg+xml"},
                                                      {"webp", "image/webp"},
                                                      {"txt", "text/plain; charset=utf-8"}};
    for (const Asset& asset : assets()) {
        const std::string name = name_of(asset);
        EXPECT_EQ(asset.type, types.at(name.substr(name.rfind('.') + 1))) << name;
    }
}

TEST(Assets, WhatIsCompressedDecodesToWhatWasBuilt) {
    std::size_t compressed = 0;
    for (const Asset& asset : assets()) {
        const std::string built = file_text(std::string(SHADOWBENCH_WEB_DIR) + "/" + name_of(asset));
        ASSERT_FALSE(built.empty()) << name_of(asset);
        EXPECT_TRUE(text_of(asset) == built) << name_of(asset);
        compressed += asset.gzip;
        if (asset.gzip) {
            EXPECT_LT(asset.content.size(), built.size() / 2) << name_of(asset);
        }
    }
    EXPECT_GE(compressed, 4u);
}

TEST(Assets, EtagsAreStrongAndOfTheContent) {
    std::set<std::string_view> seen;
    for (const Asset& asset : assets()) {
        EXPECT_THAT(std::string(asset.etag), ::testing::MatchesRegex("\"[0-9a-f]+\""));
        EXPECT_TRUE(seen.insert(asset.etag).second) << asset.path;
    }
}

TEST(Assets, NothingIsLoadedFromElsewhere) {
    for (const Asset& asset : assets()) {
        if (asset.path == "/assets/licences.txt") continue;  // names the homes of the packages
        EXPECT_THAT(external_addresses(text_of(asset)), ::testing::IsEmpty()) << asset.path;
    }
}

TEST(Assets, TheLicencesOfWhatIsBundledGoWithIt) {
    const Asset* licences = find_asset("/assets/licences.txt");
    ASSERT_NE(licences, nullptr);
    for (const char* package : {"vega-scenegraph", "vega-interpreter", "d3-scale", "img-comparison-slider"})
        EXPECT_NE(text_of(*licences).find(package), std::string::npos) << package;
}

TEST(Assets, TheLockFileNamesNoHostOfPackages) {
    const std::string lock = file_text(SHADOWBENCH_SOURCE_DIR "/service/web/package-lock.json");
    ASSERT_FALSE(lock.empty());
    EXPECT_EQ(lock.find("\"resolved\""), std::string::npos);
    EXPECT_NE(lock.find("\"integrity\""), std::string::npos);
}

}  // namespace
}  // namespace shadowbench::service

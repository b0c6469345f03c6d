#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(FindFile, TakesTheFirstFolderThatHasIt) {
    const std::filesystem::path folder = test::write_file("a.raw", "1").parent_path();
    std::filesystem::create_directories(folder / "second");
    std::filesystem::copy_file(folder / "a.raw", folder / "second/a.raw",
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(find_file({folder / "none", folder / "second", folder}, "a.raw", ""), folder / "second/a.raw");
    EXPECT_EQ(find_file({folder}, "second/a.raw", ""), folder / "second/a.raw");
    EXPECT_EQ(find_file({}, (folder / "a.raw").string(), ""), folder / "a.raw");
}

TEST(FindFile, ListsTheFoldersWhenThereIsNone) {
    const base::Error error = test::error_of([] { find_file({"/one", "/two"}, "x.vdb", "/scene/objects/0/file"); });
    EXPECT_EQ(error.code(), base::ErrorCode::no_such_file);
    EXPECT_EQ(error.where(), "/scene/objects/0/file");
    EXPECT_THAT(error.message(), AllOf(HasSubstr("x.vdb"), HasSubstr("/one"), HasSubstr("/two")));
}

TEST(FindFile, AFolderIsNoFile) {
    const std::filesystem::path folder = test::fresh_path("x").parent_path();
    EXPECT_EQ(test::error_of([&] { find_file({folder.parent_path()}, folder.filename().string(), ""); }).code(),
              base::ErrorCode::no_such_file);
}

// Scenarios from strangers: a folder "data" with files, and beside it a file that they must not reach.
class ConfinedPath : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directories(top_ / "data/sub");
        for (const char* name : {"data/a.raw", "data/sub/b.raw", "secret.raw"}) std::ofstream(top_ / name) << "1";
    }
    void TearDown() override { std::filesystem::remove_all(top_); }

    void refused(const std::string& name, base::ErrorCode code = base::ErrorCode::bad_input) const {
        const base::Error error = test::error_of([&] { find_file(path_, name, "/scene/objects/0/file"); });
        EXPECT_EQ(error.code(), code) << name;
        EXPECT_EQ(error.where(), "/scene/objects/0/file") << name;
        EXPECT_THAT(error.message(), testing::Not(HasSubstr(top_.parent_path().string() + "/"))) << name;
    }

    const std::filesystem::path top_ = test::fresh_path("confined");
    const SearchPath path_ = SearchPath::confined_to({top_ / "none", top_ / "data"});
};

TEST_F(ConfinedPath, GivesTheFilesOfItsFolders) {
    EXPECT_EQ(find_file(path_, "a.raw", ""), top_ / "data/a.raw");
    EXPECT_EQ(find_file(path_, "sub/b.raw", ""), top_ / "data/sub/b.raw");
}

TEST_F(ConfinedPath, RefusesEveryWayOut) {
    refused("../secret.raw");
    refused("sub/../a.raw");
    refused("sub/../../secret.raw");
    refused("..");
    refused(std::string("a.raw\0", 6));
}

TEST_F(ConfinedPath, RefusesAbsoluteNamesAlsoOfItsOwnFiles) {
    const std::filesystem::path own = top_ / "data/a.raw";
    EXPECT_EQ(test::error_of([&] { find_file(path_, own.string(), ""); }).code(), base::ErrorCode::bad_input);
    refused("/etc/hostname");
    const auto said = [&](const std::string& name) {
        return test::error_of([&] { find_file(path_, name, ""); }).message();
    };
    EXPECT_THAT(said((top_ / "data/sub/b.raw").string()), HasSubstr("the name is absolute"));
    EXPECT_THAT(said((top_ / "data/sub/b.raw").string()), HasSubstr("write \"sub/b.raw\""));
    EXPECT_THAT(said("/etc/hostname"), HasSubstr("put the file into one of them"));
}

TEST_F(ConfinedPath, RefusesLinksThatLeadOut) {
    std::filesystem::create_symlink(top_ / "secret.raw", top_ / "data/link.raw");
    std::filesystem::create_directory_symlink(top_, top_ / "data/up");
    refused("link.raw");
    refused("up/secret.raw");
    std::filesystem::create_symlink("a.raw", top_ / "data/inner.raw");
    EXPECT_EQ(find_file(path_, "inner.raw", ""), top_ / "data/inner.raw");
}

TEST_F(ConfinedPath, HidesItsFolders) {
    refused("no.raw", base::ErrorCode::no_such_file);
}

TEST_F(ConfinedPath, AFolderBesideWhoseNameBeginsTheSameIsOutside) {
    std::filesystem::create_directories(top_ / "data2");
    std::ofstream(top_ / "data2/c.raw") << "1";
    std::filesystem::create_symlink(top_ / "data2/c.raw", top_ / "data/c.raw");
    refused("c.raw");
}

}  // namespace
}  // namespace shadowbench::scene

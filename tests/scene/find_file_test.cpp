#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace shadowbench::scene

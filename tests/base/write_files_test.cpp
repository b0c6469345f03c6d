#include "base/write_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "errors.h"
#include "temporary_folder.h"

namespace shadowbench::base {
namespace {

namespace fs = std::filesystem;

class WriteFiles : public ::testing::Test {
protected:
    std::string read(const fs::path& file) const {
        std::ifstream stream(file);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder_), {}));
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

TEST_F(WriteFiles, makes_folders_and_replaces_what_was_there) {
    write_files({{folder_ / "a/b/one", "old"}});
    write_files({{folder_ / "a/b/one", "new"}, {folder_ / "a/b/two", "second"}});
    EXPECT_EQ(read(folder_ / "a/b/one"), "new");
    EXPECT_EQ(read(folder_ / "a/b/two"), "second");
    EXPECT_EQ(entries(), 4u) << "no temporary file stays";
}

TEST_F(WriteFiles, leaves_nothing_behind_when_one_of_them_cannot_be_written) {
    write_files({{folder_ / "one", "old"}, {folder_ / "file", ""}});
    const fs::path below = folder_ / "file/two";
    EXPECT_THROW(write_files({{folder_ / "one", "new"}, {folder_ / "made/three", "x"}, {below, "x"}}), Error);
    EXPECT_EQ(read(folder_ / "one"), "old");
    EXPECT_EQ(entries(), 2u);
}

TEST_F(WriteFiles, refuses_a_folder_in_a_files_place_before_replacing_others) {
    write_files({{folder_ / "one", "old"}, {folder_ / "two/inside", ""}});
    test::error_of(
        [&] {
            write_files({{folder_ / "one", "new"}, {folder_ / "two", "x"}});
        },
        ErrorCode::io, (folder_ / "two").string());
    EXPECT_EQ(read(folder_ / "one"), "old");
}

TEST_F(WriteFiles, reports_why_and_how_much_there_was_to_write) {
    const auto fault_of = [](const std::vector<NewFile>& files) {
        try {
            write_files(files);
        } catch (const WriteError& error) {
            return error;
        }
        ADD_FAILURE();
        return WriteError("", "", {});
    };
    const std::string long_name(300, 'x');
    const WriteError error = fault_of({{folder_ / "one", std::string(5000, 'x')}, {folder_ / long_name, "x"}});
    EXPECT_EQ(error.why(), std::errc::filename_too_long) << error.what();
    EXPECT_EQ(error.bytes(), 3u * 4096);
    write_files({{folder_ / "file", ""}});
    EXPECT_TRUE(fault_of({{folder_ / "file/sub/one", "x"}}).why());
    const WriteError full = fault_of({{"/dev/full/one", ""}});
    EXPECT_EQ(full.code(), ErrorCode::io);
}

TEST_F(WriteFiles, reports_beforehand_that_a_folder_cannot_be_made) {
    write_files({{folder_ / "file", ""}});
    Undo undo;
    test::error_of([&] { make_writable(folder_ / "file/sub", undo); }, ErrorCode::io, (folder_ / "file/sub").string());
    EXPECT_THROW(make_writable("/proc", undo), Error) << "it exists, but even root cannot write files in it";
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteFiles, makes_the_folder_beforehand_and_takes_it_away_unless_kept) {
    {
        Undo undo;
        make_writable(folder_ / "not/yet/there", undo);
        EXPECT_EQ(entries(), 3u) << "the folders, no file";
    }
    EXPECT_EQ(entries(), 0u);
    Undo undo;
    make_writable(folder_ / "kept", undo);
    undo.keep();
    EXPECT_EQ(entries(), 1u);
}

}  // namespace
}  // namespace shadowbench::base

#include "curves/functions_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "cases.h"
#include "temporary_folder.h"

namespace shadowbench::curves {
namespace {

using base::Error;
using base::ErrorCode;
using testing::EndsWith;
using testing::HasSubstr;

struct Folder : TemporaryFolder {
    std::filesystem::path file() const { return path() / "functions.txt"; }
    std::ptrdiff_t entries() const {
        return std::distance(std::filesystem::directory_iterator(path()), std::filesystem::directory_iterator());
    }
};

std::vector<Curve> read(const std::string& text) {
    Folder folder;
    std::ofstream(folder.file(), std::ios::binary) << text;
    return read_functions(folder.file());
}

void expect_refused(const std::string& text, int line, const std::string& message) {
    try {
        read(text);
        ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_input);
        EXPECT_THAT(error.where(), EndsWith("functions.txt:" + std::to_string(line)));
        EXPECT_THAT(error.message(), HasSubstr(message));
    }
}

TEST(FunctionsFile, ReadsRecordsAndSkipsCommentsAndEmptyLines) {
    const auto functions = read("# two functions\n\n2\n1 1\r\n\n# wall\n1 0.5\n0\n1\n -3.5e-2\t0.25 \n");
    ASSERT_EQ(functions.size(), 3u);
    EXPECT_EQ(functions[0], (Curve{{1, 1}, {1, 0.5f}}));
    EXPECT_TRUE(functions[1].empty());
    EXPECT_EQ(functions[2], (Curve{{-0.035f, 0.25f}}));
    EXPECT_TRUE(read("").empty());
    EXPECT_EQ(read("1\n0 1").size(), 1u) << "the last line may lack its end";
    EXPECT_EQ(read("\xef\xbb\xbf"
                   "1\n0 1\n")
                  .size(),
              1u)
        << "editors write a byte-order mark";
}

TEST(FunctionsFile, SaysWhereAndWhatIsWrong) {
    expect_refused("two\n", 1, "number of vertices");
    expect_refused("-1\n", 1, "number of vertices");
    expect_refused("2 3\n", 1, "number of vertices");
    expect_refused("2\n1 1\n# end\n", 3, "the header states 2 vertices, but only 1 follow");
    expect_refused("99999999999\n1 1\n", 1, "only");  // refused before memory is taken for it
    expect_refused("99999999999999999999999\n1 1\n", 1, "number of vertices");
    expect_refused("1\n1\n", 2, "two numbers");
    expect_refused("1\n1 1 1\n", 2, "two numbers");
    expect_refused("1\n1 one\n", 2, "two numbers");
    expect_refused("1\n1,5 1\n", 2, "two numbers");
    expect_refused("1\n1e99 1\n", 2, "two numbers");
    expect_refused("1\n1e39 1\n", 2, "two numbers");
    expect_refused("1\n0x1p3 1\n", 2, "two numbers");
    expect_refused("1\n2e18 1\n", 2, "beyond 1e+18");  // the difference of two such depths may overflow a float
    expect_refused("1\n-3e38 1\n", 2, "beyond 1e+18");
    expect_refused("1\ninf 1\n", 2, "not finite");
    expect_refused("1\nnan 1\n", 2, "not finite");
    expect_refused("1\n1 nan\n", 2, "outside [0, 1]");
    expect_refused("1\n1 1.5\n", 2, "outside [0, 1]");
    expect_refused("1\n1 -0.5\n", 2, "outside [0, 1]");
    expect_refused("2\n2 1\n1 0.5\n", 3, "depth decreases from 2 to 1");
    expect_refused("2\n1 0.5\n2 0.75\n", 3, "transmittance rises from 0.5 to 0.75");
}

TEST(FunctionsFile, TakesNumbersTooSmallForAFloatAsZero) {
    EXPECT_EQ(read("3\n-1e-50 1\n1e-400 1e-42\n3 1e-50\n"), (std::vector<Curve>{{{0, 1}, {0, 1e-42f}, {3, 0}}}));
    expect_refused("1\n-1e400 1\n", 2, "two numbers");
}

TEST(FunctionsFile, ShowsNoBytesOfABinaryFile) {
    expect_refused(
        "\x7f"
        "E\x1b[2J\xff\n",
        1, "found `?E?[2J?`");
    expect_refused(std::string(1000, '\x01'), 1, std::string(60, '?') + "...`");
}

TEST(FunctionsFile, DistinguishesAMissingFileFromOneThatCannotBeRead) {
    const Folder folder;
    try {
        read_functions(folder.file());
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::no_such_file);
    }
    try {
        read_functions(folder.file().parent_path());
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::io);
    }
}

TEST(FunctionsFile, ReadsBackTheSameFloats) {
    base::Random random(1);
    std::vector<Curve> functions(10'000);
    for (Curve& function : functions) {
        function = cases::adversarial_function(0.01f, random);
        std::erase_if(function, [](const Vertex& v) { return std::abs(v.z) > 1e18f; });  // beyond what a file may hold
    }
    const Folder folder;
    write_functions(folder.file(), functions);
    EXPECT_TRUE(read_functions(folder.file()) == functions);
}

// A reader must never see half a file, and a failed write must not leave its temporary file.
TEST(FunctionsFile, ReplacesTheFileAsAWhole) {
    const Folder folder;
    write_functions(folder.file(), {{{1, 1}}, {{2, 0.1f}}});
    write_functions(folder.file(), {{{3, 0.5f}}});
    EXPECT_EQ(read_functions(folder.file()), (std::vector<Curve>{{{3, 0.5f}}}));
    EXPECT_EQ(folder.entries(), 1);

    std::filesystem::create_directories(folder.file().parent_path() / "folder" / "not empty");
    EXPECT_THROW(write_functions(folder.file().parent_path() / "folder", {}), Error);
    EXPECT_THROW(write_functions(folder.file().parent_path() / "none" / "x", {}), Error);
    EXPECT_EQ(folder.entries(), 2);
}

}  // namespace
}  // namespace shadowbench::curves

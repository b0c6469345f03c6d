#include "base/read_text.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "errors.h"
#include "temporary_folder.h"

namespace shadowbench::base {
namespace {

class ReadText : public ::testing::Test {
protected:
    const TemporaryFolder temporary;
    const std::filesystem::path folder = temporary.path();
};

TEST_F(ReadText, EveryByteComesBack) {
    const auto file = folder / "text";
    const std::string bytes("a\r\n\0\xff b", 8);
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(read_text(file), bytes);
    std::ofstream(file, std::ios::trunc).flush();
    EXPECT_EQ(read_text(file), "");
}

TEST_F(ReadText, TextComesWithoutTheMarkThatEditorsWrite) {
    const auto file = folder / "text";
    std::ofstream(file, std::ios::binary) << "\xef\xbb\xbf"
                                             "text";
    EXPECT_EQ(read_text(file), "text");
    EXPECT_EQ(read_bytes(file),
              "\xef\xbb\xbf"
              "text");
}

TEST_F(ReadText, OtherEncodingsAreRefused) {
    const auto file = folder / "text";
    std::ofstream(file, std::ios::binary) << std::string("\xff\xfet\0e\0", 6);
    try {
        read_text(file);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_input);
        EXPECT_EQ(error.where(), file.string());
        EXPECT_NE(error.message().find("UTF-8"), std::string::npos);
    }
}

TEST_F(ReadText, AFailedReadIsAFaultOfTheStorage) {
    // Address 0 of this process cannot be read.
    test::error_of([] { read_bytes("/proc/self/mem"); }, ErrorCode::io, "/proc/self/mem");
}

TEST_F(ReadText, FoldersAndMissingFilesGiveDifferentErrors) {
    const auto code = [](const std::filesystem::path& file) {
        try {
            read_text(file);
        } catch (const Error& error) {
            EXPECT_EQ(error.where(), file.string());
            return error.code();
        }
        return ErrorCode::internal;
    };
    EXPECT_EQ(code(folder), ErrorCode::io);
    EXPECT_EQ(code(folder / "there/is/nothing"), ErrorCode::no_such_file);
}

}  // namespace
}  // namespace shadowbench::base

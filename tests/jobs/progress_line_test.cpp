#include "service/jobs/progress_line.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

std::optional<JobProgress> progress_of(std::string_view line) {
    const auto read = read_line(line);
    const auto* progress = std::get_if<JobProgress>(&read);
    return progress ? std::optional(*progress) : std::nullopt;
}

std::optional<JobFault> fault_of(std::string_view line) {
    const auto read = read_line(line);
    const auto* fault = std::get_if<JobFault>(&read);
    return fault ? std::optional(*fault) : std::nullopt;
}

TEST(ProgressLines, AreReadAsTheyWereWritten) {
    const std::string line = progress_line({"1/3 \"key\"\n", "capture", 3, 16}, 0.25);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto progress = progress_of(line);
    ASSERT_TRUE(progress);
    EXPECT_EQ(progress->stage, "capture");
    EXPECT_EQ(progress->place, "1/3 \"key\" ") << "printable";
    EXPECT_EQ(progress->done, 3u);
    EXPECT_EQ(progress->total, 16u);
    EXPECT_EQ(progress->fraction, 0.25);
}

TEST(ProgressLines, TellFaultsAsTheyWereThrown) {
    const auto fault = fault_of(error_line({base::ErrorCode::bad_input, "/lights/0", "no \xff such light"}));
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->code, 65);
    EXPECT_EQ(fault->where, "/lights/0");
    EXPECT_EQ(fault->message, "no ? such light");
}

TEST(ProgressLines, TellFaultsOfTheStorageFromThoseOfTheJob) {
    const auto read = read_line(storage_line({"/state/work: no space left", 4096}));
    const auto* fault = std::get_if<StorageFault>(&read);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->message, "/state/work: no space left");
    EXPECT_EQ(fault->bytes, 4096u);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(read_line(R"({"storage":3})")));
}

TEST(ProgressLines, AreNothingWhereTheyAreGarbage) {
    for (const std::string& line :
         {std::string(""), std::string("hello"), std::string("{"), std::string("[1]"), std::string("null"),
          std::string("{\"x\":1}"), std::string("\xff\xfe"), std::string("{\"stage\":"), std::string("{\"error\":3}"),
          std::string(4000, '['), std::string("{\"error\":{\"a\":1}} x")})
        EXPECT_TRUE(std::holds_alternative<std::monostate>(read_line(line))) << line;
}

TEST(ProgressLines, KeepTheirNumbersInRange) {
    EXPECT_EQ(progress_of(R"({"stage":"a","fraction":7,"done":-1,"total":"x"})")->fraction, 1.0);
    EXPECT_EQ(progress_of(R"({"stage":"a","fraction":-7,"done":-1,"total":"x"})")->done, 0u);
    EXPECT_EQ(progress_of(R"({"stage":"a","fraction":"1"})")->fraction, 0.0);
    EXPECT_EQ(progress_of(R"({"stage":5})")->stage, "");
    EXPECT_EQ(fault_of(R"({"error":{"code":12,"message":"m"}})")->code, 70) << "a code that is none";
}

}  // namespace
}  // namespace shadowbench::service

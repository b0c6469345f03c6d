#include "service/log/log.h"

#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <sstream>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

std::vector<std::string> lines_of(const std::ostringstream& out) {
    std::vector<std::string> lines;
    std::istringstream in(out.str());
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

const LogEvent request{
    LogLevel::info, "request", "", {{"status", std::int64_t{200}}, {"path", "/v1/jobs"}, {"seconds", 0.25}}};

TEST(Logs, WriteALineOfTextAnEvent) {
    std::ostringstream out;
    make_log(out, LogFormat::text, LogLevel::info)(request);
    const std::regex form(
        R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z info request status=200 path=/v1/jobs seconds=0\.25\n)");
    EXPECT_TRUE(std::regex_match(out.str(), form)) << out.str();
}

TEST(Logs, WriteALineOfJsonAnEvent) {
    std::ostringstream out;
    make_log(out, LogFormat::json, LogLevel::info)(request);
    const nlohmann::json line = nlohmann::json::parse(out.str());
    EXPECT_EQ(line["level"], "info");
    EXPECT_EQ(line["event"], "request");
    EXPECT_EQ(line["status"], 200);
    EXPECT_EQ(line["path"], "/v1/jobs");
    EXPECT_EQ(line["seconds"], 0.25);
    EXPECT_EQ(line["time"].get<std::string>().size(), 24u);
}

// A path with a line break must not forge a line, nor an escape sequence reach the terminal of the operator.
TEST(Logs, LetNoValueForgeALine) {
    for (const LogFormat format : {LogFormat::text, LogFormat::json}) {
        std::ostringstream out;
        const Log log = make_log(out, format, LogLevel::info);
        const std::string evil = "a\n2026-01-01T00:00:00.000Z error forged \x1b[2J \"x\" \xff %v {}";
        log({LogLevel::warning, "request", evil, {{"path", evil}}});
        ASSERT_EQ(lines_of(out).size(), 1u) << out.str();
        EXPECT_EQ(out.str().find('\x1b'), std::string::npos);
        EXPECT_NE(out.str().find("%v {}"), std::string::npos) << "taken as it is, not as a pattern";
        if (format == LogFormat::json) {
            EXPECT_TRUE(nlohmann::json::accept(out.str())) << out.str();
        }
    }
}

TEST(Logs, KeepNumbersThatJsonDoesNotKnowValid) {
    std::ostringstream out;
    make_log(out, LogFormat::json,
             LogLevel::info)({LogLevel::info, "job", "", {{"seconds", std::numeric_limits<double>::infinity()}}});
    EXPECT_TRUE(nlohmann::json::accept(out.str())) << out.str();
}

TEST(Logs, LeaveOutWhatIsBelowTheirLevel) {
    std::ostringstream out;
    const Log log = make_log(out, LogFormat::text, LogLevel::warning);
    for (const LogLevel level : {LogLevel::debug, LogLevel::info, LogLevel::warning, LogLevel::error})
        log({level, "job", ""});
    ASSERT_EQ(lines_of(out).size(), 2u);
    EXPECT_NE(lines_of(out)[0].find(" warning job"), std::string::npos);
    EXPECT_NE(lines_of(out)[1].find(" error job"), std::string::npos);
}

TEST(Logs, OfManyThreadsDoNotMix) {
    std::ostringstream out;
    const Log log = make_log(out, LogFormat::json, LogLevel::info);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int k = 0; k < 100; ++k) log(request);
        });
    for (std::thread& thread : threads) thread.join();
    const auto lines = lines_of(out);
    EXPECT_EQ(lines.size(), 400u);
    for (const std::string& line : lines) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
}

}  // namespace
}  // namespace shadowbench::service

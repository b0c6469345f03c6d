// What an operator runs and writes: the file of tokens, back-ups and checks, and the word to systemd.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/error.h"
#include "service/cli/notify.h"
#include "service/cli/token_file.h"
#include "service/jobs/jobs.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

class Operate : public testing::Test {
protected:
    std::string write(const std::string& name, const std::string& text) const {
        const fs::path file = folder_.path() / name;
        std::ofstream(file) << text;
        fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
        return file.string();
    }
    // The place of the fault of a file of tokens.
    std::string fault_of(const std::string& text) const {
        const std::string file = write("tokens", text);
        try {
            read_tokens(file);
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
            return error.where().substr(file.size());
        }
        return "none";
    }
    const TemporaryFolder folder_;
};

TEST_F(Operate, TokensHaveNamesAndLimits) {
    const auto tokens = read_tokens(write("tokens",
                                          "# who token limits\n"
                                          "ann 0123456789abcdef queued=5 running=1 bytes=2G\r\n"
                                          "\n"
                                          "  bo\tfedcba9876543210 bytes=10\n"));
    ASSERT_EQ(tokens.size(), 2u);
    EXPECT_EQ(tokens[0].name, "ann");
    EXPECT_EQ(tokens[0].token, "0123456789abcdef");
    EXPECT_EQ(tokens[0].limits.queued, 5u);
    EXPECT_EQ(tokens[0].limits.running, 1u);
    EXPECT_EQ(tokens[0].limits.bytes, std::uint64_t{2} << 30);
    EXPECT_EQ(tokens[1].name, "bo");
    EXPECT_FALSE(tokens[1].limits.queued);
    EXPECT_EQ(tokens[1].limits.bytes, 10u);
}

TEST_F(Operate, FaultsOfTokensHaveTheirLine) {
    EXPECT_EQ(fault_of("# none\n"), "");
    EXPECT_EQ(fault_of("a 0123456789abcdef\nb short\n"), ":2");
    EXPECT_EQ(fault_of("a 0123456789abcdef\na fedcba9876543210\n"), ":2") << "two of one name";
    EXPECT_EQ(fault_of("a 0123456789abcdef\n\nb 0123456789abcdef\n"), ":3") << "nobody's jobs can be told apart";
    for (const char* limit : {"queue=1", "queued", "queued=", "queued=-1", "queued=1M", "bytes=1X",
                              "bytes=99999999999999999999", "bytes=99999999999999T", "0123456789abcdef"})
        EXPECT_EQ(fault_of("a 0123456789abcdef " + std::string(limit) + "\n"), ":1") << limit;
    EXPECT_EQ(fault_of("a/b 0123456789abcdef\n"), ":1");
    EXPECT_EQ(fault_of("\v\f\na 0123456789abcdef\n"), "none") << "an empty line";
}

// A name of two words makes the token the third one: it must not come to the terminal or a log.
TEST_F(Operate, FaultsOfTokensDoNotShowThem) {
    try {
        read_tokens(write("tokens", "ann from-next-door-here s3cret-s3cret-s3cret\n"));
        ADD_FAILURE();
    } catch (const base::Error& error) {
        EXPECT_EQ(std::string(error.what()).find("s3cret"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("word 3"), std::string::npos) << error.what();
    }
}

TEST_F(Operate, BackUpAndCheckAreCommands) {
    const std::string state = (folder_.path() / "state").string(), copy = (folder_.path() / "copy").string();
    EXPECT_EQ(cli({"serve", "fsck", "--state", state}).code, 74);
    { Jobs jobs(state, "/bin/true", {}, {}); }
    const Outcome backup = cli({"serve", "backup", copy, "--state", state});
    EXPECT_EQ(backup.code, 0) << backup.err;
    EXPECT_EQ(backup.out, copy + ": 0 jobs\n");
    EXPECT_EQ(cli({"serve", "backup", copy, "--state", state}).code, 64) << "it is there already";
    EXPECT_EQ(cli({"serve", "fsck", "--state", copy}).out, copy + ": no faults\n");
    EXPECT_EQ(cli({"serve", "--state", copy, "fsck"}).out, copy + ": no faults\n") << "not those of another folder";
    fs::create_directories(fs::path(copy) / "jobs" / "mine");
    const Outcome found = cli({"serve", "fsck", "--state", copy});
    EXPECT_EQ(found.code, 65);
    EXPECT_NE(found.out.find("jobs/mine: "), std::string::npos) << found.out;
    EXPECT_NE(found.err.find("1 fault found"), std::string::npos) << found.err;
}

TEST_F(Operate, SubmitRefusesWhatNoTryMends) {
    const std::string scenario = write("tiny.json", "{}");
    // Not tried again for 60 s: the test would run into its limit.
    EXPECT_EQ(cli({"submit", scenario, "--wait", "--server", "localhost:1"}).code, 64);
    EXPECT_EQ(cli({"submit", scenario, "--wait", "--server", "http://localhost/a/../b"}).code, 64);
    EXPECT_EQ(cli({"submit", scenario, "--wait", "--server", "http://a..b"}).code, 64) << "there is no such host";
    EXPECT_EQ(cli({"submit", scenario, "--cacert", "none"}).code, 64);
    EXPECT_EQ(cli({"submit", scenario, "--priority", "101"}).code, 64);
}

TEST_F(Operate, SaysToSystemdThatItIsReady) {
    const std::string place = (folder_.path() / "n").string();
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    ASSERT_LT(place.size(), sizeof address.sun_path);
    place.copy(address.sun_path, place.size());
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", place.c_str(), 1);
    notify_manager("READY=1");
    ::unsetenv("NOTIFY_SOCKET");
    notify_manager("STOPPING=1");  // nobody listens
    char text[64];
    const ssize_t size = ::recv(socket, text, sizeof text, 0);
    ASSERT_GT(size, 0);
    EXPECT_EQ(std::string(text, static_cast<std::size_t>(size)), "READY=1");
    EXPECT_LT(::recv(socket, text, sizeof text, 0), 0);
    ::close(socket);
}

}  // namespace
}  // namespace shadowbench::service

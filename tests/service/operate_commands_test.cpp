// What an operator runs and writes: the file of tokens, back-ups and checks, and what systemd runs and hears.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
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

// The socket of a manager such as systemd, which processes find in their environment.
class Manager {
public:
    explicit Manager(const std::string& place) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        EXPECT_LT(place.size(), sizeof address.sun_path);
        place.copy(address.sun_path, sizeof address.sun_path - 1);
        EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        const timeval patience{60, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setenv("NOTIFY_SOCKET", place.c_str(), 1);
    }
    ~Manager() {
        ::unsetenv("NOTIFY_SOCKET");
        ::close(socket_);
    }
    Manager(const Manager&) = delete;
    Manager& operator=(const Manager&) = delete;

    // The next message, or an empty text.
    std::string hears(int flags = 0) const {
        char text[256];
        const ssize_t size = ::recv(socket_, text, sizeof text, flags);
        return {text, static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
    }

private:
    int socket_;
};

// What follows `key` in the line of a file of service/systemd that begins with it.
std::string setting(const std::string& file, const std::string& key) {
    std::ifstream stream(SHADOWBENCH_SOURCE_DIR "/service/systemd/" + file);
    for (std::string line; std::getline(stream, line);)
        if (line.rfind(key, 0) == 0) return line.substr(key.size());
    ADD_FAILURE() << file << " has no line that begins with " << key;
    return {};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

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
    const Manager manager((folder_.path() / "n").string());
    notify_manager("READY=1");
    ::unsetenv("NOTIFY_SOCKET");
    notify_manager("STOPPING=1");  // nobody listens
    EXPECT_EQ(manager.hears(), "READY=1");
    EXPECT_EQ(manager.hears(MSG_DONTWAIT), "");
}

// The words of the unit, with the drop-in for tokens, and what systemd makes of them: with DynamicUser= the state
// folder is behind a link. Else a renamed option, or a credential that is refused, would show only on a user's machine.
TEST_F(Operate, TheUnitOfSystemdStartsAndStopsTheServer) {
    const std::string folder = folder_.path().string(), credentials = folder + "/credentials";
    fs::create_directories(folder + "/private/shadowbench");
    fs::create_directory_symlink("private/shadowbench", folder + "/shadowbench");
    fs::create_directory(credentials);
    fs::permissions(write("credentials/tokens", "ann 0123456789abcdef\n"),
                    fs::perms::owner_read | fs::perms::group_read);
    const std::string tokens = setting("tokens.conf", "Environment=\"SHADOWBENCH_TOKENS=");
    std::string command = setting("shadowbench.service.in", "ExecStart=");
    command = replaced(command, "$SHADOWBENCH_TOKENS", tokens.substr(0, tokens.size() - 1));
    command = replaced(command, "$SHADOWBENCH_OPTIONS", "--host 127.0.0.2 --port 0 --grace 7 --log-level warning");
    command = replaced(replaced(command, "@PROGRAM@", SHADOWBENCH_PROGRAM), "%S", folder);
    std::istringstream stream(replaced(command, "%d", credentials));
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    const Manager manager(folder + "/n");
    ::setenv("CREDENTIALS_DIRECTORY", credentials.c_str(), 1);
    const pid_t server = ::fork();
    if (server == 0) {
        ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), 1);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ::unsetenv("CREDENTIALS_DIRECTORY");
    ASSERT_GT(server, 0);
    EXPECT_EQ(manager.hears(), "READY=1") << command;
    EXPECT_TRUE(fs::exists(folder + "/private/shadowbench/jobs.db"));
    ::kill(server, SIGTERM);
    // Else systemd would kill the server before a --grace above TimeoutStopSec= is over.
    EXPECT_EQ(manager.hears(), "STOPPING=1\nEXTEND_TIMEOUT_USEC=37000000");
    int status = -1;
    ::waitpid(server, &status, 0);
    EXPECT_EQ(status, 0);
}

TEST_F(Operate, OnlyACredentialOfSystemdMayHaveRightsOfAGroup) {
    const fs::path file = write("tokens", "0123456789abcdef\n");
    const auto refused = [&](fs::perms more, const fs::path& credentials) {
        fs::permissions(file, fs::perms::owner_read | more);
        ::setenv("CREDENTIALS_DIRECTORY", credentials.c_str(), 1);
        bool thrown = false;
        try {
            read_tokens(file);
        } catch (const base::Error&) {
            thrown = true;
        }
        ::unsetenv("CREDENTIALS_DIRECTORY");
        return thrown;
    };
    EXPECT_FALSE(refused(fs::perms::group_read, folder_.path()));
    EXPECT_TRUE(refused(fs::perms::group_read, folder_.path() / "other"));
    EXPECT_TRUE(refused(fs::perms::others_read, folder_.path()));
}

}  // namespace
}  // namespace shadowbench::service

// A command that gets a signal while its child runs leaves no process and no file behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "processes.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

class Interrupt : public ::testing::Test {
protected:
    void SetUp() override {
        // A build that never ends, behind a shell that would not pass a signal on.
        std::ofstream(path("build")) << "#!/bin/sh\necho $$ > " << path("shell") << "\nsleep 1000 &\necho $! > "
                                     << path("made") << "\nmv " << path("made") << " " << path("sleeper") << "\nwait\n";
        fs::permissions(path("build"), fs::perms::owner_all);
        fs::create_directory(path("tmp"));
    }

    std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

    // `ab` as a process, once its child runs; 0 where that does not come to be.
    pid_t start(bool without_hangup) {
        const pid_t ab = ::fork();
        if (ab == 0) {
            ::setenv("TMPDIR", path("tmp").c_str(), 1);
            // Whoever runs the tests may ignore some, as nohup does.
            for (const int signal : {SIGHUP, SIGINT, SIGTERM}) ::signal(signal, SIG_DFL);
            if (without_hangup) ::signal(SIGHUP, SIG_IGN);
            ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), 2);
            const std::string build = path("build");
            ::execl(SHADOWBENCH_PROGRAM, "shadowbench", "ab", build.c_str(), build.c_str(), "--kernels", ".", nullptr);
            ::_exit(127);
        }
        if (!soon([&] { return fs::exists(path("sleeper")); })) return 0;
        std::ifstream(path("sleeper")) >> sleeper_;
        return ab;
    }

    bool sleeps() const { return lives(sleeper_); }

    const TemporaryFolder folder_;
    pid_t sleeper_ = 0, shell_ = 0;
};

TEST_F(Interrupt, LeavesNothingBehind) {
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        const pid_t ab = start(false);
        ASSERT_GT(ab, 0);
        EXPECT_FALSE(fs::is_empty(path("tmp"))) << "else there was nothing to leave";
        EXPECT_TRUE(sleeps());
        ::kill(ab, signal);
        int status = 0;
        ASSERT_EQ(::waitpid(ab, &status, 0), ab);
        EXPECT_TRUE(WIFSIGNALED(status)) << "its caller sees the signal";
        EXPECT_EQ(WTERMSIG(status), signal);
        EXPECT_TRUE(soon([&] { return !sleeps(); }));
        EXPECT_TRUE(fs::is_empty(path("tmp")));
        fs::remove(path("sleeper"));
    }
}

// Which no program can see coming: its files stay, its processes do not.
TEST_F(Interrupt, LeavesNoProcessWhenItIsKilled) {
    const pid_t ab = start(false);
    ASSERT_GT(ab, 0);
    std::ifstream(path("shell")) >> shell_;
    EXPECT_TRUE(lives(sleeper_));
    EXPECT_TRUE(lives(shell_));
    ::kill(ab, SIGKILL);
    ASSERT_EQ(::waitpid(ab, nullptr, 0), ab);
    EXPECT_TRUE(soon([&] { return !lives(shell_); }));
    EXPECT_TRUE(soon([&] { return !lives(sleeper_); }));
}

TEST_F(Interrupt, AnIgnoredSignalStaysIgnored) {
    const pid_t ab = start(true);
    ASSERT_GT(ab, 0);
    ::kill(ab, SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_TRUE(sleeps());
    ::kill(ab, SIGTERM);
    int status = 0;
    ASSERT_EQ(::waitpid(ab, &status, 0), ab);
    EXPECT_EQ(WTERMSIG(status), SIGTERM) << "not SIGHUP";
}

}  // namespace
}  // namespace shadowbench::service

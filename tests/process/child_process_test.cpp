#include "service/process/child_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/read_text.h"
#include "processes.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Children : public ::testing::Test {
protected:
    std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
    // "echo NUMBER >name", so that the file is there with its content or not at all.
    std::string note(const std::string& name, const std::string& number) const {
        return "echo " + number + " >" + path(name) + ".new; mv " + path(name) + ".new " + path(name) + "; ";
    }
    pid_t noted(const std::string& name) const {
        EXPECT_TRUE(soon([&] { return fs::exists(path(name)); }));
        pid_t number = 0;
        std::ifstream(path(name)) >> number;
        EXPECT_GT(number, 0);
        return number;
    }

    const TemporaryFolder folder_;
};

// All that it writes to standard output.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments,
                      std::size_t address_space = 0) {
    Pipe out;
    ChildProcess child(program, arguments, {.out = out.write.number()}, address_space);
    out.write.close();
    std::string text;
    char buffer[4096];
    for (ssize_t count; (count = ::read(out.read.number(), buffer, sizeof buffer)) > 0;)
        text.append(buffer, static_cast<std::size_t>(count));
    return text;
}

ChildExit exit_of(const std::string& script) {
    ChildProcess child("/bin/sh", {"-c", script}, {});
    EXPECT_TRUE(soon([&] { return child.has_ended(); }));
    return child.end();
}

TEST_F(Children, SayHowTheyEnded) {
    const ChildExit exit = exit_of("exit 7"), crash = exit_of("kill -SEGV $$");
    EXPECT_FALSE(exit.by_signal);
    EXPECT_EQ(exit.code, 7);
    EXPECT_TRUE(crash.by_signal);
    EXPECT_EQ(crash.code, SIGSEGV);
    ChildProcess endless("/bin/sleep", {"1000"}, {});
    EXPECT_FALSE(endless.has_ended());
    EXPECT_GT(endless.resident(), 0u);
    const ChildExit killed = endless.end();
    EXPECT_TRUE(killed.by_signal);
    EXPECT_EQ(killed.code, SIGKILL);
}

TEST_F(Children, HaveTheDefaultSignals) {
    sigset_t blocked, before;
    ::sigemptyset(&blocked);
    ::sigaddset(&blocked, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &blocked, &before);
    const auto pipe = ::signal(SIGPIPE, SIG_IGN), user = ::signal(SIGUSR1, SIG_IGN);
    const std::string signals = output_of("/bin/grep", {"-E", "Sig(Blk|Ign)", "/proc/self/status"});
    ::signal(SIGPIPE, pipe);
    ::signal(SIGUSR1, user);
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    EXPECT_EQ(signals, "SigBlk:\t0000000000000000\nSigIgn:\t0000000000000000\n");
}

TEST_F(Children, HaveNoDescriptorButTheirStreams) {
    const int open = ::open("/dev/null", O_RDONLY);  // passed on by exec(), unless somebody sees to it
    const int high = ::fcntl(open, F_DUPFD, 500);
    EXPECT_EQ(output_of("/bin/ls", {"/proc/self/fd"}), "0\n1\n2\n3\n") << "the last one is the folder that ls reads";
    ::close(open);
    ::close(high);
}

TEST_F(Children, HaveNothingToReadUnlessTheyAreGivenIt) {
    EXPECT_EQ(output_of("/bin/sh", {"-c", "cat; readlink /proc/self/fd/0 /proc/self/fd/2"}), "/dev/null\n/dev/null\n");
}

// As in a program that was started with closed streams, whose files get their numbers.
TEST_F(Children, TakeTheirStreamsFromAnyDescriptor) {
    std::ofstream(path("in")) << "text";
    const pid_t parent = ::fork();
    if (parent == 0) {
        const int in = ::open(path("in").c_str(), O_RDONLY),
                  out = ::open(path("out").c_str(), O_WRONLY | O_CREAT, 0600);
        ::dup2(in, 1);
        ::dup2(out, 0);
        ::close(2);  // which becomes the line that exec()'s failure is told by
        ChildProcess child("/bin/cat", {}, {.in = 1, .out = 0, .err = 0});
        while (!child.has_ended()) ::usleep(1000);
        ::_exit(child.end().code);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(parent, &status, 0), parent);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(base::read_text(path("out")), "text");
}

TEST_F(Children, ThatCannotBeExecutedAreAnErrorWithTheReason) {
    std::ofstream(path("locked")) << "#!/bin/sh\n";
    std::ofstream(path("garbage")) << "\x7f no program";
    fs::permissions(path("locked"), fs::perms::owner_read);
    fs::permissions(path("garbage"), fs::perms::owner_all);
    for (const auto& [name, reason] : {std::pair("missing", "No such file"), std::pair("locked", "Permission denied"),
                                       std::pair("garbage", "Exec format error")}) {
        try {
            const ChildProcess child(path(name), {}, {});
            ADD_FAILURE() << name << " was started";
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::internal);
            EXPECT_EQ(error.where(), path(name));
            EXPECT_THAT(error.message(), HasSubstr(reason));
        }
    }
    EXPECT_EQ(::waitpid(-1, nullptr, 0), -1) << "nothing is left to wait for";
    EXPECT_EQ(errno, ECHILD);
}

TEST_F(Children, HaveLimits) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    const std::string kib = "unlimited";
#else
    const std::string kib = "1048576";
#endif
    const std::vector<std::string> script{"-c", "ulimit -v; ulimit -c; cat /proc/self/oom_score_adj"};
    EXPECT_EQ(output_of("/bin/sh", script, std::size_t{1} << 30), kib + "\n0\n1000\n");
}

TEST_F(Children, EndWithAllThatTheyStarted) {
    pid_t grandchild = 0;
    {
        const ChildProcess child("/bin/sh", {"-c", "sleep 1000 & " + note("grandchild", "$!") + "wait"}, {});
        grandchild = noted("grandchild");
        EXPECT_NE(::getpgid(grandchild), ::getpgrp());
        EXPECT_TRUE(lives(grandchild));
    }
    EXPECT_TRUE(soon([&] { return !lives(grandchild); }));
}

// With what a child has started, and a child that has put itself into another group.
TEST_F(Children, EndWhenTheirParentIsKilled) {
    const pid_t parent = ::fork();
    if (parent == 0) {
        const ChildProcess shell("/bin/sh",
                                 {"-c", "sleep 1000 & " + note("grandchild", "$!") + note("child", "$$") + "wait"}, {});
        const ChildProcess apart("/bin/sh", {"-c", "exec setsid sh -c '" + note("apart", "$$") + "exec sleep 1000'"},
                                 {});
        for (;;) ::pause();
    }
    const pid_t child = noted("child"), grandchild = noted("grandchild"), apart = noted("apart");
    const pid_t keeper = ::getpgid(child);
    EXPECT_EQ(::getpgid(grandchild), keeper);
    EXPECT_EQ(::getpgid(apart), apart);
    for (const pid_t one : {child, grandchild, apart, keeper}) EXPECT_TRUE(lives(one));
    ::kill(parent, SIGKILL);
    ::waitpid(parent, nullptr, 0);
    for (const pid_t one : {child, grandchild, apart, keeper}) EXPECT_TRUE(soon([&] { return !lives(one); }));
}

// Else what a server holds would be held on after its death, and who reads from it would wait for an end.
TEST_F(Children, AndTheirKeeperHoldNothingOpenOfTheirParent) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const int lock = ::open(path("lock").c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_EQ(::flock(lock, LOCK_EX), 0);
    const ChildProcess child("/bin/sleep", {"1000"}, {});
    ::close(ends[1]);
    ::close(lock);
    char byte;
    EXPECT_EQ(::read(ends[0], &byte, 1), 0);
    const int other = ::open(path("lock").c_str(), O_RDWR);
    EXPECT_TRUE(soon([&] { return ::flock(other, LOCK_EX | LOCK_NB) == 0; }));
    ::close(other);
    ::close(ends[0]);
}

}  // namespace
}  // namespace shadowbench::service

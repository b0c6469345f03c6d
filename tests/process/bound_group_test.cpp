#include "service/process/bound_group.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

// A process that has ended and waits for somebody to ask counts as gone.
bool lives(pid_t process) {
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state;
    return stat >> number >> name >> state && state != "Z" && state != "X";
}

bool soon(const auto& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!holds() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return holds();
}

pid_t start(const BoundGroup& group, const std::string& script) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    group.join();
    ::execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
    ::_exit(127);
}

class BoundGroups : public ::testing::Test {
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

TEST_F(BoundGroups, EndWithAllThatIsInThem) {
    pid_t child = 0, grandchild = 0;
    {
        const BoundGroup group;
        child = start(group, "sleep 1000 & " + note("grandchild", "$!") + "wait");
        grandchild = noted("grandchild");
        EXPECT_EQ(::getpgid(child), group.id());
        EXPECT_EQ(::getpgid(grandchild), group.id());
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
    EXPECT_TRUE(soon([&] { return !lives(grandchild); }));
}

// Also what a child has started, and a child that has put itself into another group.
TEST_F(BoundGroups, EndWhenTheirParentIsKilled) {
    const pid_t parent = ::fork();
    if (parent == 0) {
        const BoundGroup group;
        start(group, "sleep 1000 & " + note("grandchild", "$!") + note("child", "$$") + "wait");
        const pid_t apart = ::fork();
        if (apart == 0) {
            group.join();
            ::setpgid(0, 0);
            const std::string script = note("apart", "$$") + "exec sleep 1000";
            ::execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
        }
        std::ofstream(path("keeper.new")) << group.id();
        fs::rename(path("keeper.new"), path("keeper"));
        for (;;) ::pause();
    }
    const pid_t all[] = {noted("child"), noted("grandchild"), noted("apart"), noted("keeper")};
    for (const pid_t one : all) EXPECT_TRUE(lives(one));
    ::kill(parent, SIGKILL);
    ::waitpid(parent, nullptr, 0);
    for (const pid_t one : all) EXPECT_TRUE(soon([&] { return !lives(one); }));
}

// Else what a server holds would be held on after its death, and who reads from it would wait for an end.
TEST_F(BoundGroups, HoldNothingOpenOfTheirParent) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const int lock = ::open(path("lock").c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_EQ(::flock(lock, LOCK_EX), 0);
    const BoundGroup group;
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

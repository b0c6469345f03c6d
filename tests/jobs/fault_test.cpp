#include "service/jobs/fault.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>

#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

TEST(Faults, NameFilesAsTheClientKnowsThem) {
    const auto folders = hidden_folders("/var/lib/bench", {"/srv/data", "/srv/data/hair/", "/srv/data 2"});
    EXPECT_EQ(hide("/srv/data/hair/ball.tfx:12", folders), "ball.tfx:12");
    EXPECT_EQ(hide("/srv/data/smoke.vdb: cut", folders), "smoke.vdb: cut");
    EXPECT_EQ(hide("looked in: /srv/data, /srv/data/hair", folders), "looked in: the data folder, the data folder");
    EXPECT_EQ(hide("\"/var/lib/bench/work/j-1/result.json\"", folders), "\"work/j-1/result.json\"");
    EXPECT_EQ(hide("/lights/0/angle", folders), "/lights/0/angle");
    EXPECT_EQ(hide("/srv/database and x/srv/data/y", folders), "/srv/database and x/srv/data/y") << "other names";
    EXPECT_EQ(hide("", folders), "");
}

TEST(Faults, HideAFolderHoweverItIsWritten) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "real");
    std::filesystem::create_directory_symlink("real", folder.path() / "link");
    const std::string link = (folder.path() / "link").string();
    const auto folders = hidden_folders("/var/lib/bench", {link});
    EXPECT_EQ(hide(link + "/a.obj", folders), "a.obj");
    EXPECT_EQ(hide((std::filesystem::canonical(folder.path()) / "real/a.obj").string(), folders), "a.obj");
    const std::string relative = std::filesystem::relative(link).string();
    EXPECT_EQ(hide(relative + "/a.obj", hidden_folders("/x", {relative})), "a.obj");
}

TEST(Faults, ShortenPathsThatNobodyExpected) {
    EXPECT_EQ(shorten_paths("at /home/me/src/run.cpp:12 in f (/usr/lib/libc.so)"), "at run.cpp:12 in f (libc.so)");
    EXPECT_EQ(shorten_paths("1/2 / of a/b"), "1/2 / of a/b");
    EXPECT_EQ(shorten_paths("/"), "/");
    EXPECT_EQ(shorten_paths("/home/"), "home/");
}

TEST(Faults, SayWhichLimitWasMet) {
    JobLimits limits;
    limits.seconds = 90;
    limits.memory = std::size_t{3} << 29;
    const JobFault time = fault_of_end({ChildEnd::out_of_time, SIGKILL, "some noise"}, limits);
    EXPECT_EQ(time.code, 65);
    EXPECT_NE(time.message.find("longer than 90 s"), std::string::npos) << time.message;
    EXPECT_EQ(time.message.find("noise"), std::string::npos) << time.message;
    const JobFault memory = fault_of_end({ChildEnd::out_of_memory, SIGKILL, ""}, limits);
    EXPECT_EQ(memory.code, 65);
    EXPECT_NE(memory.message.find("1.5 GiB"), std::string::npos) << memory.message;
    EXPECT_EQ(fault_of_end({ChildEnd::too_much_output, SIGKILL, ""}, limits).code, 70);
}

TEST(Faults, QuoteTheLastWordsOfAProcess) {
    const JobFault fault =
        fault_of_end({ChildEnd::signalled, SIGABRT, "first\nsecond /tmp/x/y.cpp\n\nthird\n  \nlast \x1b[1m\n"}, {});
    EXPECT_EQ(fault.code, 70);
    EXPECT_EQ(fault.message, "the job's process was ended by signal 6 (Aborted): second y.cpp / third / last  [1m");
    EXPECT_EQ(fault_of_end({ChildEnd::exited, 3, ""}, {}).message, "the job's process ended with exit code 3");
    EXPECT_LT(fault_of_end({ChildEnd::exited, 3, std::string(9000, 'x') + "\nend\n"}, {}).message.size(), 600u);
}

}  // namespace
}  // namespace shadowbench::service

#include "service/jobs/fault.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace shadowbench::service {
namespace {

TEST(Faults, SayWhichLimitWasMet) {
    JobLimits limits;
    limits.seconds = 90;
    limits.memory = std::size_t{3} << 29;
    const JobFault time = fault_of_end({ChildEnd::out_of_time, SIGKILL, "some noise"}, limits, {});
    EXPECT_EQ(time.code, 65);
    EXPECT_NE(time.message.find("longer than 90 s"), std::string::npos) << time.message;
    EXPECT_EQ(time.message.find("noise"), std::string::npos) << time.message;
    const JobFault memory = fault_of_end({ChildEnd::out_of_memory, SIGKILL, ""}, limits, {});
    EXPECT_EQ(memory.code, 65);
    EXPECT_NE(memory.message.find("1.5 GiB"), std::string::npos) << memory.message;
    EXPECT_EQ(fault_of_end({ChildEnd::too_much_output, SIGKILL, ""}, limits, {}).code, 70);
}

TEST(Faults, QuoteTheLastWordsOfAProcess) {
    const JobFault fault =
        fault_of_end({ChildEnd::signalled, SIGABRT, "first\nsecond /tmp/x/y.cpp\n\nthird\n  \nlast \x1b[1m\n"}, {}, {});
    EXPECT_EQ(fault.code, 70);
    EXPECT_EQ(fault.message, "the job's process was ended by signal 6 (Aborted): second y.cpp / third / last  [1m");
    EXPECT_EQ(fault_of_end({ChildEnd::exited, 3, ""}, {}, {}).message, "the job's process ended with exit code 3");
    EXPECT_LT(fault_of_end({ChildEnd::exited, 3, std::string(9000, 'x') + "\nend\n"}, {}, {}).message.size(), 600u);
}

TEST(Faults, QuoteNoFolderOfTheServer) {
    const ChildReport report{ChildEnd::exited, 1, "/srv/data/hair/ball.tfx: cut, in /usr/lib/libc.so\n"};
    EXPECT_EQ(fault_of_end(report, {}, hidden_folders("/var/lib/bench", {"/srv/data"})).message,
              "the job's process ended with exit code 1: hair/ball.tfx: cut, in libc.so");
}

}  // namespace
}  // namespace shadowbench::service

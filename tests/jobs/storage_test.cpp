// What becomes of jobs where the disk of their server has little space, or its folder goes. See full_disk_test.cpp too.
#include <chrono>
#include <thread>

#include "base/error.h"
#include "jobs/job_host.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

class JobDisk : public JobHost {};

TEST_F(JobDisk, WaitsForTheFreeSpaceThatItIsToLeave) {
    limits.min_free = std::uint64_t{1} << 62;
    start();
    const std::string id = submit(success);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (said().find("--min-free") == std::string::npos && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(jobs->storage().is_low());
    EXPECT_TRUE(jobs->storage_fails());
    EXPECT_EQ(jobs->find(id)->state, JobState::queued);
    EXPECT_NE(said().find("--min-free"), std::string::npos) << said();
    limits.min_free = 1;
    start();
    EXPECT_EQ(wait_for_end(id).state, JobState::succeeded);
    EXPECT_FALSE(jobs->storage().is_low());
}

// What it writes then would go with the files that were removed.
TEST_F(JobDisk, PromisesNothingWhereItsFolderIsGone) {
    start();
    const JobInfo before = run(success);
    EXPECT_FALSE(jobs->storage().gone);
    const fs::path away = folder.path() / "away";
    fs::rename(state(), away);
    EXPECT_TRUE(jobs->storage().gone);
    EXPECT_THROW(submit(success), base::Error);
    EXPECT_FALSE(fs::exists(state())) << "and makes no other in its place";
    fs::rename(away, state());
    EXPECT_FALSE(jobs->storage().gone) << "it is back";
    EXPECT_EQ(run(success).state, JobState::succeeded);
    EXPECT_EQ(jobs->find(before.id)->state, JobState::succeeded);
}

}  // namespace
}  // namespace shadowbench::service

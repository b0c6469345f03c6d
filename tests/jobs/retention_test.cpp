#include "service/jobs/retention.h"

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/job_host.h"

namespace shadowbench::service {
namespace {

constexpr const char* noon = "2026-11-30T12:00:00.000Z";

std::string chosen(const Retention& keep) {
    const std::vector<JobStore::Ended> jobs{{"a", "2026-11-20T12:00:00.000Z", 500},
                                            {"b", "2026-11-29T11:59:59.000Z", 300},
                                            {"c", "2026-11-29T12:00:01.000Z", 0},
                                            {"d", "2026-11-30T11:00:00.000Z", 200}};
    std::string text;
    for (const Removable& job : choose_removable(jobs, keep, noon)) text += job.id + ":" + job.reason + " ";
    return text;
}

TEST(Retentions, RemoveWhatIsTooOldTooManyOrTooLarge) {
    EXPECT_EQ(chosen({}), "");
    EXPECT_EQ(chosen({1.0, {}, {}}), "a:age b:age ");
    EXPECT_EQ(chosen({{}, 3, {}}), "a:number ");
    EXPECT_EQ(chosen({{}, 0, {}}), "a:number b:number c:number d:number ");
    EXPECT_EQ(chosen({{}, {}, 1000}), "");
    EXPECT_EQ(chosen({{}, {}, 500}), "a:space ") << "500 bytes are left";
    EXPECT_EQ(chosen({{}, {}, 499}), "a:space b:space ");
    EXPECT_EQ(chosen({5.0, 3, 250}), "a:age b:space ") << "a is gone, so three are left";
}

class RetentionHost : public JobHost {
protected:
    std::string ended() const {
        const JobInfo job = run(success);
        EXPECT_EQ(job.state, JobState::succeeded);
        return job.id;
    }
    bool goes(const std::string& id) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (jobs->find(id) && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return !jobs->find(id);
    }
};

TEST_F(RetentionHost, RemovesJobsWithTheirFilesButNoPinnedOne) {
    start();
    const std::string pinned = ended(), first = ended(), last = ended();
    EXPECT_EQ(jobs->pin(pinned, true), Jobs::Change::done);
    EXPECT_EQ(jobs->pin("j-0000000000000000", true), Jobs::Change::not_found);
    EXPECT_GT(jobs->find(first)->bytes, 0u);
    EXPECT_GE(jobs->bytes(), 3 * jobs->find(first)->bytes);
    limits.retention.jobs = 1;
    start();
    EXPECT_TRUE(goes(first));
    EXPECT_FALSE(std::filesystem::exists(state() / "jobs" / first));
    EXPECT_TRUE(jobs->find(pinned)) << "pinned";
    EXPECT_TRUE(jobs->find(last)) << "the latest";
    EXPECT_EQ(jobs->tally().removed["number"], 1u);
    jobs->remove(last);
    jobs->stop();
    EXPECT_THAT(became(), ::testing::EndsWith("\nremoved: number\nremoved: request\n"));
}

// Else one folder that cannot be removed would let all others grow without limit, and nobody would know.
TEST_F(RetentionHost, AJobThatCannotBeRemovedKeepsNoOther) {
    limits.retention.jobs = 1;
    start();
    const std::string stuck = ended();
    std::filesystem::create_directories(state() / "work" / (stuck + "-removed") / "in the way");
    const std::string second = ended();
    ended();
    EXPECT_TRUE(goes(second));
    EXPECT_TRUE(jobs->find(stuck));
    ended();
    jobs->stop();
    const std::string line = "job " + stuck + " cannot be removed: ";
    EXPECT_THAT(said(), ::testing::HasSubstr(line));
    EXPECT_EQ(said().find(line), said().rfind(line)) << "said once";
}

// Else one client would get the job of another, and labels would be lost without a word.
TEST_F(RetentionHost, AKeyIsOfOneOwnerAndItsLabels) {
    start();
    JobRequest request = request_of(success);
    request.idempotency_key = "key";
    request.owner = "ann";
    request.labels = {"a"};
    const Submitted first = jobs->submit(request);
    EXPECT_EQ(first.outcome, Submitted::Outcome::created);
    EXPECT_EQ(jobs->submit(request).job.id, first.job.id);
    for (auto* const change : {+[](JobRequest& r) { r.owner = "bo"; }, +[](JobRequest& r) { r.labels = {"b"}; },
                               +[](JobRequest& r) { r.priority = 1; }}) {
        JobRequest other = request;
        change(other);
        EXPECT_EQ(jobs->submit(other).outcome, Submitted::Outcome::conflict);
    }
}

// Else the next start would forget who wanted to keep a result, and remove it.
TEST_F(RetentionHost, PinsOwnersAndLabelsOutliveTheDatabase) {
    start();
    JobRequest request = request_of(success);
    request.owner = "ann";
    request.labels = {"night", "b"};
    request.priority = -3;
    const std::string id = jobs->submit(request).job.id;
    wait_for_end(id);
    jobs->pin(id, true);
    jobs.reset();
    for (const char* name : {"jobs.db", "jobs.db-wal", "jobs.db-shm"}) std::filesystem::remove(state() / name);
    const auto job = start().find(id);
    ASSERT_TRUE(job);
    EXPECT_TRUE(job->pinned);
    EXPECT_EQ(job->owner, "ann");
    EXPECT_EQ(job->labels, request.labels);
    EXPECT_EQ(job->priority, -3);
    EXPECT_GT(job->bytes, 0u);
}

TEST_F(RetentionHost, CountsWhatBecomesOfJobs) {
    limits.attempts = 2;
    start();
    ended();
    EXPECT_EQ(run("exit 65\n").state, JobState::failed);
    EXPECT_EQ(run("kill -9 $$\n").state, JobState::failed);
    const std::string waits = submit(endless);
    wait_for_run(waits);
    jobs->cancel(waits);
    jobs->stop();
    const JobTally tally = jobs->tally();
    EXPECT_EQ(tally.submitted, 4u);
    EXPECT_EQ(tally.runs, 5u);
    EXPECT_EQ(tally.ended, (std::map<std::string, std::uint64_t>{{"cancelled", 1}, {"failed", 2}, {"succeeded", 1}}));
    EXPECT_EQ(tally.requeued.at("died"), 1u);
    EXPECT_EQ(became(),
              "queued\nstarted\nsucceeded\n"
              "queued\nstarted\nfailed: the job's process ended with exit code 65\n"
              "queued\nstarted\nrequeued: the job's process was ended by signal 9 (Killed)\n"
              "started\nfailed: the job's process was ended by signal 9 (Killed)\n"
              "queued\nstarted\ncancelled\n");
}

// Else an operator could not tell a server that was stopped, or a full disk, from a job that kills itself.
TEST_F(RetentionHost, SaysWhyAJobWaitsAgain) {
    start();
    const std::string waits = submit(endless);
    wait_for_run(waits);
    jobs->stop();
    EXPECT_EQ(became(), "queued\nstarted\nrequeued: stopped\n");
    start();
    const std::string once = "[ -e " + (folder.path() / "full").string() + " ] || { touch " +
                             (folder.path() / "full").string() +
                             "; echo '{\"storage\":{\"message\":\"the disk is full\",\"bytes\":1}}'; exit 74; }\n";
    jobs->cancel(waits);
    EXPECT_EQ(run(once + success).state, JobState::succeeded);
    EXPECT_THAT(became(), ::testing::HasSubstr("requeued: the disk is full\nstarted\nsucceeded\n"));
}

TEST_F(RetentionHost, ReportsJobsThatAKilledServerRan) {
    start();
    const std::string id = submit(endless);
    wait_for_run(id);
    jobs.reset();
    {
        JobStore store(state() / "jobs.db");
        EXPECT_TRUE(store.claim("now"));  // as if the server had been killed
    }
    EXPECT_EQ(start().tally().requeued.at("killed"), 1u);
    EXPECT_THAT(became(), ::testing::HasSubstr("requeued: killed\n"));
}

}  // namespace
}  // namespace shadowbench::service

// Requests that an existing job answers.
#include <thread>

#include "jobs/job_host.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using Outcome = Submitted::Outcome;

class JobSubmission : public JobHost {};

TEST_F(JobSubmission, AnswersFromTheResultOfAnEqualJob) {
    start();
    JobRequest request = request_of(success + "echo a >result.csv; exit 2");
    request.reuse = true;
    const std::string first = jobs->submit(request).job.id;
    wait_for_end(first);
    const Submitted again = jobs->submit(request);
    EXPECT_EQ(again.outcome, Outcome::created);
    EXPECT_NE(again.job.id, first);
    EXPECT_EQ(again.job.state, JobState::succeeded);
    EXPECT_TRUE(again.job.cached);
    EXPECT_EQ(again.job.attempts, 0);
    EXPECT_EQ(again.job.promises_kept, false);
    jobs->remove(first);
    EXPECT_EQ(text_of(again.job.id, "result.csv"), "a\n");
    EXPECT_EQ(jobs->submit(request).job.state, JobState::succeeded) << "that of a job which was answered itself";

    for (int i = 0; i < 5; ++i) {
        JobRequest other = request;
        if (i == 4) other.recommend = R"({"error":0.1})";
        if (i == 0) other.reuse = false;
        if (i == 1) other.seed = 2;
        if (i == 2) other.hash += "x";
        if (i == 3) other.pictures = false;
        EXPECT_FALSE(jobs->submit(other).job.cached) << i;
    }
    EXPECT_TRUE(jobs->find(again.job.id)->cached);
}

TEST_F(JobSubmission, AnswersARecommendationFromThatOfAnEqualRequest) {
    start();
    JobRequest request = request_of(success + "cp recommend.json table.txt");
    request.reuse = true;
    request.pictures = false;
    request.recommend = R"({"error":0.1})";
    const JobInfo first = wait_for_end(jobs->submit(request).job.id);
    EXPECT_EQ(first.recommend, request.recommend);
    EXPECT_EQ(text_of(first.id, "table.txt"), request.recommend) << "the process finds the request in its folder";
    EXPECT_EQ(jobs->artifacts(first.id), (std::vector<std::string>{"result.json", "table.txt"}));
    const Submitted again = jobs->submit(request);
    EXPECT_TRUE(again.job.cached);
    EXPECT_EQ(again.job.recommend, request.recommend);
    JobRequest other = request;
    other.recommend = R"({"error":0.2})";
    EXPECT_FALSE(jobs->submit(other).job.cached);
    other.recommend = "";
    EXPECT_FALSE(jobs->submit(other).job.cached) << "the result of a run is another";
}

TEST_F(JobSubmission, RunsAJobWhoseEarlierResultIsLost) {
    start();
    JobRequest request = request_of(success);
    request.reuse = true;
    const std::string first = jobs->submit(request).job.id;
    wait_for_end(first);
    fs::remove_all(state() / "jobs" / first);
    const Submitted again = jobs->submit(request);
    EXPECT_FALSE(again.job.cached);
    EXPECT_EQ(wait_for_end(again.job.id).state, JobState::succeeded);
}

TEST_F(JobSubmission, TakesARequestOfOneKeyOnce) {
    start();
    JobRequest request = request_of(success);
    request.idempotency_key = "key";
    const Submitted first = jobs->submit(request), second = jobs->submit(request);
    EXPECT_EQ(first.outcome, Outcome::created);
    EXPECT_EQ(second.outcome, Outcome::existing);
    EXPECT_EQ(second.job.id, first.job.id);
    for (int i = 0; i < 4; ++i) {
        JobRequest other = request;
        if (i == 3) other.recommend = R"({"error":0.1})";
        if (i == 0) other.scenario += " ";
        if (i == 1) other.pictures = false;
        if (i == 2) other.reuse = true;
        EXPECT_EQ(jobs->submit(other).outcome, Outcome::conflict) << i;
    }
    wait_for_end(first.job.id);
    start();
    EXPECT_EQ(jobs->submit(request).outcome, Outcome::existing);
    EXPECT_EQ(jobs->list({}, 10, "").jobs.size(), 1u);
}

TEST_F(JobSubmission, TakesARequestOfOneKeyOnceFromManyThreads) {
    start();
    JobRequest request = request_of(success);
    request.reuse = true;
    request.idempotency_key = "key";
    std::vector<std::string> ids(8);
    std::vector<std::thread> threads;
    for (std::string& id : ids) threads.emplace_back([&] { id = jobs->submit(request).job.id; });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& id : ids) EXPECT_EQ(id, ids[0]);
    EXPECT_EQ(jobs->list({}, 10, "").jobs.size(), 1u);
}

}  // namespace
}  // namespace shadowbench::service

// Jobs that get another run: since a client asks for it, or since their death was not their own.
#include <signal.h>

#include <chrono>
#include <thread>

#include "jobs/job_host.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

class JobRetries : public JobHost {};

TEST_F(JobRetries, RunsAFailedOrCancelledJobOnceMore) {
    start();
    const std::string gate = (folder.path() / "gate").string();
    const std::string failed = submit("[ -e " + gate + " ] || exit 7; " + success);
    EXPECT_EQ(wait_for_end(failed).state, JobState::failed);
    // Its process may still end when the next run begins.
    const std::string cancelled = submit("echo left >left; [ -e " + gate + " ] || { " + endless + " }; " + success);
    wait_for_run(cancelled);
    EXPECT_EQ(jobs->retry(cancelled), Jobs::Retry::refused) << "it runs";
    EXPECT_EQ(jobs->cancel(cancelled), Jobs::Change::done);
    std::ofstream(gate) << "x";
    EXPECT_EQ(jobs->retry(cancelled), Jobs::Retry::queued);
    EXPECT_EQ(jobs->retry(failed), Jobs::Retry::queued);
    for (const std::string& id : {failed, cancelled}) {
        const JobInfo job = wait_for_end(id);
        EXPECT_EQ(job.state, JobState::succeeded);
        EXPECT_EQ(job.attempts, 1);
        EXPECT_FALSE(job.fault);
        EXPECT_EQ(text_of(id, "result.json"), fake_result + "\n");
        EXPECT_EQ(jobs->retry(id), Jobs::Retry::refused) << "it has succeeded";
    }
    EXPECT_EQ(jobs->retry("j-0123456789abcdef"), Jobs::Retry::not_found);
    start();
    EXPECT_EQ(jobs->find(failed)->state, JobState::succeeded);
}

// As when a service manager ends all processes of a service: the job's process may be the first.
TEST_F(JobRetries, CountsNoDeathJustBeforeThatOfTheServer) {
    limits.attempts = 1;
    const std::string own = (folder.path() / "pid").string(), gate = (folder.path() / "gate").string();
    const std::string script = "[ -e " + gate + " ] || { echo $$ >" + own + "; " + endless + " }; " + success;
    for (const int signal : {SIGTERM, SIGKILL}) {
        fs::remove(own);
        start();
        if (jobs->list({}, 1, "").jobs.empty()) submit(script);
        const std::string id = jobs->list({}, 1, "").jobs.at(0).id;
        wait_for_run(id);
        ASSERT_EQ(::kill(std::stoi(base::read_text(own)), signal), 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until its death is seen
        jobs->stop();
        EXPECT_EQ(jobs->find(id)->state, JobState::queued);
        EXPECT_EQ(jobs->find(id)->attempts, 0);
    }
    std::ofstream(gate) << "x";
    start();
    const JobInfo job = wait_for_end(jobs->list({}, 1, "").jobs.at(0).id);
    EXPECT_EQ(job.state, JobState::succeeded);
    EXPECT_EQ(job.attempts, 1);
}

}  // namespace
}  // namespace shadowbench::service

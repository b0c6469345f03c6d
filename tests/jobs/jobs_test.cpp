#include "service/jobs/jobs.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "base/error.h"
#include "jobs/job_host.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using Outcome = Submitted::Outcome;

class JobQueue : public JobHost {};

TEST_F(JobQueue, RunsAJobAndKeepsItsResults) {
    start();
    const std::string id = submit("mkdir images; echo picture >images/a.png; echo table >result.csv; " + success);
    const JobInfo job = wait_for_end(id);
    EXPECT_EQ(job.state, JobState::succeeded);
    EXPECT_EQ(job.id.size(), 18u);
    EXPECT_EQ(job.id.substr(0, 2), "j-");
    EXPECT_EQ(job.id.find_first_not_of("0123456789abcdef", 2), std::string::npos);
    EXPECT_EQ(job.name, "fake");
    EXPECT_EQ(job.seed, 1u);
    EXPECT_EQ(job.attempts, 1);
    EXPECT_EQ(job.promises_kept, true);
    EXPECT_FALSE(job.cached);
    EXPECT_FALSE(job.fault);
    EXPECT_FALSE(job.progress);
    EXPECT_FALSE(job.position);
    for (const std::string& time : {job.created, job.started, job.ended}) {
        EXPECT_EQ(time.size(), 24u) << time;
        EXPECT_EQ(time.back(), 'Z');
    }
    EXPECT_LE(job.created, job.started);
    EXPECT_LE(job.started, job.ended);
    EXPECT_EQ(jobs->artifacts(id), (std::vector<std::string>{"images/a.png", "result.csv", "result.json"}));
    EXPECT_EQ(text_of(id, "images/a.png"), "picture\n");
    EXPECT_FALSE(jobs->artifact(id, "../../jobs.db"));
    EXPECT_FALSE(jobs->artifact("../jobs", "result.json"));
    EXPECT_TRUE(work_is_empty());
}

TEST_F(JobQueue, TellsItsProgramWhereTheDataIsAndWhatIsAllowed) {
    data = {"/srv/a", "/srv/b c"};
    limits.memory = std::size_t{3} << 29;
    start();
    const std::string script = "for a; do echo \"$a\"; done >arguments; " + success;
    const std::string id = submit(script);
    wait_for_end(id);
    const std::string tail = "--data\n/srv/a\n--data\n/srv/b c\n--memory-limit\n1.5\n";
    EXPECT_TRUE(text_of(id, "arguments").ends_with(tail)) << text_of(id, "arguments");
    EXPECT_EQ(jobs->scenario(id), script);
    JobRequest plain = request_of(script);
    plain.pictures = false;
    const std::string other = jobs->submit(plain).job.id;
    EXPECT_FALSE(wait_for_end(other).pictures);
    EXPECT_TRUE(text_of(other, "arguments").ends_with(tail + "--no-pictures\n"));
}

TEST_F(JobQueue, TellsABrokenPromiseFromAFailure) {
    start();
    const JobInfo broken = run(success + "exit 2");
    EXPECT_EQ(broken.state, JobState::succeeded);
    EXPECT_EQ(broken.promises_kept, false);
    const JobInfo failed = run(success + "exit 3");
    EXPECT_EQ(failed.state, JobState::failed);
    EXPECT_FALSE(failed.promises_kept);
    ASSERT_TRUE(failed.fault);
    EXPECT_EQ(failed.fault->code, 70);
    EXPECT_TRUE(jobs->artifacts(failed.id).empty());
    EXPECT_EQ(failed.attempts, 1) << "it would fail again";
    for (const char* script : {"exit 0", "exit 2", "mkdir result.json", "ln -s /etc/passwd result.json"}) {
        const JobInfo without = run(script);
        EXPECT_EQ(without.state, JobState::failed) << script;
    }
}

TEST_F(JobQueue, PassesOnWhyAJobFailedWithoutPathsOfTheMachine) {
    data = {folder.path().string()};
    start();
    const JobInfo job = run("echo '{\"error\":{\"code\":65,\"where\":\"/lights/0\",\"message\":\"cannot read " +
                            folder.path().string() + "/hair.tfx\"}}'; echo noise >&2; exit 65");
    ASSERT_TRUE(job.fault);
    EXPECT_EQ(job.fault->code, 65);
    EXPECT_EQ(job.fault->where, "/lights/0");
    EXPECT_EQ(job.fault->message, "cannot read hair.tfx");
    const JobInfo other = run("echo \"$PWD/result.json is odd\" >&2; exit 9");
    EXPECT_EQ(other.fault->message,
              "the job's process ended with exit code 9: work/" + other.id + "-1/result.json is odd");
}

TEST_F(JobQueue, SaysWhyItsProgramCannotBeStarted) {
    write_executable(program, "\x7f no program");
    start();
    const JobInfo job = run("");
    EXPECT_EQ(job.state, JobState::failed);
    ASSERT_TRUE(job.fault);
    EXPECT_EQ(job.fault->message, "the program cannot be started: Exec format error");
}

TEST_F(JobQueue, OutlivesWhateverAProcessSays) {
    start();
    const JobInfo job =
        run("echo garbage; echo '{\"stage\":'; head -c 70000 /dev/zero; echo; printf '\\377\\376\\n'; "
            "echo '{\"stage\":[],\"fraction\":1e400}'; " +
            success);
    EXPECT_EQ(job.state, JobState::succeeded);
}

TEST_F(JobQueue, TriesAJobAgainWhoseProcessCrashed) {
    start();
    const std::string counter = (folder.path() / "count").string();
    const JobInfo twice =
        run("echo x >>" + counter + "; [ $(wc -l <" + counter + ") -ge 2 ] || kill -SEGV $$; " + success);
    EXPECT_EQ(twice.state, JobState::succeeded);
    EXPECT_EQ(twice.attempts, 2);
    for (const auto& [name, says] : {std::pair("SEGV", "signal 11"), std::pair("KILL", "signal 9")}) {
        const JobInfo always = run(std::string("kill -") + name + " $$; sleep 1000");
        EXPECT_EQ(always.state, JobState::failed);
        EXPECT_EQ(always.attempts, 3);
        EXPECT_EQ(always.fault->code, 70);
        EXPECT_NE(always.fault->message.find(says), std::string::npos) << always.fault->message;
    }
    EXPECT_EQ(run(success).state, JobState::succeeded) << "and the next is none the worse";
    EXPECT_TRUE(work_is_empty());
}

TEST_F(JobQueue, EndsAJobThatTakesTooMuchAndThatAlone) {
    limits.memory = std::size_t{64} << 20;
    limits.seconds = 2.0;
    start();
    const std::string hog = submit("exec tail -n 1 </dev/zero"), slow = submit("sleep 1000"), next = submit(success);
    const JobInfo much = wait_for_end(hog), late = wait_for_end(slow);
    EXPECT_EQ(much.state, JobState::failed);
    EXPECT_EQ(much.fault->code, 65);
    EXPECT_NE(much.fault->message.find("memory"), std::string::npos) << much.fault->message;
    EXPECT_EQ(much.attempts, 1);
    EXPECT_EQ(late.state, JobState::failed);
    EXPECT_NE(late.fault->message.find("longer than 2 s"), std::string::npos) << late.fault->message;
    EXPECT_EQ(wait_for_end(next).state, JobState::succeeded);
}

TEST_F(JobQueue, ShowsProgressThatNeverFalls) {
    start();
    const std::string gate = (folder.path() / "gate").string();
    const auto say = [](const char* fraction) {
        return std::string("echo '{\"stage\":\"build\",\"place\":\"key\",\"done\":3,\"total\":16,\"fraction\":") +
               fraction + "}'\n";
    };
    const std::string until_open = "while [ ! -e " + gate + " ]; do sleep 0.02; done\n";
    const std::string id = submit(say("0.5") + "sleep 0.3\n" + say("0.25") + until_open + success);
    const JobInfo first = wait_for_run(id);
    EXPECT_EQ(first.state, JobState::running);
    EXPECT_EQ(first.progress->stage, "build");
    EXPECT_EQ(first.progress->place, "key");
    EXPECT_EQ(first.progress->done, 3u);
    EXPECT_EQ(first.progress->total, 16u);
    EXPECT_EQ(first.progress->fraction, 0.5);
    const JobInfo second =
        wait_until(id, [&](const JobInfo& job) { return job.progress && job.revision > first.revision; });
    EXPECT_EQ(second.progress->fraction, 0.5);
    std::ofstream(gate) << "x";
    const JobInfo end = wait_for_end(id);
    EXPECT_FALSE(end.progress);
    EXPECT_GT(end.revision, second.revision);
}

TEST_F(JobQueue, RunsJobsInTheOrderTheyCame) {
    start();
    const std::string log = (folder.path() / "log").string();
    std::vector<std::string> ids{submit(endless)};
    wait_for_run(ids[0]);
    for (int i = 1; i <= 4; ++i) ids.push_back(submit("echo " + std::to_string(i) + " >>" + log + "; " + success));
    EXPECT_FALSE(jobs->find(ids[0])->position);
    for (std::uint64_t i = 1; i <= 4; ++i) EXPECT_EQ(jobs->find(ids[i])->position, i - 1);
    const std::uint64_t before = jobs->find(ids[4])->revision;
    EXPECT_EQ(jobs->cancel(ids[2]), Jobs::Change::done);
    EXPECT_EQ(jobs->find(ids[4])->position, 2u);
    EXPECT_GT(jobs->find(ids[4])->revision, before) << "its place has changed";
    EXPECT_EQ(jobs->count(JobState::queued), 3u);
    jobs->cancel(ids[0]);
    wait_for_end(ids[4]);
    EXPECT_EQ(base::read_text(log), "1\n3\n4\n");
}

TEST_F(JobQueue, RunsAsManyAtOnceAsItMay) {
    limits.parallel = 3;
    start();
    // Each ends once all three run.
    const std::string meet = (folder.path() / "meet").string();
    fs::create_directory(meet);
    const std::string script =
        "touch " + meet + "/$$; while [ $(ls " + meet + " | wc -l) -lt 3 ]; do sleep 0.02; done; " + success;
    std::vector<std::string> ids;
    for (int i = 0; i < 3; ++i) ids.push_back(submit(script));
    for (const std::string& id : ids) EXPECT_EQ(wait_for_end(id).state, JobState::succeeded);
}

TEST_F(JobQueue, CancelsWhatWaitsAndWhatRuns) {
    start();
    const std::string runs = submit(endless), waits = submit(success);
    wait_for_run(runs);
    EXPECT_EQ(jobs->remove(runs), Jobs::Change::refused);
    EXPECT_EQ(jobs->cancel(waits), Jobs::Change::done);
    EXPECT_EQ(jobs->find(waits)->state, JobState::cancelled);
    EXPECT_EQ(jobs->cancel(runs), Jobs::Change::done);
    EXPECT_EQ(jobs->find(runs)->state, JobState::cancelled);
    EXPECT_FALSE(jobs->find(runs)->progress);
    EXPECT_EQ(jobs->cancel(runs), Jobs::Change::refused);
    EXPECT_EQ(jobs->cancel("j-0123456789abcdef"), Jobs::Change::not_found);
    EXPECT_EQ(run(success).state, JobState::succeeded) << "the worker is free again";
    EXPECT_TRUE(work_is_empty());
}

TEST_F(JobQueue, RemovesAJobWithItsFiles) {
    start();
    const JobInfo job = run(success);
    EXPECT_EQ(jobs->remove(job.id), Jobs::Change::done);
    EXPECT_FALSE(jobs->find(job.id));
    EXPECT_FALSE(jobs->scenario(job.id));
    EXPECT_FALSE(jobs->artifact(job.id, "result.json"));
    EXPECT_FALSE(fs::exists(state() / "jobs" / job.id));
    EXPECT_EQ(jobs->remove(job.id), Jobs::Change::not_found);
}

TEST_F(JobQueue, RefusesMoreThanItHolds) {
    limits.queue = 2;
    start();
    const std::string first = submit(endless);
    wait_for_run(first);
    const std::string second = submit(success);
    submit(success);
    EXPECT_EQ(jobs->submit(request_of(success)).outcome, Outcome::queue_full);
    jobs->cancel(first);
    wait_for_end(second);
    submit(success);
}

TEST_F(JobQueue, ListsByPages) {
    start();
    std::vector<std::string> ids{submit(endless)};
    wait_for_run(ids[0]);
    for (int i = 1; i < 5; ++i) ids.push_back(submit(success));
    std::vector<std::string> seen;
    std::string cursor;
    do {
        const JobPage page = jobs->list({}, 2, cursor);
        EXPECT_LE(page.jobs.size(), 2u);
        for (const JobInfo& job : page.jobs) seen.push_back(job.id);
        cursor = page.next;
    } while (!cursor.empty());
    EXPECT_EQ(seen, (std::vector<std::string>(ids.rbegin(), ids.rend())));
    const JobPage queued = jobs->list({JobState::queued}, 10, "");
    ASSERT_EQ(queued.jobs.size(), 4u);
    EXPECT_EQ(queued.jobs[0].position, 3u);
    EXPECT_EQ(queued.next, "");
    EXPECT_TRUE(jobs->list({JobState::running}, 10, "").jobs[0].progress);
    for (const char* wrong : {"x", "-1", "0", "1 ", "99999999999999999999"}) {
        try {
            jobs->list({}, 2, wrong);
            ADD_FAILURE() << wrong;
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::usage);
        }
    }
}

TEST_F(JobQueue, WakesWhoWaitsForAJob) {
    start();
    const std::string blocks = submit(endless), id = submit(success);
    wait_for_run(blocks);
    EXPECT_FALSE(jobs->wait("j-0123456789abcdef", 0, 60.0));
    const std::uint64_t revision = jobs->find(id)->revision;
    EXPECT_EQ(jobs->wait(id, revision, 0.0)->revision, revision) << "its time is up";
    EXPECT_EQ(jobs->wait(id, revision - 1, 60.0)->revision, revision);

    std::vector<std::thread> threads;
    std::vector<JobInfo> last(50);
    for (JobInfo& info : last)
        threads.emplace_back([&] {
            for (std::uint64_t seen = revision; !has_ended(info); seen = info.revision)
                info = jobs->wait(id, seen, 120.0).value_or(JobInfo());
        });
    jobs->cancel(blocks);
    for (std::thread& thread : threads) thread.join();
    for (const JobInfo& info : last) EXPECT_EQ(info.state, JobState::succeeded);

    std::thread remover([&] { jobs->remove(id); });
    EXPECT_FALSE(jobs->wait(id, last[0].revision, 120.0)) << "gone";
    remover.join();
}

TEST_F(JobQueue, HoldsAThousandJobs) {
    start();
    const std::string first = submit(endless);
    wait_for_run(first);
    std::vector<std::string> ids;
    for (int i = 0; i < 1000; ++i) ids.push_back(submit(success));
    EXPECT_EQ(jobs->count(JobState::queued), 1000u);
    EXPECT_EQ(jobs->find(ids[999])->position, 999u);
    const auto median_ms = [](const std::function<void(int)>& body) {
        std::vector<double> times;
        for (int i = 0; i < 201; ++i) {
            const auto begin = std::chrono::steady_clock::now();
            body(i);
            times.push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
        }
        std::nth_element(times.begin(), times.begin() + 100, times.end());
        return std::to_string(times[100]);
    };
    // For the report of this test; a time does not decide whether it passes.
    RecordProperty("find_ms", median_ms([&](int i) { EXPECT_TRUE(jobs->find(ids[static_cast<std::size_t>(i * 4)])); }));
    RecordProperty("list_of_50_ms", median_ms([&](int) { EXPECT_EQ(jobs->list({}, 50, "").jobs.size(), 50u); }));
    RecordProperty("list_of_1000_ms", median_ms([&](int) { EXPECT_EQ(jobs->list({}, 1000, "").jobs.size(), 1000u); }));
    // Most of them would only take time: of the disk, for every change waits for it.
    for (std::size_t i = 100; i < ids.size(); ++i) EXPECT_EQ(jobs->cancel(ids[i]), Jobs::Change::done);
    jobs->cancel(first);
    for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(wait_for_end(ids[i]).state, JobState::succeeded);
    EXPECT_EQ(jobs->count(JobState::succeeded), 100u);
    EXPECT_EQ(jobs->count(JobState::cancelled), 901u);
}

}  // namespace
}  // namespace shadowbench::service

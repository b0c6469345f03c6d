// What is left of the jobs when their server ends, gently or not.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "jobs/job_host.h"
#include "service/jobs/folders.h"
#include "service/jobs/record.h"
#include "service/store/database.h"
#include "service/store/job_store.h"
#include "service/store/store_kind.h"
#include "store/version_1.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

class JobRestart : public JobHost {
protected:
    [[noreturn]] void serve_one(const std::string& script) {
        try {
            Jobs& own = start();
            if (own.list({}, 1, "").jobs.empty()) own.submit(request_of(script));
            for (;;) ::pause();
        } catch (...) {
            ::_exit(1);
        }
    }
    // Servers of this one job, each in a process that is killed once the job has made the file "note".
    void kill_while_running(const std::string& script, int times) {
        for (int i = 0; i < times; ++i) {
            const fs::path note = folder.path() / "note";
            fs::remove(note);
            const pid_t server = ::fork();
            if (server == 0) serve_one(script);
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
            while (!fs::exists(note) && std::chrono::steady_clock::now() < end)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            ::kill(server, SIGKILL);
            ::waitpid(server, nullptr, 0);
            EXPECT_TRUE(fs::exists(note));
        }
    }
    std::string note_and(const std::string& script) const {
        return "touch " + (folder.path() / "note").string() + "; " + script;
    }
};

TEST_F(JobRestart, RefusesASecondServer) {
    start();
    try {
        const Jobs second(state(), program.string(), {}, {});
        ADD_FAILURE() << "two servers hold one state";
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
        EXPECT_NE(error.message().find("another server"), std::string::npos);
    }
    EXPECT_EQ(run(success).state, JobState::succeeded) << "the first is none the worse";
}

TEST_F(JobRestart, RefusesAProgramThatIsNotThere) {
    EXPECT_THROW(Jobs(state(), "/nowhere/at/all", {}, {}), base::Error);
}

TEST_F(JobRestart, KeepsWhatHasEnded) {
    start();
    const JobInfo good = run(success + "exit 2"), bad = run("exit 7");
    const std::string cancelled = submit(endless);
    jobs->cancel(cancelled);
    start();
    const auto again = jobs->find(good.id);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->state, JobState::succeeded);
    EXPECT_EQ(again->promises_kept, false);
    EXPECT_EQ(again->revision, good.revision);
    EXPECT_EQ(again->ended, good.ended);
    EXPECT_EQ(text_of(good.id, "result.json"), fake_result + "\n");
    EXPECT_EQ(jobs->find(bad.id)->fault->message, bad.fault->message);
    EXPECT_EQ(jobs->find(cancelled)->state, JobState::cancelled);
}

TEST_F(JobRestart, WaitsForARunningJobAsLongAsItMay) {
    limits.grace = 60.0;
    start();
    const std::string gate = (folder.path() / "gate").string();
    const std::string id =
        submit("echo '{\"stage\":\"build\"}'; while [ ! -e " + gate + " ]; do sleep 0.02; done; " + success);
    const std::string next = submit(success);
    wait_for_run(id);
    std::thread opener([&] {
        while (!jobs->stopping()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::ofstream(gate) << "x";
    });
    jobs->stop();
    opener.join();
    EXPECT_EQ(jobs->find(id)->state, JobState::succeeded);
    EXPECT_EQ(jobs->find(next)->state, JobState::queued) << "no more is started";
}

TEST_F(JobRestart, QueuesAgainWhatIsNotDoneInTime) {
    limits.grace = 0.2;
    start();
    const std::string id = submit(endless);
    const JobInfo before = wait_for_run(id);
    std::optional<JobInfo> woken;
    std::thread waits([&] { woken = jobs->wait(id, before.revision + 1000000, 600.0); });
    jobs->stop();
    waits.join();
    ASSERT_TRUE(woken);
    const auto job = jobs->find(id);
    EXPECT_EQ(job->state, JobState::queued);
    EXPECT_EQ(job->attempts, 0) << "the server asked for it";
    EXPECT_EQ(job->started, "");
    EXPECT_GT(job->revision, before.revision);
    EXPECT_TRUE(work_is_empty());
    jobs->stop();
    start();
    EXPECT_GT(jobs->find(id)->revision, job->revision) << "who resumes its events sees the restart";
    EXPECT_EQ(wait_for_run(id).attempts, 1);
}

TEST_F(JobRestart, RunsAgainWhatRanWhenTheServerWasKilledHoweverOften) {
    kill_while_running(note_and("[ -e " + (folder.path() / "gate").string() + " ] || sleep 1000; " + success), 5);
    std::ofstream(folder.path() / "gate") << "x";
    start();
    const std::string id = jobs->list({}, 1, "").jobs.at(0).id;
    const JobInfo job = wait_for_end(id);
    EXPECT_EQ(job.state, JobState::succeeded);
    EXPECT_EQ(job.attempts, 1) << "the deaths of servers are not the job's";
}

TEST_F(JobRestart, AsksAgainWhatWaitedOrRanWhenTheServerEnded) {
    limits.grace = 0.0;
    start();
    const std::string gate = (folder.path() / "gate").string();
    JobRequest request = request_of("[ -e " + gate + " ] || { echo '{\"stage\":\"exploring\"}'; sleep 1000; }; " +
                                    success + "cp recommend.json table.txt; exit 2");
    request.recommend = R"({"error":0.1})";
    const std::string ran = jobs->submit(request).job.id;
    wait_for_run(ran);
    request.recommend = R"({"error":0.2})";
    const std::string waited = jobs->submit(request).job.id;
    jobs->stop();
    std::ofstream(gate) << "x";
    start();
    for (const auto& [id, asked] : {std::pair(ran, R"({"error":0.1})"), std::pair(waited, R"({"error":0.2})")}) {
        const JobInfo job = wait_for_end(id);
        EXPECT_EQ(job.state, JobState::succeeded);
        EXPECT_EQ(job.promises_kept, false) << "nothing reaches the error";
        EXPECT_EQ(job.attempts, 1);
        EXPECT_EQ(job.recommend, asked);
        EXPECT_EQ(text_of(id, "table.txt"), asked);
    }
}

TEST_F(JobRestart, RunsTheJobsOfAnEarlierVersion) {
    start();
    jobs.reset();
    for (const char* end : {"jobs.db", "jobs.db-wal", "jobs.db-shm"}) fs::remove(state() / end);
    write_version_1(state() / "jobs.db", success);
    start();
    const JobInfo waited = wait_for_end("j-000000000000000b");
    EXPECT_EQ(waited.state, JobState::succeeded);
    EXPECT_EQ(waited.recommend, "");
    EXPECT_FALSE(fs::exists(state() / "lost+found")) << said();
    EXPECT_EQ(jobs->find("j-000000000000000a")->state, JobState::succeeded);
}

// Its own crashes count, whatever its servers did in between.
TEST_F(JobRestart, CountsTheCrashesOfTheJobAlone) {
    const std::string crashes = (folder.path() / "crashes").string();
    kill_while_running("echo x >>" + crashes + "; [ $(wc -l <" + crashes + ") -ge 2 ] || kill -SEGV $$; " +
                           note_and("[ $(wc -l <" + crashes + ") -lt 5 ] || kill -SEGV $$; sleep 1000"),
                       3);
    start();
    const JobInfo job = wait_for_end(jobs->list({}, 1, "").jobs.at(0).id);
    EXPECT_EQ(job.state, JobState::failed);
    EXPECT_EQ(job.attempts, 3);
    EXPECT_EQ(base::read_text(crashes), "x\nx\nx\nx\nx\nx\n") << "1 crash, 3 servers, 2 crashes";
    EXPECT_EQ(run(success).state, JobState::succeeded);
}

// The moments between the steps that make a job a success, as a kill would leave them.
TEST_F(JobRestart, FinishesASuccessWhereItWasCut) {
    fs::create_directories(state());
    const JobFolders folders = make_job_folders(state());
    const std::string placed = "j-000000000000000a", recorded = "j-000000000000000b", early = "j-000000000000000c",
                      cancelled = "j-000000000000000d", damaged = "j-000000000000000e";
    const std::string first = service::text_of(made_result("first"));
    {
        JobStore store(state() / "jobs.db");
        for (const std::string& id : {placed, recorded, early, cancelled, damaged}) {
            NewJob job;
            job.id = id;
            job.scenario = success + "echo again >from";
            store.add(job, 10);
            KeptJob kept;
            kept.job = *store.claim("now");
            kept.job.kept = false;
            kept.job.ended = "then";
            const fs::path work = attempt_folder(folders, id, 1);
            fs::create_directories(work);
            std::ofstream(work / "result.json") << (id == damaged ? first.substr(0, first.size() / 2) : first);
            if (id != early) write_record(work, kept);
        }
        for (const std::string& id : {placed, cancelled, damaged}) publish(folders, attempt_folder(folders, id, 1), id);
        store.end_waiting(cancelled, {job_states::cancelled, "then", {}, {}});
    }
    start();
    const auto job = jobs->find(placed);
    EXPECT_EQ(job->state, JobState::succeeded);
    EXPECT_EQ(job->promises_kept, false);
    EXPECT_EQ(job->attempts, 1);
    EXPECT_EQ(job->ended, "then");
    EXPECT_EQ(text_of(placed, "result.json"), first);
    for (const std::string& id : {recorded, early, damaged}) {
        const JobInfo again = wait_for_end(id);
        EXPECT_EQ(again.state, JobState::succeeded);
        EXPECT_EQ(again.promises_kept, true);
        EXPECT_EQ(text_of(id, "from"), "again\n");
    }
    EXPECT_EQ(jobs->find(cancelled)->state, JobState::cancelled);
    EXPECT_FALSE(fs::exists(folders.jobs / cancelled));
    EXPECT_NE(said().find(cancelled), std::string::npos) << "its results lie in lost+found";
    EXPECT_NE(said().find(damaged), std::string::npos) << "its damaged results, too";
    EXPECT_TRUE(work_is_empty());
}

// An earlier version noted only in the database whether the promises were kept.
TEST_F(JobRestart, FinishesASuccessOfAnEarlierVersion) {
    fs::create_directories(state());
    const JobFolders folders = make_job_folders(state());
    const std::string id = "j-000000000000000a";
    {
        JobStore store(state() / "jobs.db");
        NewJob job;
        job.id = id;
        job.scenario = "exit 1";
        store.add(job, 10);
        store.claim("now");
    }
    sqlite::Database(state() / "jobs.db", sqlite::Database::Access::write, store_application)
        .execute("UPDATE jobs SET kept = 0");
    fs::create_directories(folders.jobs / id);
    const std::string first = service::text_of(made_result("first"));
    std::ofstream(folders.jobs / id / "result.json") << first;
    start();
    EXPECT_EQ(jobs->find(id)->state, JobState::succeeded);
    EXPECT_EQ(jobs->find(id)->promises_kept, false);
    EXPECT_EQ(text_of(id, "result.json"), first);
}

// Where a removal was cut off, it has been asked for: neither the job nor its results come back.
TEST_F(JobRestart, FinishesARemovalWhereItWasCut) {
    start();
    const std::string row_left = run(success).id, files_left = run(success).id;
    jobs.reset();
    const JobFolders folders = make_job_folders(state());
    for (const std::string& id : {row_left, files_left}) ASSERT_TRUE(unpublish(folders, id));
    JobStore(state() / "jobs.db").remove(files_left);
    start();
    EXPECT_FALSE(jobs->find(row_left));
    EXPECT_FALSE(jobs->find(files_left));
    EXPECT_TRUE(work_is_empty());
    EXPECT_TRUE(fs::is_empty(folders.jobs));
    EXPECT_EQ(said(), "");
}

// The removal of results deletes the record last. Results of an earlier version have none.
TEST_F(JobRestart, FinishesARemovalThatHadDeletedFiles) {
    start();
    const std::string record_left = run(success).id, nothing_left = run(success).id, no_record = run(success).id;
    const std::string cancelled = submit(endless);
    jobs->cancel(cancelled);
    jobs.reset();
    const JobFolders folders = make_job_folders(state());
    for (const std::string& id : {record_left, nothing_left, no_record}) ASSERT_TRUE(unpublish(folders, id));
    fs::copy(removed_folder(folders, record_left), removed_folder(folders, cancelled));
    std::ofstream(removed_folder(folders, cancelled) / ".job.json")
        << nlohmann::json{{"id", cancelled}};  // it succeeded at the same moment
    fs::remove(removed_folder(folders, record_left) / "result.json");
    empty_folder(removed_folder(folders, nothing_left));
    fs::remove(removed_folder(folders, no_record) / ".job.json");
    start();
    for (const std::string& id : {record_left, nothing_left, no_record}) EXPECT_FALSE(jobs->find(id));
    EXPECT_EQ(jobs->find(cancelled)->state, JobState::cancelled);
    EXPECT_TRUE(work_is_empty());
    EXPECT_EQ(said(), "");
}

// A server under load, killed at any moment: what it had accepted is neither lost nor doubled.
class JobKill : public JobHost {
protected:
    static constexpr int kills = 50;

    // Each job writes result.json in two parts, so that an incomplete one would show, and names its job.
    static std::string script(int number) {
        const std::string text = result(number);
        const std::size_t half = text.size() / 2;
        return "printf '%s' '" + text.substr(0, half) +
               "' >part; sleep 0.01; mkdir images; echo p >images/p.png; "
               "printf '%s' '" +
               text.substr(half) + "' >>part; mv part result.json";
    }
    static std::string result(int number) { return service::text_of(made_result(std::to_string(number))); }

    // Submits `from`, `from` + 1, ... and writes each number and id to `to` once it is accepted. A few always wait.
    [[noreturn]] void serve(int from, int to) {
        Jobs& own = start();
        for (int number = from;; ++number) {
            while (own.count(JobState::queued) > 5) std::this_thread::sleep_for(std::chrono::milliseconds(2));
            JobRequest request = request_of(script(number));
            request.idempotency_key = "job " + std::to_string(number);
            const std::string line = std::to_string(number) + " " + own.submit(request).job.id + "\n";
            if (::write(to, line.data(), line.size()) != static_cast<ssize_t>(line.size())) ::_exit(1);
        }
    }

    // What a server accepted in its life of so many milliseconds after its first word, or from its start.
    void live(int milliseconds, bool from_first_word) {
        int ends[2];
        ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
        const pid_t server = ::fork();
        if (server == 0) {
            ::close(ends[0]);
            try {
                serve(next, ends[1]);
            } catch (...) {
                ::_exit(1);
            }
        }
        ::close(ends[1]);
        std::string said;
        char buffer[4096];
        if (from_first_word) {
            const ssize_t count = ::read(ends[0], buffer, sizeof buffer);
            if (count > 0) said.append(buffer, static_cast<std::size_t>(count));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        ::kill(server, SIGKILL);
        for (ssize_t count; (count = ::read(ends[0], buffer, sizeof buffer)) > 0;)
            said.append(buffer, static_cast<std::size_t>(count));
        ::close(ends[0]);
        ::waitpid(server, nullptr, 0);
        std::istringstream lines(said);
        std::string id;
        for (int number = 0; lines >> number >> id;) {
            EXPECT_EQ(accepted.emplace(number, id).first->second, id) << "doubled";
            next = number + 1;
        }
    }

    std::map<int, std::string> accepted;  // number -> id
    int next = 0;                         // the first that is not known to be accepted
};

TEST_F(JobKill, LosesAndDoublesNothing) {
    limits.attempts = 1000;
    limits.parallel = 2;
    std::mt19937 random(7);
    for (int i = 0; i < kills; ++i) live(static_cast<int>(random() % 250), i % 5 != 4);
    ASSERT_GT(accepted.size(), static_cast<std::size_t>(kills));

    start();
    // A job belongs to its key even if the answer never reached the client.
    JobRequest request = request_of(script(next));
    request.idempotency_key = "job " + std::to_string(next);
    accepted[next] = jobs->submit(request).job.id;
    int most_attempts = 0, ran_again = 0;
    for (const auto& [number, id] : accepted) {
        const JobInfo job = wait_for_end(id);
        EXPECT_EQ(job.state, JobState::succeeded) << number;
        EXPECT_EQ(jobs->scenario(id), script(number));
        EXPECT_EQ(text_of(id, "result.json"), result(number));
        EXPECT_EQ(jobs->artifacts(id), (std::vector<std::string>{"images/p.png", "result.json"}));
        most_attempts = std::max(most_attempts, job.attempts);
        ran_again += job.attempts > 1;
    }
    EXPECT_EQ(jobs->list({}, 1000, "").jobs.size(), std::min<std::size_t>(accepted.size(), 1000));
    EXPECT_EQ(jobs->count(JobState::succeeded), accepted.size()) << "some were doubled, or never accepted";
    std::size_t folders = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(state() / "jobs")) ++folders;
    EXPECT_EQ(folders, accepted.size());
    jobs->stop();
    EXPECT_TRUE(work_is_empty());
    RecordProperty("accepted", static_cast<int>(accepted.size()));
    RecordProperty("ran_again", ran_again);
    RecordProperty("most_attempts", most_attempts);
}

}  // namespace
}  // namespace shadowbench::service

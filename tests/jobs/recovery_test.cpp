// Results outlive their database, and nothing that a start finds is deleted.
#include <fcntl.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "jobs/job_host.h"
#include "jobs/unprivileged.h"
#include "service/jobs/folders.h"
#include "service/jobs/record.h"
#include "service/store/database.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class Recovery : public JobHost {
protected:
    void stop() { jobs.reset(); }
    fs::path database() const { return state() / "jobs.db"; }
    fs::path copy() const { return folder.path() / "copy.db"; }
    void remove_database() const {
        for (const char* end : {"", "-wal", "-shm"}) fs::remove(database().string() + end);
    }
    // All files below lost+found, by their name there, without the time.
    std::map<std::string, std::string> lost() const {
        std::map<std::string, std::string> found;
        if (!fs::exists(state() / "lost+found")) return found;
        for (const auto& time : fs::directory_iterator(state() / "lost+found"))
            for (const auto& entry : fs::recursive_directory_iterator(time))
                if (entry.is_regular_file())
                    found[entry.path().lexically_relative(time.path()).string()] = base::read_bytes(entry.path());
        return found;
    }
    static void write(const fs::path& file, const std::string& text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    void is_as_before(const JobInfo& before) const {
        const auto now = jobs->find(before.id);
        ASSERT_TRUE(now);
        EXPECT_EQ(now->state, JobState::succeeded);
        EXPECT_EQ(now->name, before.name);
        EXPECT_EQ(now->scenario_hash, before.scenario_hash);
        EXPECT_EQ(now->seed, before.seed);
        EXPECT_EQ(now->created, before.created);
        EXPECT_EQ(now->started, before.started);
        EXPECT_LE(now->ended, before.ended) << "its record is written before its end is noted";
        EXPECT_GE(now->ended, before.started);
        EXPECT_EQ(now->attempts, before.attempts);
        EXPECT_EQ(now->pictures, before.pictures);
        EXPECT_EQ(now->recommend, before.recommend);
        EXPECT_EQ(now->cached, before.cached);
        EXPECT_EQ(now->promises_kept, before.promises_kept);
    }
};

const std::string long_success =
    "echo '" + fake_result + "' >result.json; mkdir images; echo p >images/p.png; echo t >result.csv\n";

TEST_F(Recovery, TakesResultsBackWhenTheDatabaseIsLostEmptyOrDamaged) {
    for (const std::string& what : {std::string("missing"), std::string("empty"), std::string("garbage"),
                                    std::string("cut"), std::string("page"), std::string("table")}) {
        start();
        JobRequest request = request_of(long_success + "exit 2 # " + what);
        request.seed = 0xfedcba9876543210ull;
        request.pictures = false;
        request.idempotency_key = "key of " + what;
        const JobInfo broken = wait_for_end(jobs->submit(request).job.id);
        JobRequest same = request_of(success + "# reused " + what);
        same.reuse = true;
        const JobInfo first = wait_for_end(jobs->submit(same).job.id), cached = jobs->submit(same).job;
        ASSERT_TRUE(cached.cached);
        stop();
        if (what == "missing") remove_database();
        if (what == "empty") write(database(), "");
        if (what == "garbage") write(database(), std::string(9000, 'x'));
        if (what == "cut") fs::resize_file(database(), fs::file_size(database()) / 2 - 100);
        if (what == "page") {
            std::fstream stream(database(), std::ios::in | std::ios::out | std::ios::binary);
            stream.seekp(4096);
            stream << std::string(4096 * 2, '\x5a');
        }
        if (what == "table")
            sqlite::Database(database(), sqlite::Database::Access::write, 0x73626a31).execute("DROP TABLE counter");
        const std::string before = fs::exists(database()) ? base::read_text(database()) : "";
        said_lines.clear();
        start();
        for (const JobInfo& job : {broken, first, cached}) {
            is_as_before(job);
            EXPECT_THAT(said(), HasSubstr(job.id)) << what;
        }
        EXPECT_EQ(text_of(broken.id, "images/p.png"), "p\n");
        EXPECT_EQ(jobs->scenario(broken.id), request.scenario);
        EXPECT_EQ(jobs->submit(request).job.id, broken.id) << "the key of its request is known";
        EXPECT_TRUE(jobs->submit(same).job.cached) << "and its result answers";
        EXPECT_THAT(said(), HasSubstr("are lost"));
        if (what != "missing" && what != "empty") {
            EXPECT_EQ(lost()["jobs.db"], before) << what << ": it is not deleted";
            EXPECT_THAT(said(), HasSubstr("lost+found"));
        }
        said_lines.clear();
        start();
        EXPECT_EQ(said(), "") << "once";
        stop();
        fs::remove_all(state());
    }
}

TEST_F(Recovery, KeepsResultsThatAreNewerThanTheDatabase) {
    start();
    const JobInfo old = run(success);
    const std::string blocker = submit(endless);
    wait_for_run(blocker);
    const std::string waits = submit(long_success);
    stop();
    fs::copy_file(database(), copy());
    start();
    jobs->cancel(blocker);
    const JobInfo waited = wait_for_end(waits), fresh = run(long_success + "exit 2");
    stop();
    remove_database();
    fs::copy_file(copy(), database());
    said_lines.clear();
    start();
    for (const JobInfo& job : {old, waited, fresh}) is_as_before(job);
    EXPECT_THAT(said(), Not(HasSubstr(old.id)));
    for (const std::string& id : {waits, fresh.id}) {
        EXPECT_THAT(said(), HasSubstr(id));
        EXPECT_EQ(text_of(id, "images/p.png"), "p\n");
    }
    EXPECT_EQ(jobs->list({JobState::succeeded}, 9, "").jobs.size(), 3u);
    EXPECT_EQ(jobs->list({}, 1, "").jobs[0].id, fresh.id) << "in the order they came";
    const JobState state = jobs->find(blocker)->state;
    EXPECT_TRUE(state == JobState::queued || state == JobState::running) << "not cancelled, as that database has it";
}

TEST_F(Recovery, TakesResultsOfAnEarlierVersionBack) {
    start();
    stop();
    remove_database();
    const std::string id = "j-0123456789abcdef", failed = "j-0123456789abcdee";
    const std::string result = service::text_of(made_result("n", results::CellStatus::ok));
    write(state() / "jobs" / id / "result.json", result);
    write(state() / "jobs" / id / "images" / "a.png", "x");
    write(state() / "jobs" / failed / "result.json", service::text_of(made_result("n", results::CellStatus::failed)));
    start();
    const auto job = jobs->find(id);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->state, JobState::succeeded);
    EXPECT_EQ(job->name, "n");
    EXPECT_EQ(job->scenario_hash, "hash of n");
    EXPECT_EQ(job->seed, 7u);
    EXPECT_EQ(job->created, "2026-01-02T03:04:05Z");
    EXPECT_EQ(job->ended.size(), 24u);
    EXPECT_EQ(job->promises_kept, true);
    EXPECT_TRUE(job->pictures);
    EXPECT_EQ(nlohmann::json::parse(*jobs->scenario(id)), nlohmann::json::parse(result).at("scenario"));
    EXPECT_EQ(jobs->find(failed)->promises_kept, false);
    EXPECT_FALSE(jobs->find(failed)->pictures);
}

TEST_F(Recovery, MovesAwayWhatItDoesNotKnow) {
    start();
    const JobInfo good = run(success), bad = run("exit 7");
    stop();
    const std::string unborn = "j-0123456789abcdef";
    // Each with the content that says where it was.
    const std::vector<std::string> unknown{"work/a",
                                           "work/deep/b",
                                           "work/" + unborn + "-1/result.json",
                                           "work/" + unborn + "-copy/result.json",
                                           "work/" + good.id + "-x/c",
                                           "work/" + good.id,
                                           "work/" + good.id + "-1/result.json",
                                           "work/" + good.id + "-2/half",
                                           "work/" + bad.id + "-0/x",
                                           "work/" + bad.id + "-01/x",
                                           "work/" + bad.id + "-7/x",
                                           "work/" + bad.id + "-99999999999/x",
                                           "work/" + bad.id + "-copy/x",
                                           "work/" + bad.id + "-removed/x",
                                           "work/" + good.id + "-removed/x",
                                           "work/" + unborn + "-removed/x",
                                           "work/.room-file/x",
                                           "jobs/d",
                                           "jobs/mine/result.json",
                                           "jobs/" + unborn + "/result.json",
                                           "jobs/j-0123456789abcdee/e",
                                           "jobs/" + bad.id + "/result.json",
                                           "jobs/.hidden"};
    for (const std::string& name : unknown) write(state() / name, name);
    fs::create_symlink(folder.path(), state() / "jobs" / "j-0123456789abcdea");
    write(state() / "work" / (bad.id + "-1") / "half", "x");  // ours
    write(state() / "work" / ".room-abcdef", "x");            // ours
    write(state() / "notes", "mine");
    said_lines.clear();
    start();
    const auto found = lost();
    for (const std::string& name : unknown) {
        ASSERT_TRUE(found.count(name)) << name;
        EXPECT_EQ(found.at(name), name);
        const std::string top = name.substr(0, name.find('/', 5));
        EXPECT_THAT(said(), HasSubstr((state() / top).string() + ": "));
    }
    EXPECT_EQ(found.size(), unknown.size());
    EXPECT_TRUE(work_is_empty());
    EXPECT_EQ(base::read_text(state() / "notes"), "mine") << "not one of the server's places";
    EXPECT_TRUE(fs::exists(folder.path() / "state" / "jobs.db")) << "nothing was followed";
    is_as_before(good);
    EXPECT_EQ(text_of(good.id, "result.json"), fake_result + "\n");
    EXPECT_EQ(jobs->list({}, 9, "").jobs.size(), 2u);
    said_lines.clear();
    start();
    EXPECT_EQ(said(), "");
    EXPECT_EQ(lost().size(), unknown.size());
}

std::vector<std::string> damaged_texts() {
    const std::string nested = std::string(300000, '[') + std::string(300000, ']');
    return {std::string("\xff\xfe\0", 3),
            std::string("\0\0\0", 3),
            "",
            "{",
            "{}",
            "null",
            "[[]]",
            "\x80",
            nested,
            R"({"id": 1})",
            R"({"schema_version": 1, "name": 2})",
            fake_result.substr(0, 99)};
}

// What a recommendation found must not answer a run of its scenario.
TEST_F(Recovery, TellsARecommendationFromARun) {
    start();
    JobRequest request = request_of("echo '" +
                                    nlohmann::json::parse(fake_result)
                                        .patch(nlohmann::json::parse(
                                            R"([{"op": "add", "path": "/recommendation",
                                                 "value": {"request": {"error": 0.1}}}])"))
                                        .dump() +
                                    "' >result.json");
    request.recommend = R"({"error":0.1})";
    request.pictures = false;
    std::vector<JobInfo> asked;
    for (int i = 0; i < 2; ++i) asked.push_back(wait_for_end(jobs->submit(request).job.id));
    stop();
    remove_database();
    fs::remove(state() / "jobs" / asked[1].id / ".job.json");
    start();
    is_as_before(asked[0]);
    EXPECT_EQ(jobs->find(asked[1].id)->recommend, request.recommend) << "read from its result";
    EXPECT_EQ(jobs->find(asked[1].id)->pictures, false);
}

TEST_F(Recovery, ReadsResultsWhoseRecordIsDamaged) {
    start();
    std::vector<std::string> records = damaged_texts();
    records.push_back(R"({"id": "j", "name": "n", "attempts": 1e300})");
    std::vector<std::string> ids;
    for ([[maybe_unused]] const std::string& text : records) ids.push_back(run(success).id);
    stop();
    for (std::size_t i = 0; i < ids.size(); ++i) write(state() / "jobs" / ids[i] / ".job.json", records[i]);
    remove_database();
    start();
    for (const std::string& id : ids) {
        const auto job = jobs->find(id);
        ASSERT_TRUE(job);
        EXPECT_EQ(job->state, JobState::succeeded);
        EXPECT_EQ(job->scenario_hash, "hash of fake") << "as result.json has it";
        EXPECT_EQ(text_of(id, "result.json"), fake_result + "\n");
        EXPECT_THAT(said(), HasSubstr(id));
    }
    EXPECT_TRUE(lost().empty());
    said_lines.clear();
    start();
    EXPECT_EQ(said(), "");
}

TEST_F(Recovery, MovesDamagedResultsAway) {
    std::vector<std::string> damaged = damaged_texts();
    const std::string scenario = R"("scenario":{)";
    damaged.push_back(fake_result);
    damaged.back().insert(fake_result.find(scenario) + scenario.size(),
                          "\"a\":" + std::string(300000, '[') + std::string(300000, ']') + ",");
    start();
    std::map<std::string, std::string> results;
    for (const std::string& text : damaged)
        for ([[maybe_unused]] const bool with_record : {true, false}) results[run(success).id] = text;
    const JobInfo good = run(success);
    stop();
    bool with_record = false;
    for (const auto& [id, text] : results) {
        write(state() / "jobs" / id / "result.json", text);
        if (with_record = !with_record; !with_record) fs::remove(state() / "jobs" / id / ".job.json");
    }
    remove_database();
    start();
    const auto found = lost();
    for (const auto& [id, text] : results) {
        EXPECT_FALSE(jobs->find(id));
        ASSERT_TRUE(found.count("jobs/" + id + "/result.json"));
        EXPECT_EQ(found.at("jobs/" + id + "/result.json"), text);
        EXPECT_THAT(said(), HasSubstr((state() / "jobs" / id).string() + ": its result.json "));
    }
    is_as_before(good);
    said_lines.clear();
    start();
    EXPECT_EQ(said(), "");
}

// The texts of damaged records do not stop the sweep of work/ either.
TEST_F(Recovery, MovesWorkWithADamagedRecordAway) {
    start();
    stop();
    const std::string id = "j-0123456789abcdef";
    for (const char* use : {"-copy", "-removed"})
        write(state() / "work" / (id + use) / ".job.json", std::string("\xff\xfe\0", 3));
    start();
    for (const char* use : {"-copy", "-removed"}) {
        EXPECT_EQ(lost().count("work/" + id + use + "/.job.json"), 1u);
        EXPECT_THAT(said(), HasSubstr(id + use));
    }
}

TEST_F(Recovery, LeavesWhatTheStorageCannotRead) {
    start();
    const JobInfo record = run(success), result = run(success), whole = run(success), copy = run(success);
    stop();
    fs::rename(state() / "jobs" / copy.id, state() / "work" / (copy.id + "-copy"));
    const std::map<fs::path, fs::perms> closed{{state() / "jobs" / record.id / ".job.json", fs::perms(0644)},
                                               {state() / "jobs" / result.id / "result.json", fs::perms(0644)},
                                               {state() / "jobs" / whole.id, fs::perms(0755)},
                                               {state() / "work" / (copy.id + "-copy") / ".job.json", fs::perms(0644)}};
    for (const auto& [place, open] : closed) fs::permissions(place, fs::perms::none);
    remove_database();
    {
        const Unprivileged unprivileged;
        start();
    }
    for (const auto& [place, open] : closed) {
        EXPECT_TRUE(fs::exists(place)) << place;
        EXPECT_THAT(said(), HasSubstr(place.string()));
    }
    EXPECT_TRUE(jobs->list({}, 9, "").jobs.empty());
    EXPECT_TRUE(lost().empty());
    stop();
    for (const auto& [place, open] : closed) fs::permissions(place, open);
    start();
    for (const JobInfo& job : {record, result, whole}) is_as_before(job);
    EXPECT_TRUE(lost().empty());
}

// A copy of results that lies in work/ is somebody's: a job in the database is not copied any more.
TEST_F(Recovery, DeletesNoCopyOfResultsThatStand) {
    start();
    const JobInfo job = run(success);
    stop();
    for (const char* use : {"-copy", "-removed", "-1"})
        fs::copy(state() / "jobs" / job.id, state() / "work" / (job.id + use), fs::copy_options::recursive);
    start();
    is_as_before(job);
    EXPECT_EQ(text_of(job.id, "result.json"), fake_result + "\n");
    for (const char* use : {"-copy", "-removed", "-1"})
        EXPECT_EQ(lost()["work/" + job.id + use + "/result.json"], fake_result + "\n");
}

TEST_F(Recovery, RemovesNoJobForTheFolderOfAnother) {
    start();
    const std::string runs = submit(endless), waits = submit(success);
    wait_for_run(runs);
    const std::string cancelled = submit(success);
    jobs->cancel(cancelled);
    stop();
    for (const std::string& id : {runs, waits, cancelled}) write(state() / "work" / (id + "-removed") / "x", id);
    start();
    for (const std::string& id : {runs, waits, cancelled}) {
        EXPECT_TRUE(jobs->find(id));
        EXPECT_EQ(lost()["work/" + id + "-removed/x"], id);
    }
    const JobInfo missing = [&] {
        jobs->cancel(runs);
        return wait_for_end(waits);
    }();
    stop();
    fs::remove_all(state() / "jobs" / missing.id);
    write(state() / "work" / (missing.id + "-removed") / "y", "y");
    start();
    EXPECT_TRUE(jobs->find(missing.id));
    EXPECT_EQ(lost()["work/" + missing.id + "-removed/y"], "y");
}

// A job's folder in work/ is half of something only as long as somebody knows the job.
TEST_F(Recovery, KeepsWhatRanWhenTheDatabaseIsLost) {
    start();
    const std::string id = submit("echo part >part; " + endless);
    wait_for_run(id);
    stop();
    write(state() / "work" / (id + "-1") / "scenario.json", "its only copy");
    remove_database();
    start();
    EXPECT_EQ(lost()["work/" + id + "-1/scenario.json"], "its only copy");
}

TEST_F(Recovery, LeavesTheDatabasesOfOthersWhereTheyAre) {
    start();
    const JobInfo job = run(success);
    stop();
    fs::rename(database(), copy());
    sqlite::Database(database(), sqlite::Database::Access::write, 7).execute("CREATE TABLE jobs (x)");
    const std::string before = base::read_text(database());
    try {
        start();
        ADD_FAILURE();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
        EXPECT_EQ(error.where(), database().string());
        EXPECT_THAT(error.message(), HasSubstr("another program's"));
    }
    EXPECT_EQ(base::read_text(database()), before);
    remove_database();
    fs::rename(copy(), database());
    start();
    is_as_before(job);
}

// SQLite would delete it, with the jobs that it has and the database does not have yet.
TEST_F(Recovery, KeepsWhatLaySideBySideWithALostDatabase) {
    start();
    stop();
    remove_database();
    write(database().string() + "-wal", "changes");
    start();
    EXPECT_EQ(lost()["jobs.db-wal"], "changes");
    EXPECT_THAT(said(), HasSubstr("jobs.db-wal"));
}

TEST_F(Recovery, TheStateFolderMayBeALink) {
    fs::create_directory(folder.path() / "real");
    fs::create_directory_symlink("real", state());
    start();
    const JobInfo job = run(success);
    remove_database();
    start();
    is_as_before(job);
}

TEST_F(Recovery, TellsOfResultsThatAreMissing) {
    start();
    const JobInfo job = run(success), other = run(success);
    stop();
    fs::remove_all(state() / "jobs" / job.id);
    start();
    EXPECT_THAT(said(), HasSubstr(job.id));
    EXPECT_THAT(said(), Not(HasSubstr(other.id)));
    EXPECT_EQ(jobs->find(job.id)->state, JobState::succeeded);
}

TEST_F(Recovery, RecordsAreHiddenAndOfOneJob) {
    start();
    const JobInfo job = run(success);
    EXPECT_EQ(jobs->artifacts(job.id), std::vector<std::string>{"result.json"});
    EXPECT_FALSE(jobs->artifact(job.id, ".job.json"));
    stop();
    const std::string twin = "j-0123456789abcdef";
    fs::copy(state() / "jobs" / job.id, state() / "jobs" / twin, fs::copy_options::recursive);
    start();
    EXPECT_EQ(jobs->find(twin)->state, JobState::succeeded) << "a copy that somebody made is a job of its own";
    EXPECT_EQ(jobs->scenario(twin), jobs->scenario(job.id));
}

}  // namespace
}  // namespace shadowbench::service

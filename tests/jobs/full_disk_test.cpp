// A server whose disk is full: its jobs wait, and go on when there is space. The disk is a small one in memory; where
// none can be mounted these tests are skipped.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/error.h"
#include "jobs/job_host.h"
#include "service/jobs/backup.h"
#include "service/jobs/reserve.h"
#include "service/jobs/room.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t disk = std::size_t{4} << 20;

class FullDisk : public JobHost {
protected:
    void SetUp() override {
        JobHost::SetUp();
        fs::create_directories(state());
        const std::string options = "size=" + std::to_string(disk);
        if (::mount("tmpfs", state().c_str(), "tmpfs", 0, options.c_str()) != 0)
            GTEST_SKIP() << "no file system can be mounted here: " << std::strerror(errno);
        mounted = true;
    }
    void TearDown() override {
        jobs.reset();
        if (mounted) ::umount2(state().c_str(), MNT_DETACH);
    }

    // Takes all space but so many bytes.
    void fill(std::uintmax_t left = 0) const {
        const int file = ::open((state() / "filler").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
        const std::string page(4096, 'x');
        while (fs::space(state()).available > left && ::write(file, page.data(), page.size()) > 0) {
        }
        ::close(file);
    }
    void empty() const { fs::remove(state() / "filler"); }

    void wait_for_fault(bool fails) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (jobs->storage_fails() != fails && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        EXPECT_EQ(jobs->storage_fails(), fails);
    }
    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    static std::size_t count(const std::string& text, const std::string& part) {
        std::size_t found = 0;
        for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
        return found;
    }
    // Does what it should, or says as the program does that its folder takes nothing.
    std::string writes(std::size_t bytes) const {
        return "echo x >>" + path("runs") + "; head -c " + std::to_string(bytes) + " /dev/zero >big && echo '" +
               fake_result + "' >result.json || " + "{ echo '{\"storage\":{\"message\":\"full\"}}'; exit 74; }";
    }
    // A disk that a job fills at this moment takes no submission.
    std::string submit_once_there_is_room(const std::string& text) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (true) {
            try {
                return submit(text);
            } catch (const base::Error&) {
                if (std::chrono::steady_clock::now() > end) throw;
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        }
    }
    std::size_t runs() const { return fs::exists(path("runs")) ? count(base::read_text(path("runs")), "x") : 0; }

    bool mounted = false;
};

TEST_F(FullDisk, LetsJobsWaitAndGoOn) {
    limits.parallel = 2;
    start();
    EXPECT_FALSE(jobs->storage_fails());
    std::vector<std::string> ids;
    for (int i = 0; i < 2; ++i)
        ids.push_back(submit("echo '{\"stage\":\"build\"}'; while [ ! -e " + path("gate") +
                             " ]; do sleep 0.02; done; " + success));
    for (const std::string& id : ids) wait_for_run(id);
    for (int i = 0; i < 5; ++i) ids.push_back(submit(success));
    fill();
    std::ofstream(path("gate")) << "x";
    wait_for_fault(true);
    std::this_thread::sleep_for(std::chrono::seconds(2));  // for what should not happen
    EXPECT_EQ(jobs->count(JobState::failed), 0u);
    EXPECT_EQ(jobs->count(JobState::succeeded), 0u);
    EXPECT_THROW(submit(success), base::Error);
    EXPECT_EQ(count(said(), "cannot be written"), 1u) << said();
    empty();
    for (const std::string& id : ids) {
        const JobInfo job = wait_for_end(id);
        EXPECT_EQ(job.state, JobState::succeeded);
        EXPECT_EQ(job.attempts, 1) << "it is not a fault of the job";
        EXPECT_EQ(text_of(id, "result.json"), fake_result + "\n");
    }
    wait_for_fault(false);
    EXPECT_THAT(said(), HasSubstr("written again"));
    EXPECT_EQ(run(success).state, JobState::succeeded);
    EXPECT_TRUE(work_is_empty());
}

// It is not run again and again while there is no more room than it had.
TEST_F(FullDisk, LetsAJobWaitThatNeedsMoreThanThereIs) {
    start();
    fill(std::size_t{1} << 20);
    const std::string id = submit(writes(std::size_t{2} << 20)), next = submit_once_there_is_room(success);
    wait_for_fault(true);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    EXPECT_EQ(jobs->find(id)->state, JobState::queued);
    EXPECT_EQ(jobs->find(id)->attempts, 0);
    EXPECT_EQ(jobs->find(id)->position, 0u) << "at its old place";
    EXPECT_EQ(jobs->find(next)->state, JobState::queued);
    EXPECT_EQ(runs(), 1u);
    EXPECT_THAT(said(), HasSubstr("full"));
    empty();
    EXPECT_EQ(wait_for_end(id).state, JobState::succeeded);
    EXPECT_EQ(wait_for_end(next).state, JobState::succeeded);
    EXPECT_EQ(runs(), 2u);
}

TEST_F(FullDisk, WaitsNoLongerForAJobThatIsCancelled) {
    start();
    fill(std::size_t{1} << 20);
    const std::string id = submit(writes(std::size_t{2} << 20)), next = submit_once_there_is_room(success);
    wait_for_fault(true);
    while (jobs->find(id)->state == JobState::running) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(jobs->cancel(id), Jobs::Change::done);
    EXPECT_EQ(wait_for_end(next).state, JobState::succeeded);
    wait_for_fault(false);
}

TEST_F(FullDisk, StopsWhileItWaits) {
    start();
    fill(std::size_t{1} << 20);
    const std::string id = submit(writes(std::size_t{2} << 20));
    wait_for_fault(true);
    jobs->stop();
    EXPECT_EQ(jobs->find(id)->state, JobState::queued);
    empty();
    start();
    EXPECT_EQ(wait_for_end(id).state, JobState::succeeded);
}

TEST_F(FullDisk, IsEmptiedByRemovingResults) {
    start();
    const std::string id = submit(writes(std::size_t{2} << 20));
    ASSERT_EQ(wait_for_end(id).state, JobState::succeeded);
    fill();
    EXPECT_EQ(jobs->remove(id), Jobs::Change::done);
    EXPECT_GT(fs::space(state()).available, std::size_t{1} << 20);
    EXPECT_EQ(run(success).state, JobState::succeeded);
    start();
    EXPECT_FALSE(jobs->find(id));
}

// Whoever operates it must be able to make its jobs fewer, also after it was started anew.
TEST_F(FullDisk, CancelsRemovesAndStartsWithNothingLeft) {
    start();
    const std::string failed = run("echo x >&2; exit 65").id, blocks = submit(endless);
    wait_for_run(blocks);
    std::vector<std::string> ids;
    for (int i = 0; i < 40; ++i) ids.push_back(submit(success));
    EXPECT_EQ(fs::file_size(state() / "shadowbench-reserve"), reserve_bytes);
    const auto cancel_and_remove = [&](const std::string& id) {
        EXPECT_EQ(jobs->cancel(id), Jobs::Change::done) << id;
        EXPECT_EQ(jobs->remove(id), Jobs::Change::done) << id;
        EXPECT_FALSE(jobs->find(id));
    };
    for (std::size_t i = 0; i < 20; ++i) {
        fill();
        cancel_and_remove(ids[i]);
    }
    EXPECT_EQ(jobs->remove(failed), Jobs::Change::done);
    empty();
    start();
    EXPECT_TRUE(fs::exists(state() / "shadowbench-reserve")) << "it is taken again once there is space";
    fill();
    jobs.reset();
    fill();  // a server that stops gives the space of its log back
    ASSERT_NO_THROW(start());
    EXPECT_FALSE(fs::exists(state() / "shadowbench-reserve"));
    for (std::size_t i = 20; i < 36; ++i) cancel_and_remove(ids[i]);
    empty();
    start();
    EXPECT_EQ(jobs->cancel(blocks), Jobs::Change::done);
    for (std::size_t i = 36; i < ids.size(); ++i) EXPECT_EQ(wait_for_end(ids[i]).state, JobState::succeeded);
    EXPECT_EQ(run(success).state, JobState::succeeded);
}

// Where no server runs, SQLite would make a file of 32 KiB beside the database to read it.
TEST_F(FullDisk, IsCheckedAndBackedUpWithNothingLeft) {
    start();
    const std::string id = run(success + "echo a,b >result.csv\n").id;
    const auto copy = [&](const fs::path& from, const fs::path& to) {
        for (const char* name : {"jobs.db", "jobs.db-wal"})
            fs::copy_file(from / name, to / name, fs::copy_options::overwrite_existing);
    };
    copy(state(), folder.path());
    jobs.reset();
    fill();
    EXPECT_THAT(check_state(state()), IsEmpty());
    EXPECT_EQ(back_up(state(), folder.path() / "first"), 1u);
    empty();
    copy(folder.path(), state());  // as a killed server leaves them
    const auto left = fs::file_size(state() / "jobs.db-wal");
    ASSERT_GT(left, 0u);
    fs::remove(state() / "jobs.db-shm");
    fill();
    EXPECT_THAT(check_state(state()), IsEmpty());
    EXPECT_EQ(back_up(state(), folder.path() / "second"), 1u);
    EXPECT_EQ(fs::file_size(state() / "jobs.db-wal"), left) << "it is changed by the server alone";
    std::ofstream(state() / "jobs" / id / "result.csv", std::ios::in | std::ios::out) << "c";
    EXPECT_THAT(check_state(state()), ElementsAre(HasSubstr("result.csv: is damaged")));
    empty();
    start();
    EXPECT_EQ(jobs->find(id)->state, JobState::succeeded);
}

TEST_F(FullDisk, LosesNothingWhereAServerCannotStart) {
    start();
    const JobInfo done = run(success);
    const std::string blocks = submit(endless), waits = submit(success);
    wait_for_run(blocks);
    jobs.reset();
    std::ofstream(state() / "work" / "unknown") << "x";
    fill();
    try {
        start();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
    }
    jobs.reset();
    empty();
    start();
    EXPECT_EQ(jobs->find(done.id)->state, JobState::succeeded);
    EXPECT_EQ(text_of(done.id, "result.json"), fake_result + "\n");
    EXPECT_TRUE(jobs->find(blocks));
    EXPECT_EQ(jobs->find(waits)->state, JobState::queued);
    EXPECT_FALSE(fs::exists(state() / "work" / "unknown"));
    EXPECT_THAT(said(), HasSubstr("lost+found"));
}

// The program itself, whose results and pictures are more than there is room for.
TEST_F(FullDisk, LetsTheProgramsJobsWait) {
    for (const std::size_t left : {std::size_t{48} << 10, std::size_t{100} << 10}) {
        start(SHADOWBENCH_PROGRAM);
        const std::string id = submit(std::string(tiny_scenario) + std::string(left % 7, ' '));
        fill(left);
        wait_for_fault(true);
        std::this_thread::sleep_for(std::chrono::seconds(2));
        EXPECT_EQ(jobs->find(id)->state, JobState::queued) << "it is not run again before there is room";
        EXPECT_THAT(said(), HasSubstr("No space left"));
        empty();
        const JobInfo end = wait_for_end(id);
        EXPECT_EQ(end.state, JobState::succeeded) << (end.fault ? end.fault->message : "");
        EXPECT_EQ(end.attempts, 1);
        EXPECT_TRUE(jobs->artifact(id, "images/images.json"));
        jobs.reset();
    }
}

// Less than --min-free is left, and that is enough to write small files: no job starts, and none fails.
TEST_F(FullDisk, StartsNoJobBelowTheFreeSpaceAskedFor) {
    limits.min_free = std::size_t{1} << 20;
    start();
    EXPECT_EQ(run(success).state, JobState::succeeded);
    fill(std::size_t{768} << 10);
    EXPECT_TRUE(jobs->storage().is_low());
    EXPECT_GT(jobs->storage().free.value_or(0), std::size_t{512} << 10);
    std::vector<std::string> ids;
    for (int i = 0; i < 6; ++i) ids.push_back(submit("echo x >>" + path("runs") + "; " + success));
    wait_for_fault(true);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(jobs->count(JobState::queued), 6u);
    EXPECT_EQ(runs(), 0u);
    EXPECT_THAT(said(), HasSubstr("--min-free"));
    EXPECT_EQ(jobs->cancel(ids[0]), Jobs::Change::done);
    EXPECT_EQ(jobs->remove(ids[0]), Jobs::Change::done);
    ids.erase(ids.begin());
    empty();
    for (const std::string& id : ids) EXPECT_EQ(wait_for_end(id).state, JobState::succeeded) << "by itself";
    EXPECT_FALSE(jobs->storage().is_low());
    wait_for_fault(false);
}

// A fault of input or output while little space is left is not held against the job.
TEST_F(FullDisk, BlamesTheDiskBeforeTheJob) {
    limits.min_free = std::size_t{1} << 20;
    start();
    const std::string id =
        submit("echo x >>" + path("runs") + "; [ $(wc -l <" + path("runs") + ") = 1 ] || { " + success +
               " exit 0; }; echo '{\"stage\":\"build\"}'; while [ ! -e " + path("gate") + " ]; do sleep 0.02; done; " +
               "echo '{\"error\":{\"code\":74,\"where\":\"x\",\"message\":\"full\"}}'; exit 74");
    wait_for_run(id);
    fill(std::size_t{512} << 10);
    std::ofstream(path("gate")) << "x";
    wait_for_fault(true);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(jobs->find(id)->state, JobState::queued);
    EXPECT_EQ(runs(), 1u);
    empty();
    const JobInfo job = wait_for_end(id);
    EXPECT_EQ(job.state, JobState::succeeded);
    EXPECT_EQ(job.attempts, 1);
    EXPECT_EQ(runs(), 2u);
    // With space enough, the same fault is its own.
    const JobInfo own = run("echo '{\"error\":{\"code\":74,\"where\":\"x\",\"message\":\"own\"}}'; exit 74");
    EXPECT_EQ(own.state, JobState::failed);
    EXPECT_EQ(own.fault->code, 74);
}

// Else it would take the space, die and start again without end.
TEST_F(FullDisk, BlamesAJobThatTakesTheSpaceItself) {
    limits.min_free = std::size_t{1} << 20;
    start();
    const JobInfo job =
        run("head -c 3300000 /dev/zero >big; "
            "echo '{\"error\":{\"code\":74,\"where\":\"x\",\"message\":\"own\"}}'; exit 74");
    EXPECT_EQ(job.state, JobState::failed);
    ASSERT_TRUE(job.fault);
    EXPECT_EQ(job.fault->message, "own");
}

TEST_F(FullDisk, RoomIsWhatCanBeWritten) {
    EXPECT_TRUE(has_room(state(), least_room));
    EXPECT_TRUE(has_room(state(), disk / 2));
    EXPECT_FALSE(has_room(state(), disk * 2));
    EXPECT_EQ(bytes_in(state()), 0u) << "and it is given back";
    fill(std::size_t{16} << 10);
    EXPECT_FALSE(has_room(state(), 0));
    EXPECT_GE(bytes_in(state()), disk - (std::size_t{64} << 10));
    EXPECT_FALSE(has_room(state() / "nowhere", 0));
    empty();
    EXPECT_EQ(::mount("tmpfs", state().c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr), 0);
    EXPECT_FALSE(has_room(state(), 0)) << "it takes nothing";
}

}  // namespace
}  // namespace shadowbench::service

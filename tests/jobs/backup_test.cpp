#include "service/jobs/backup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "jobs/job_host.h"
#include "service/store/database.h"
#include "service/store/store_kind.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Backups : public JobHost {
protected:
    fs::path copy() const { return folder.path() / "copy"; }
};

TEST_F(Backups, AreWholeWhileTheServerRuns) {
    start();
    const std::string done = run(success).id, runs = submit(endless);
    wait_for_run(runs);
    const std::string waits = submit(success);
    EXPECT_EQ(back_up(state(), copy()), 3u);
    EXPECT_THAT(check_state(copy()), IsEmpty());
    EXPECT_FALSE(fs::exists(copy().string() + ".partial"));
    jobs->cancel(runs);
    wait_for_end(waits);
    jobs.reset();
    const std::string result = "changed after the copy was made";
    std::ofstream(state() / "jobs" / done / "result.json") << result;
    // The copy serves as a state folder: the job that ran waits again.
    const Jobs other(copy(), program.string(), data, limits);
    EXPECT_EQ(other.find(done)->state, JobState::succeeded);
    EXPECT_NE(base::read_text(*other.artifact(done, "result.json")), result);
    EXPECT_TRUE(other.find(runs)->state == JobState::queued || other.find(runs)->state == JobState::running);
    EXPECT_TRUE(other.find(waits));
}

TEST_F(Backups, AreNeverWrittenOverOtherFiles) {
    start();
    run(success);
    fs::create_directories(copy());
    std::ofstream(copy() / "mine") << "x";
    EXPECT_THROW(back_up(state(), copy()), base::Error);
    EXPECT_EQ(base::read_text(copy() / "mine"), "x");
    fs::remove(copy() / "mine");
    EXPECT_EQ(back_up(state(), copy()), 1u) << "an empty folder is taken";
    EXPECT_THROW(back_up(folder.path() / "none", folder.path() / "other"), base::Error);
    EXPECT_FALSE(fs::exists(folder.path() / "other.partial")) << "nothing is left of what failed";
    for (const char* inside : {"new", "work/new", "../state/jobs/new"})
        EXPECT_THROW(back_up(state(), state() / inside), base::Error) << "a start would take it for a stray file";
}

// Its results are published a moment before its row says that it succeeded.
TEST_F(Backups, ChecksDoNotBlameAJobThatIsAboutToEnd) {
    start();
    const std::string runs = submit(endless);
    wait_for_run(runs);
    fs::create_directories(state() / "jobs" / runs);
    EXPECT_THAT(check_state(state()), IsEmpty());
}

TEST_F(Backups, ChecksFindWhatIsDamagedMissingOrUnknown) {
    start();
    const std::string damaged = run(success + "echo a,b >result.csv\n").id, missing = run(success).id;
    EXPECT_THAT(check_state(state()), IsEmpty()) << "while the server runs";
    jobs.reset();
    {
        std::fstream file(state() / "jobs" / damaged / "result.csv");
        file << "c";  // of the same size
    }
    fs::remove_all(state() / "jobs" / missing);
    fs::create_directories(state() / "jobs" / "mine");
    const std::vector<std::string> faults = check_state(state());
    EXPECT_THAT(faults, ::testing::UnorderedElementsAre(HasSubstr("result.csv: is damaged"),
                                                        HasSubstr(missing + ": the results of this job are missing"),
                                                        HasSubstr("mine: the database has no such job")));
    fs::remove(state() / "jobs" / damaged / "result.csv");
    EXPECT_THAT(check_state(state()), ::testing::Contains(HasSubstr("result.csv: is missing")));
}

// A fault of the database hides none of the results.
TEST_F(Backups, ChecksResultsBesideADatabaseThatCannotBeRead) {
    start();
    const std::string damaged = run(success + "echo a,b >result.csv\n").id;
    run(success);
    jobs.reset();
    sqlite::Database(state() / "jobs.db", sqlite::Database::Access::write, store_application)
        .execute("DROP TABLE keys");
    std::ofstream(state() / "jobs" / damaged / "result.csv", std::ios::in | std::ios::out) << "c";
    EXPECT_THAT(check_state(state()), ::testing::ElementsAre(HasSubstr("lacks its table keys"),
                                                             HasSubstr(damaged + "/result.csv: is damaged")));
}

}  // namespace
}  // namespace shadowbench::service

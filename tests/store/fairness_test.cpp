// Owners take turns, within their limits.
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "service/store/database.h"
#include "service/store/job_store.h"
#include "service/store/store_check.h"
#include "service/store/store_kind.h"
#include "store/version_1.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

using Outcome = JobStore::Added::Outcome;

class Fairness : public ::testing::Test {
protected:
    Outcome add(const std::string& id, const std::string& owner, int priority = 0, const OwnerLimits& limits = {}) {
        NewJob job;
        job.id = id;
        job.name = "name of " + id;
        job.key = {"hash", 1, "1.0 abc", true};
        job.scenario = "{}";
        job.created = "2026-11-25T01:02:03.004Z";
        job.owner = owner;
        job.priority = priority;
        job.labels = {"night", id};
        return store->add(job, 1000, limits).outcome;
    }
    std::string claim(const LimitsByOwner& limits = {}) {
        const auto job = store->claim("now", limits);
        return job ? job->id : "none";
    }
    void SetUp() override { store.emplace(file); }

    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "jobs.db";
    std::optional<JobStore> store;
};

// Without turns, the one job of bo would wait for all of ann's.
TEST_F(Fairness, OwnersTakeTurns) {
    for (const char* id : {"a1", "a2", "a3"}) add(id, "ann");
    for (const char* id : {"b1", "b2"}) add(id, "bo");
    std::string order;
    for (int i = 0; i < 6; ++i) order += claim() + " ";
    EXPECT_EQ(order, "a1 b1 a2 b2 a3 none ");
    add("a4", "ann");
    add("b3", "bo");
    store.reset();
    store.emplace(file);
    EXPECT_EQ(claim(), "b3") << "the turns outlive the server: ann's last one is later";
}

TEST_F(Fairness, PriorityCountsAmongTheJobsOfAnOwner) {
    add("a1", "ann");
    add("a2", "ann", 5);
    add("a3", "ann", 5);
    add("b1", "bo", -100);
    std::string order;
    for (int i = 0; i < 4; ++i) order += claim() + " ";
    EXPECT_EQ(order, "a2 b1 a3 a1 ");
}

// The places that a list shows are those in which the jobs are then taken.
TEST_F(Fairness, PlacesInTheQueueAreTheOrderOfTheTurns) {
    std::mt19937 random(7);
    for (int i = 0; i < 40; ++i)
        add("j" + std::to_string(i), std::string(1, static_cast<char>('a' + random() % 4)),
            static_cast<int>(random() % 3));
    for (int i = 0; i < 7; ++i) claim();
    std::map<std::uint64_t, std::string> by_place;
    for (const StoredJob& job : store->list({job_states::queued}, 100, 0)) by_place[*job.ahead] = job.id;
    ASSERT_EQ(by_place.size(), 33u);
    for (std::uint64_t place = 0; place < 33; ++place) EXPECT_EQ(claim(), by_place[place]) << place;
}

TEST_F(Fairness, HoldsOwnersToTheirLimits) {
    const OwnerLimits limits{2, 1, 1000};
    EXPECT_EQ(add("a1", "ann", 0, limits), Outcome::added);
    EXPECT_EQ(add("a2", "ann", 0, limits), Outcome::added);
    EXPECT_EQ(add("a3", "ann", 0, limits), Outcome::owner_full);
    EXPECT_EQ(add("b1", "bo", 0, limits), Outcome::added) << "each has limits of its own";
    const LimitsByOwner by_owner{{"ann", limits}};
    EXPECT_EQ(claim(by_owner), "a1");
    EXPECT_EQ(claim(by_owner), "b1");
    EXPECT_EQ(claim(by_owner), "none") << "one of ann's jobs runs";
    store->end_running("a1", {job_states::succeeded, "then", true, {}, 1000});
    EXPECT_EQ(add("a4", "ann", 0, limits), Outcome::owner_bytes);
    EXPECT_EQ(claim(by_owner), "a2");
}

TEST_F(Fairness, FindsJobsByOwnerLabelAndText) {
    add("a1", "ann");
    add("a2", "ann");
    add("b1", "bo");
    const auto found = [&](const StoreFilter& filter) {
        std::string ids;
        for (const StoredJob& job : store->list(filter, 10, 0)) ids += job.id + " ";
        return ids;
    };
    EXPECT_EQ(found({"", "ann", "", ""}), "a2 a1 ");
    EXPECT_EQ(found({"", "", "b1", ""}), "b1 ");
    EXPECT_EQ(found({"", "", "nigh", ""}), "") << "a label is a whole one";
    EXPECT_EQ(found({"", "", "night", "NAME OF A2"}), "a2 ");
    EXPECT_EQ(found({"", "", "", "%"}), "") << "a text is no pattern";
    EXPECT_EQ(found({"running", "ann", "", ""}), "");
    EXPECT_EQ((store->find("a1")->labels), (std::vector<std::string>{"night", "a1"}));
}

TEST_F(Fairness, RemovesNeitherPinnedJobsNorThoseThatWait) {
    for (const char* id : {"a1", "a2", "a3", "a4"}) add(id, "");
    for (const char* id : {"a2", "a1", "a3"})
        store->end_waiting(id, {job_states::cancelled, std::string("2026-01-0") + id[1] + "T00:00:00.000Z", {}, {}, 0});
    EXPECT_TRUE(store->set_pinned("a2", true));
    EXPECT_FALSE(store->set_pinned("none", true));
    const auto removable = store->list_removable();
    ASSERT_EQ(removable.size(), 2u);
    EXPECT_EQ(removable[0].id, "a1");
    EXPECT_EQ(removable[1].id, "a3");
}

// Every way to change a row must renew its checksum, else fsck would report what is whole.
TEST_F(Fairness, ChecksumsFollowEveryChange) {
    for (const char* id : {"a1", "a2", "a3", "a4"}) add(id, "ann");
    claim();
    claim();
    store->end_running("a1", {job_states::failed, "then", {}, StoredFault{70, "x", "y"}, 0});
    store->requeue_running("a2", false);
    store->retry("a1", "2.0", 10);
    store->end_waiting("a3", {job_states::cancelled, "then", {}, {}, 0});
    store->set_pinned("a4", true);
    store->set_bytes("a4", 5);
    KeptJob kept{*store->find("a3"), "{}", "", ""};
    kept.job.id = "a5";
    store->adopt({kept});
    const StoreContents contents = check_store(file);
    EXPECT_EQ(contents.jobs.size(), 5u);
    EXPECT_TRUE(contents.faults.empty()) << contents.faults[0];
}

TEST_F(Fairness, AChangedRowIsFound) {
    for (const char* id : {"a1", "a2"}) add(id, "ann");
    {
        sqlite::Database database(file, sqlite::Database::Access::write, store_application);
        database.execute("UPDATE jobs SET scenario = '{\"x\": 1}' WHERE id = 'a2'");
    }
    const StoreContents contents = check_store(file);
    ASSERT_EQ(contents.faults.size(), 1u);
    EXPECT_NE(contents.faults[0].find("a2"), std::string::npos);
}

TEST_F(Fairness, ACopyHasAllOfItWhileTheStoreIsInUse) {
    for (const char* id : {"a1", "a2"}) add(id, "ann");
    claim();
    const auto copy = folder.path() / "copy.db";
    copy_store(file, copy);
    const StoreContents contents = check_store(copy);
    EXPECT_TRUE(contents.faults.empty());
    ASSERT_EQ(contents.jobs.size(), 2u);
    EXPECT_EQ(contents.jobs[0].state, job_states::running);
}

TEST_F(Fairness, RowsOfEarlierVersionsGetTheirChecksum) {
    const auto old = folder.path() / "old.db";
    write_version_1(old, "{}");
    EXPECT_ANY_THROW(check_store(old)) << "it says that the file is of an earlier version, and changes nothing";
    { const JobStore opened(old); }
    const StoreContents contents = check_store(old);
    EXPECT_EQ(contents.jobs.size(), 2u);
    EXPECT_TRUE(contents.faults.empty());
}

}  // namespace
}  // namespace shadowbench::service

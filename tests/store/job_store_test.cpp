#include "service/store/job_store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <thread>

#include "base/error.h"
#include "service/store/damaged_store.h"
#include "service/store/database.h"
#include "service/store/store_kind.h"
#include "store/version_1.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using Outcome = JobStore::Added::Outcome;

constexpr std::size_t many = 1000000;

NewJob job_named(const std::string& id) {
    NewJob job;
    job.id = id;
    job.name = "name of " + id;
    job.key = {"hash", 0xffffffffffffffffull, "1.0 abc", true};
    job.scenario = "{\"name\": \"" + id + "\"}";
    job.created = "2026-11-25T01:02:03.004Z";
    return job;
}

class JobStores : public ::testing::Test {
protected:
    void add(const std::string& id) { EXPECT_EQ(store->add(job_named(id), many).outcome, Outcome::added); }
    void reopen() {
        store.reset();
        store.emplace(file);
    }
    std::string state(const std::string& id) const {
        const auto job = store->find(id);
        return job ? job->state : "none";
    }
    void SetUp() override { store.emplace(file); }

    const TemporaryFolder folder;
    const fs::path file = folder.path() / "jobs.db";
    std::optional<JobStore> store;
};

std::string error_of(const fs::path& file) {
    try {
        const JobStore store(file);
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
        EXPECT_EQ(error.where(), file.string());
        return error.message();
    }
    return "";
}

TEST_F(JobStores, KeepWhatTheyWereGivenWhenTheyAreOpenedAgain) {
    NewJob job = job_named("j-1");
    job.scenario = std::string("a\0b", 3) + "\xff";
    store->add(job, many);
    reopen();
    const auto found = store->find("j-1");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->name, "name of j-1");
    EXPECT_EQ(found->state, job_states::queued);
    EXPECT_EQ(found->key.hash, "hash");
    EXPECT_EQ(found->key.seed, 0xffffffffffffffffull);
    EXPECT_EQ(found->key.program, "1.0 abc");
    EXPECT_TRUE(found->key.pictures);
    EXPECT_EQ(found->created, job.created);
    EXPECT_EQ(found->started, "");
    EXPECT_EQ(found->attempts, 0);
    EXPECT_FALSE(found->kept);
    EXPECT_FALSE(found->fault);
    EXPECT_EQ(store->scenario("j-1"), job.scenario);
    EXPECT_FALSE(store->find("j-2"));
    EXPECT_FALSE(store->scenario("j-2"));
}

TEST_F(JobStores, GiveTheOldestJobFirstAndEachOnce) {
    for (const char* id : {"j-1", "j-2", "j-3"}) add(id);
    EXPECT_EQ(store->find("j-3")->ahead, 2u);
    const auto first = store->claim("now");
    ASSERT_TRUE(first);
    EXPECT_EQ(first->id, "j-1");
    EXPECT_EQ(first->state, job_states::running);
    EXPECT_EQ(first->started, "now");
    EXPECT_EQ(first->attempts, 1);
    EXPECT_FALSE(first->ahead);
    EXPECT_EQ(store->find("j-3")->ahead, 1u);
    EXPECT_EQ(store->claim("now")->id, "j-2");
    EXPECT_EQ(store->claim("now")->id, "j-3");
    EXPECT_FALSE(store->claim("now"));
}

TEST_F(JobStores, PutARunningJobBackToItsPlaceInTheQueue) {
    for (const char* id : {"j-1", "j-2"}) add(id);
    store->claim("now");
    EXPECT_TRUE(store->requeue_running("j-1", false));
    EXPECT_EQ(store->find("j-1")->ahead, 0u);
    EXPECT_EQ(store->find("j-1")->started, "");
    EXPECT_EQ(store->claim("now")->attempts, 2);
    EXPECT_TRUE(store->requeue_running("j-1", true));  // an attempt that does not count
    EXPECT_EQ(store->claim("now")->attempts, 2);
    EXPECT_FALSE(store->requeue_running("j-2", false)) << "it waits";
}

TEST_F(JobStores, ChangeAJobOnlyInTheStateThatIsMeant) {
    add("j-1");
    const Ending success{job_states::succeeded, "then", true, {}};
    EXPECT_FALSE(store->end_running("j-1", success));
    store->claim("now");
    EXPECT_FALSE(store->remove("j-1"));
    EXPECT_TRUE(store->end_waiting("j-1", {job_states::cancelled, "then", {}, {}}));
    EXPECT_FALSE(store->end_running("j-1", success)) << "cancelled while it ran";
    EXPECT_FALSE(store->end_waiting("j-1", success));
    EXPECT_EQ(state("j-1"), job_states::cancelled);
    EXPECT_TRUE(store->remove("j-1"));
    EXPECT_FALSE(store->remove("j-1"));
    EXPECT_EQ(state("j-1"), "none");
}

TEST_F(JobStores, QueueOnceMoreWhatFailedOrWasCancelled) {
    using Retry = JobStore::Retry;
    for (const char* id : {"j-1", "j-2", "j-3"}) add(id);
    EXPECT_EQ(store->retry("j-1", "2.0 def", many).outcome, Retry::refused) << "it waits";
    store->claim("now");
    EXPECT_EQ(store->retry("j-1", "2.0 def", many).outcome, Retry::refused) << "it runs";
    EXPECT_TRUE(store->end_running("j-1", {job_states::failed, "then", {}, StoredFault{70, "here", "a fault"}}));
    EXPECT_TRUE(store->end_waiting("j-3", {job_states::cancelled, "then", {}, {}}));
    EXPECT_EQ(store->retry("j-1", "2.0 def", 1).outcome, Retry::full) << "j-2 waits";
    EXPECT_EQ(state("j-1"), job_states::failed);
    const std::uint64_t before = store->find("j-1")->revision;
    const JobStore::Retried retried = store->retry("j-1", "2.0 def", 2);
    EXPECT_EQ(retried.outcome, Retry::queued);
    EXPECT_GT(retried.revision, before);
    const auto job = store->find("j-1");
    EXPECT_EQ(job->state, job_states::queued);
    EXPECT_EQ(job->revision, retried.revision);
    EXPECT_EQ(job->attempts, 0);
    EXPECT_EQ(job->started + job->ended, "");
    EXPECT_FALSE(job->fault);
    EXPECT_EQ(job->ahead, 0u) << "at its old place";
    EXPECT_EQ(job->key.program, "2.0 def") << "its result is that of this version";
    EXPECT_EQ(store->retry("j-3", "2.0 def", many).outcome, Retry::queued);
    EXPECT_EQ(store->claim("now")->id, "j-1");
    EXPECT_TRUE(store->end_running("j-1", {job_states::succeeded, "then", true, {}}));
    EXPECT_EQ(store->retry("j-1", "2.0 def", many).outcome, Retry::refused);
    EXPECT_EQ(store->retry("j-9", "2.0 def", many).outcome, Retry::not_found);
}

TEST_F(JobStores, TellWhyAJobFailed) {
    add("j-1");
    store->claim("now");
    store->end_running("j-1", {job_states::failed, "then", {}, StoredFault{65, "/lights/0", "no such light"}});
    const auto job = store->find("j-1");
    ASSERT_TRUE(job && job->fault);
    EXPECT_EQ(job->fault->code, 65);
    EXPECT_EQ(job->fault->where, "/lights/0");
    EXPECT_EQ(job->fault->message, "no such light");
    EXPECT_EQ(job->ended, "then");
}

TEST_F(JobStores, AnswerTheSameRequestOfOneKeyWithTheSameJob) {
    NewJob first = job_named("j-1"), again = job_named("j-2"), other = job_named("j-3");
    first.idempotency_key = again.idempotency_key = other.idempotency_key = "key";
    first.request = again.request = "a";
    other.request = "b";
    EXPECT_FALSE(store->find_key("key", "a"));
    EXPECT_EQ(store->add(first, many).outcome, Outcome::added);
    reopen();
    const auto second = store->add(again, 0);  // no matter how full the queue is
    EXPECT_EQ(second.outcome, Outcome::existing);
    EXPECT_EQ(second.job.id, "j-1");
    EXPECT_EQ(store->add(other, many).outcome, Outcome::conflict);
    EXPECT_EQ(store->find_key("key", "a")->outcome, Outcome::existing);
    EXPECT_EQ(store->count(job_states::queued), 1u);
    EXPECT_TRUE(store->remove("j-1"));
    EXPECT_EQ(store->add(other, many).outcome, Outcome::added) << "the key goes with its job";
}

TEST_F(JobStores, RefuseMoreThanMayWait) {
    add("j-1");
    EXPECT_EQ(store->add(job_named("j-2"), 1).outcome, Outcome::full);
    EXPECT_EQ(state("j-2"), "none");
    NewJob ended = job_named("j-3");
    ended.kept = false;
    EXPECT_EQ(store->add(ended, 1).outcome, Outcome::added) << "it does not wait";
    EXPECT_EQ(state("j-3"), job_states::succeeded);
    EXPECT_TRUE(store->find("j-3")->cached);
}

TEST_F(JobStores, FindTheNewestResultOfEqualValues) {
    for (const char* id : {"j-1", "j-2", "j-3"}) add(id);
    const ResultKey key = job_named("").key;
    EXPECT_FALSE(store->find_result(key));
    for (const char* id : {"j-1", "j-2"}) {
        store->claim("now");
        store->end_running(id, {job_states::succeeded, "then", true, {}});
    }
    EXPECT_EQ(store->find_result(key)->id, "j-2");
    for (int i = 0; i < 5; ++i) {
        ResultKey other = key;
        if (i == 0) other.hash += "x";
        if (i == 1) other.seed = 1;
        if (i == 2) other.program += "x";
        if (i == 3) other.pictures = false;
        if (i == 4) other.recommend = "{}";
        EXPECT_FALSE(store->find_result(other)) << i;
    }
}

TEST_F(JobStores, ListByPagesNewestFirst) {
    for (int i = 1; i <= 5; ++i) add("j-" + std::to_string(i));
    store->claim("now");
    const auto page = store->list({}, 3, 0);
    ASSERT_EQ(page.size(), 3u);
    EXPECT_EQ(page[0].id, "j-5");
    EXPECT_EQ(page[0].ahead, 3u);
    EXPECT_EQ(page[2].ahead, 1u);
    const auto rest = store->list({}, 3, page[2].sequence);
    ASSERT_EQ(rest.size(), 2u);
    EXPECT_EQ(rest[0].ahead, 0u);
    EXPECT_FALSE(rest[1].ahead);
    EXPECT_EQ(store->list({job_states::running}, 9, 0).size(), 1u);
    EXPECT_EQ(store->list({job_states::queued}, 9, 0).size(), 4u);
    EXPECT_EQ(store->count(job_states::queued), 4u);
}

TEST_F(JobStores, NeverGiveARevisionTwice) {
    add("j-1");
    std::uint64_t last = store->find("j-1")->revision;
    for (int server = 0; server < 3; ++server) {
        for (int i = 0; i < 1500; ++i) {
            const std::uint64_t next = store->next_revision();
            ASSERT_GT(next, last);
            last = next;
        }
        reopen();
    }
    store->claim("now");
    EXPECT_GT(store->find("j-1")->revision, last);
}

TEST_F(JobStores, ServeManyThreads) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 20; ++i) {
                const std::string id = "j-" + std::to_string(t) + "-" + std::to_string(i);
                store->add(job_named(id), many);
                EXPECT_TRUE(store->find(id));
                store->list({}, 10, 0);
            }
        });
    std::size_t claimed = 0;
    while (claimed < 80) claimed += store->claim("now").has_value();
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(store->count(job_states::running), 80u);
}

TEST_F(JobStores, RefuseWhatIsNoDatabase) {
    const fs::path other = folder.path() / "other.db";
    std::ofstream(other) << std::string(5000, 'x');
    EXPECT_NE(error_of(other).find("not a database"), std::string::npos) << error_of(other);
    EXPECT_NE(error_of(folder.path() / "nowhere" / "jobs.db"), "");
}

TEST_F(JobStores, RefuseAnotherProgramsDatabase) {
    const fs::path other = folder.path() / "other.db";
    sqlite::Database(other, sqlite::Database::Access::write, 7).execute("CREATE TABLE jobs (x)");
    EXPECT_NE(error_of(other).find("another program's"), std::string::npos) << error_of(other);
}

TEST_F(JobStores, RefuseADatabaseOfANewerVersion) {
    store.reset();
    sqlite::Database(file, sqlite::Database::Access::write, store_application).execute("PRAGMA user_version = 99");
    EXPECT_NE(error_of(file).find("newer"), std::string::npos) << error_of(file);
}

TEST_F(JobStores, ReadADatabaseOfVersion1) {
    const fs::path old = folder.path() / "old.db";
    write_version_1(old, "{}");
    for (int time = 0; time < 2; ++time) {  // the second time it has this version
        store.emplace(old);
        const auto ended = store->find("j-000000000000000a"), waits = store->find("j-000000000000000b");
        ASSERT_TRUE(ended && waits);
        EXPECT_EQ(ended->state, job_states::succeeded);
        EXPECT_EQ(ended->kept, true);
        EXPECT_EQ(ended->key.recommend, "");
        EXPECT_EQ(waits->state, job_states::queued);
        EXPECT_EQ(waits->key.seed, 5u);
        EXPECT_EQ(store->scenario(waits->id), "{}");
        EXPECT_EQ(store->find_result({"hash", 5, "1.0 abc", true})->id, ended->id);
    }
    NewJob asked = job_named("j-1");
    asked.key.recommend = R"({"error":0.1})";
    EXPECT_EQ(store->add(asked, many).outcome, Outcome::added);
    EXPECT_EQ(store->find("j-1")->key.recommend, asked.key.recommend);
    store.reset();
    sqlite::Database(old, sqlite::Database::Access::write, store_application).execute("PRAGMA user_version = 1");
    EXPECT_NE(error_of(old).find("lacks its table jobs"), std::string::npos) << "it is not of version 1";
}

TEST_F(JobStores, RefuseADatabaseThatLacksATable) {
    store.reset();
    sqlite::Database(file, sqlite::Database::Access::write, store_application).execute("DROP TABLE keys");
    EXPECT_NE(error_of(file).find("lacks its table keys"), std::string::npos) << error_of(file);
}

TEST_F(JobStores, TakeInJobsThatHaveResults) {
    for (const char* id : {"j-ran", "j-waits", "j-over"}) add(id);
    store->claim("now");
    store->end_waiting("j-over", {job_states::cancelled, "then", {}, {}});
    NewJob other = job_named("j-other");
    other.idempotency_key = "taken";
    store->add(other, many);
    std::vector<KeptJob> kept;
    for (const char* id : {"j-ran", "j-waits", "j-over", "j-new", "j-newer"}) {
        const NewJob job = job_named(id);
        KeptJob one;
        one.job.id = id;
        one.job.name = job.name;
        one.job.key = job.key;
        one.job.key.recommend = id == std::string("j-new") ? "{}" : "";
        one.job.created = "created";
        one.job.started = "started";
        one.job.ended = "ended";
        one.job.attempts = 2;
        one.job.kept = false;
        one.scenario = job.scenario;
        one.request = "request";
        kept.push_back(one);
    }
    kept[3].idempotency_key = "free";
    kept[4].idempotency_key = "taken";
    store->adopt(kept);
    reopen();
    for (const char* id : {"j-ran", "j-waits", "j-new", "j-newer"}) {
        const auto job = store->find(id);
        ASSERT_TRUE(job) << id;
        EXPECT_EQ(job->state, job_states::succeeded) << id;
        EXPECT_EQ(job->ended, "ended");
        EXPECT_EQ(job->attempts, 2);
        EXPECT_EQ(job->kept, false);
        EXPECT_EQ(job->key.seed, 0xffffffffffffffffull);
        EXPECT_EQ(store->scenario(id), job_named(id).scenario);
    }
    EXPECT_EQ(store->find("j-new")->key.recommend, "{}");
    EXPECT_EQ(state("j-over"), job_states::cancelled) << "what has ended stays as it did";
    EXPECT_EQ(store->find_key("free", "request")->job.id, "j-new");
    EXPECT_EQ(store->find_key("taken", "")->job.id, "j-other");
    ASSERT_TRUE(store->key_of("j-new"));
    EXPECT_EQ(store->key_of("j-new")->request, "request");
    EXPECT_FALSE(store->key_of("j-newer"));
    EXPECT_EQ(store->list({}, 1, 0).at(0).id, "j-newer") << "as if it had come last";
}

TEST_F(JobStores, AreKnownByTheirFirstBytes) {
    add("j-1");
    EXPECT_EQ(kind_of_store(file), StoreKind::ours) << "while it is open too";
    const fs::path other = folder.path() / "other.db";
    EXPECT_EQ(kind_of_store(other), StoreKind::none);
    std::ofstream(other) << "";
    EXPECT_EQ(kind_of_store(other), StoreKind::none);
    for (const std::string& text : {std::string("SQLite format 3"), std::string(5000, 'x'), std::string(4096, '\0')}) {
        std::ofstream(other) << text;
        EXPECT_EQ(kind_of_store(other), StoreKind::no_database);
    }
    fs::remove(other);
    sqlite::Database(other, sqlite::Database::Access::write, 7).execute("CREATE TABLE jobs (x)");
    EXPECT_EQ(kind_of_store(other), StoreKind::another_programs);
    EXPECT_THROW(kind_of_store(folder.path()), base::Error);
}

TEST_F(JobStores, RefuseADamagedDatabase) {
    for (int i = 0; i < 200; ++i) add("j-" + std::to_string(i));
    store.reset();
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(4096 * 3);
    stream << std::string(4096 * 3, '\x5a');
    stream.close();
    EXPECT_NE(error_of(file).find("damaged"), std::string::npos) << error_of(file);
    EXPECT_THROW(JobStore{file}, DamagedStore);
}

TEST_F(JobStores, LeaveNothingOfATransactionThatFails) {
    add("j-1");
    EXPECT_THROW(store->add(job_named("j-1"), many), base::Error);
    EXPECT_EQ(store->count(job_states::queued), 1u);
    add("j-2");
}

}  // namespace
}  // namespace shadowbench::service

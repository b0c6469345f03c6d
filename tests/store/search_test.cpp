// The search of texts, beside a scan of all jobs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "service/store/database.h"
#include "service/store/job_store.h"
#include "service/store/job_texts.h"
#include "service/store/store_check.h"
#include "service/store/store_kind.h"
#include "store/version_1.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Ids = std::vector<std::string>;

class Search : public ::testing::Test {
protected:
    void SetUp() override { store.emplace(file); }
    void add(const std::string& id, const std::string& name, const std::string& owner = "",
             const std::vector<std::string>& labels = {}) {
        NewJob job;
        job.id = id;
        job.name = name;
        job.key = {"hash", 1, "1.0 abc", true};
        job.scenario = "{}";
        job.created = "2026-11-25T01:02:03.004Z";
        job.owner = owner;
        job.labels = labels;
        store->add(job, 100000);
    }
    Ids find(const StoreFilter& filter, std::size_t limit = 1000, std::int64_t before = 0) const {
        Ids ids;
        for (const StoredJob& job : store->list(filter, limit, before)) ids.push_back(job.id);
        return ids;
    }
    Ids find_text(const std::string& text) const { return find({"", "", "", text}); }
    // Changes the closed file as no server does.
    void change(const std::string& sql) {
        store.reset();
        sqlite::Database(file, sqlite::Database::Access::write, store_application).execute(sql);
    }

    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "jobs.db";
    std::optional<JobStore> store;
};

// The letters of the random texts below, with their lower case.
const std::vector<std::pair<std::string, std::string>> letters = {
    {"a", "a"}, {"A", "a"}, {"b", "b"}, {"B", "b"},   {"ä", "ä"}, {"Ä", "ä"}, {"影", "影"}, {"\"", "\""},
    {"*", "*"}, {" ", " "}, {"-", "-"}, {"\n", "\n"}, {"%", "%"}, {"😀", "😀"}, {"J", "j"},   {"'", "'"}};

std::string lower(const std::string& text) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const auto letter = std::find_if(letters.begin(), letters.end(), [&](const auto& pair) {
            return text.compare(at, pair.first.size(), pair.first) == 0;
        });
        result += letter == letters.end() ? std::string(1, text[at]) : letter->second;
        at += letter == letters.end() ? 1 : letter->first.size();
    }
    return result;
}

bool is_wanted(const StoredJob& job, const StoreFilter& filter) {
    std::string all = "\n" + job.id + "\n" + job.name + "\n" + job.owner + "\n";
    for (const std::string& label : job.labels) all += label + "\n";
    if (job.labels.empty()) all += "\n";
    all += (job.fault ? job.fault->message : "") + "\n";
    return (filter.state.empty() || job.state == filter.state) && (filter.owner.empty() || job.owner == filter.owner) &&
           (filter.label.empty() || std::count(job.labels.begin(), job.labels.end(), filter.label) > 0) &&
           lower(all).find(lower(filter.text)) != std::string::npos;
}

// Texts in memory that do not follow a change find other jobs than a scan of the rows.
TEST_F(Search, FindsWhatAScanFinds) {
    std::mt19937 random(11);
    const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
    const auto text = [&](std::size_t longest) {
        std::string result;
        for (std::size_t i = below(longest + 1); i > 0; --i) result += letters[below(letters.size())].first;
        return result;
    };
    const Ids owners = {"", "Ann", "bä", "b"}, labels = {"ab", "AB", "b", "ä\"a"};
    const Ids states = {"", "queued", "running", "succeeded", "failed", "cancelled"};
    std::size_t found = 0;
    for (int round = 0, number = 0; round < 4; ++round) {
        for (int i = 0; i < 12; ++i) {
            Ids some;
            for (const std::string& label : labels)
                if (below(3) == 0) some.push_back(label);
            add("j-" + std::to_string(number++), text(12), owners[below(owners.size())], some);
        }
        const auto any = [&] { return "j-" + std::to_string(below(static_cast<std::size_t>(number))); };
        while (const auto job = below(6) == 0 ? std::nullopt : store->claim("now"))
            store->end_running(job->id, below(2) == 0
                                            ? Ending{job_states::succeeded, "then", true, {}, 0}
                                            : Ending{job_states::failed, "then", {}, StoredFault{70, "x", text(9)}, 0});
        for (int i = 0; i < 3; ++i) {
            store->retry(any(), "1.0 abc", 100000);
            store->remove(any());
            store->end_waiting(any(), {job_states::cancelled, "then", {}, {}, 0});
        }
        KeptJob kept{*store->find(find({}).front()), "{}", "", ""};
        kept.job.id = "j-" + std::to_string(number++);
        kept.job.name = text(12);
        store->adopt({kept});
        if (round == 2) store.emplace(file);
        const std::vector<StoredJob> all = store->list({}, 1000, 0);
        for (int i = 0; i < 60; ++i) {
            StoreFilter filter{states[below(2) * below(states.size())], owners[below(2) * below(owners.size())], "",
                               text(5)};
            if (below(3) == 0) filter.label = labels[below(labels.size())];
            Ids wanted;
            for (const StoredJob& job : all)
                if (is_wanted(job, filter)) wanted.push_back(job.id);
            ASSERT_EQ(find(filter), wanted)
                << filter.state << "|" << filter.owner << "|" << filter.label << "|" << filter.text;
            found += wanted.size();
        }
    }
    EXPECT_GT(found, 200u);
    const StoreContents contents = check_store(file);
    EXPECT_THAT(contents.faults, IsEmpty());
}

// Jobs of a state that has few are looked at one by one, those of others found by their texts in memory.
TEST_F(Search, FindsByPagesAmongManyJobsOfAState) {
    change(
        "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 2500) "
        "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, owner, labels, revision, "
        "scenario) SELECT 'j-' || i, CASE i % 500 WHEN 0 THEN 'failed' ELSE 'succeeded' END, "
        "'scene ' || (i % 100), 'h', 1, 'p', 1, 0, 'then', 'owner' || (i % 10), 'label' || (i % 4), 1, '{}' FROM n");
    store.emplace(file);
    EXPECT_THAT(find({"succeeded", "", "", "SCENE 7\n"}, 2), ElementsAre("j-2407", "j-2307"));
    EXPECT_THAT(find({"succeeded", "", "", "scene 7\n"}, 2, 2307), ElementsAre("j-2207", "j-2107"));
    EXPECT_THAT(find({"succeeded", "owner7", "label3", "e 7"}, 2), ElementsAre("j-2407", "j-2307"));
    EXPECT_THAT(find({"succeeded", "owner7", "", ""}, 2), ElementsAre("j-2497", "j-2487"));
    EXPECT_THAT(find({"succeeded", "", "label3", ""}, 1, 2499), ElementsAre("j-2495"));
    EXPECT_THAT(find({"", "", "", "9\n"}, 2, 2490), ElementsAre("j-2489", "j-2479")) << "a short text";
    EXPECT_THAT(find({"failed", "", "", "scene"}), ElementsAre("j-2500", "j-2000", "j-1500", "j-1000", "j-500"));
    EXPECT_THAT(find({"succeeded", "", "", "no such scene"}), IsEmpty());
}

// A language of queries, such as that of FTS5 or LIKE, would read these as its operators, or refuse them.
TEST_F(Search, TakesEveryTextAsItIs) {
    const Ids names = {
        "say \"this\" AND that",     "a* OR NOT b", "(NEAR text:x ^y)", "{text}: z", "a\\b'c", "100 %_done",
        std::string("zero\0byte", 9)};
    for (std::size_t i = 0; i < names.size(); ++i) add("j-" + std::to_string(i), names[i]);
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_THAT(find_text(names[i]), ElementsAre("j-" + std::to_string(i))) << names[i];
    for (const char* text : {"\"", "\"this\"", "\" AND", "\"\"", "AND", "* OR", "NOT b", "NEAR", "text:x", "^y", "{",
                             "}: z", "'c", "%_d", "-", "j-0"})
        EXPECT_EQ(find_text(text).empty(), std::string(text) == "\"\"") << text;
    EXPECT_THAT(find_text("this AND that"), IsEmpty()) << "a text, not a question";
    EXPECT_THAT(find_text("this that"), IsEmpty());
    EXPECT_THAT(find_text("say\x80"), IsEmpty());
    EXPECT_THAT(find_text(std::string(30000, 'a')), IsEmpty());
}

// The beginning of a long text is in memory, so that long names take no memory without end; all of it is searched.
TEST_F(Search, FindsTheEndsOfLongTexts) {
    for (const std::size_t length : {300, 990, 1000, 5000}) {
        const std::string id = "j-" + std::to_string(length), name = std::string(length, 'a') + id + "End";
        add(id, name, "ann", {"label"});
        EXPECT_THAT(find_text(id + "end"), ElementsAre(id));
        EXPECT_THAT(find_text(name), ElementsAre(id));
        EXPECT_THAT(find_text("b" + name), IsEmpty());
    }
    EXPECT_THAT(find_text("no such text"), IsEmpty());
    EXPECT_THAT(find({"", "", "label", "0end"}, 2), ElementsAre("j-5000", "j-1000"));
    EXPECT_THAT(find({"", "bob", "label", "end"}), IsEmpty());
    store.emplace(file);
    EXPECT_EQ(find_text("aJ-").size(), 4u);
}

TEST_F(Search, KnowsTheCaseOfAllLetters) {
    add("j-1", "Ärger über ÖL");
    add("j-2", "ΟΔΟΣ");
    add("j-3", "Жук 影の");
    for (const char* text : {"ärger ÜBER öl", "ä", "ÖL", "Ü"}) EXPECT_THAT(find_text(text), ElementsAre("j-1")) << text;
    for (const char* text : {"οδοσ", "οδος", "Σ", "ς"}) EXPECT_THAT(find_text(text), ElementsAre("j-2")) << text;
    for (const char* text : {"жУК", "к ", "影の", "影"}) EXPECT_THAT(find_text(text), ElementsAre("j-3")) << text;
    EXPECT_THAT(find_text("arger"), IsEmpty()) << "accents count";
}

TEST_F(Search, FindsInFilesOfEarlierVersions) {
    add("j-1", "hairball", "ann", {"night"});
    change("DROP INDEX jobs_of_owner; PRAGMA user_version = 3");
    for (int time = 0; time < 2; ++time) {
        store.emplace(file);
        EXPECT_THAT(find_text("AIRBAL"), ElementsAre("j-1"));
        EXPECT_THAT(find({"", "ann", "", ""}), ElementsAre("j-1"));
        EXPECT_THAT(check_store(file).faults, IsEmpty());
    }
    const auto old = folder.path() / "old.db";
    write_version_1(old, "{}");
    store.emplace(old);
    EXPECT_THAT(find_text("000b"), ElementsAre("j-000000000000000b"));
    EXPECT_THAT(check_store(old).faults, IsEmpty());
}

// Earlier programs kept an index of FTS5 beside the rows. In whatever state it is, no job is lost for it.
TEST_F(Search, DropsTheIndexOfEarlierPrograms) {
    for (int i = 0; i < 30; ++i) add("j-" + std::to_string(i), "name " + std::to_string(i));
    const char* cases[] = {"",
                           "DELETE FROM jobs_text WHERE rowid = 3",
                           "DELETE FROM jobs_text_config",
                           "DELETE FROM jobs_text_data WHERE id > 10",
                           "UPDATE jobs_text_data SET block = zeroblob(length(block))",
                           "DROP TABLE jobs_text_idx",
                           "DROP TABLE jobs_text; CREATE TABLE jobs_text (text); INSERT INTO jobs_text VALUES ('name')",
                           "PRAGMA writable_schema = ON; DELETE FROM sqlite_schema WHERE name = 'jobs_text'"};
    int added = 0;
    for (const char* damage : cases) {
        change(
            "CREATE VIRTUAL TABLE jobs_text USING fts5(text, tokenize = 'trigram case_sensitive 1'); "
            "INSERT INTO jobs_text (rowid, text) SELECT sequence, id || char(10) || name FROM jobs");
        change(damage);
        ASSERT_NO_THROW(store.emplace(file)) << damage;
        EXPECT_THAT(find_text("name 7"), ElementsAre("j-7")) << damage;
        add("j-more-" + std::to_string(added++), "more");
        EXPECT_EQ(find_text("J-").size(), 30u + static_cast<unsigned>(added)) << damage;
        const StoreContents contents = check_store(file);
        EXPECT_THAT(contents.faults, IsEmpty()) << damage;
        sqlite::Database database(file, sqlite::Database::Access::read, store_application);
        sqlite::Rows rows(database, "SELECT group_concat(name) FROM sqlite_schema WHERE name LIKE 'jobs_text%'");
        EXPECT_TRUE(rows.next() && rows.null(0)) << damage << ": " << rows.text(0);
    }
}

// The truth is in the rows: what changed while no server ran, as by a copy that was put back, is found.
TEST_F(Search, FindsWhatWasChangedWhileTheStoreWasClosed) {
    for (const char* name : {"one", "two", "three"}) add(std::string("j-") + name, name);
    EXPECT_THAT(find_text("two"), ElementsAre("j-two"));
    change("UPDATE jobs SET name = 'four' WHERE id = 'j-two'; DELETE FROM jobs WHERE id = 'j-one'");
    store.emplace(file);
    EXPECT_THAT(find_text("four"), ElementsAre("j-two"));
    EXPECT_THAT(find_text("one"), IsEmpty());
    EXPECT_THAT(find_text("e"), ElementsAre("j-three"));
}

// A job that changes before, while or after the first search reads the rows must be found as it is then.
TEST_F(Search, MissesNoJobThatIsAddedDuringTheFirstSearch) {
    change(
        "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 5000) "
        "INSERT INTO jobs (id, state, name, hash, seed, program, pictures, cached, created, revision, scenario) "
        "SELECT 'j-' || i, 'failed', 'old', 'h', 1, 'p', 1, 0, 'then', 1, '{}' FROM n");
    store.emplace(file);
    constexpr std::size_t jobs = 40;
    std::atomic<bool> done = false;
    std::thread adds([&] {
        for (std::size_t i = 0; i < jobs; ++i) add("new-" + std::to_string(i), "new");
        done = true;
    });
    for (std::size_t found = 0; !done;) {
        const std::size_t now = find_text("new-").size();
        EXPECT_GE(now, found);
        found = now;
    }
    adds.join();
    EXPECT_EQ(find_text("new-").size(), jobs);
    EXPECT_EQ(find_text("old").size(), 1000u) << "the first page";
}

TEST_F(Search, TextsInMemoryFollowTheRows) {
    for (const char* name : {"one", "two"}) add(std::string("j-") + name, name);
    sqlite::Database rows(file, sqlite::Database::Access::read, store_application);
    JobTexts texts;
    texts.set(1, "not loaded yet");
    EXPECT_THAT(texts.find({"o"}, 10, 9), IsEmpty());
    texts.load(rows);
    EXPECT_THAT(texts.find({"o"}, 10, 9), ElementsAre(2, 1));
    EXPECT_THAT(texts.find({"o"}, 10, 1), ElementsAre(2));
    EXPECT_THAT(texts.find({"o"}, 2, 9), ElementsAre(1));
    EXPECT_THAT(texts.find({"o", "tw"}, 10, 9), ElementsAre(2));
    texts.set(2, "four");
    texts.set(1, "");
    texts.set(3, "three o");
    texts.load(rows);
    EXPECT_THAT(texts.find({"o"}, 10, 9), ElementsAre(3, 2));
    EXPECT_THAT(texts.find({"tw"}, 10, 9), IsEmpty());
}

// A job that is not on the disk is not found.
TEST_F(Search, LeavesNoTextOfATransactionThatFails) {
    add("j-1", "first");
    EXPECT_THROW(add("j-1", "second"), base::Error);
    EXPECT_THAT(find_text("second"), IsEmpty());
    EXPECT_THAT(find_text("first"), ElementsAre("j-1"));
    EXPECT_THAT(check_store(file).faults, IsEmpty());
}

TEST_F(Search, ACopyIsSearchedToo) {
    for (const char* name : {"one", "two"}) add(std::string("j-") + name, name);
    store->remove("j-one");
    const auto copy = folder.path() / "copy.db";
    copy_store(file, copy);
    EXPECT_THAT(check_store(copy).faults, IsEmpty());
    store.emplace(copy);
    EXPECT_THAT(find_text("two"), ElementsAre("j-two"));
}

}  // namespace
}  // namespace shadowbench::service

#include "service/jobs/state_folder.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <map>
#include <set>

#include "base/error.h"
#include "base/read_text.h"
#include "jobs/made_result.h"
#include "service/store/database.h"
#include "service/store/job_store.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class StateFolders : public ::testing::Test {
protected:
    static void write(const fs::path& file, const std::string& text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    // Everything in the folder, links as where they lead.
    std::map<std::string, std::string> all() const {
        std::map<std::string, std::string> found;
        for (const auto& entry : fs::recursive_directory_iterator(path))
            found[entry.path().lexically_relative(path).string()] =
                entry.is_symlink()        ? "-> " + fs::read_symlink(entry.path()).string()
                : entry.is_regular_file() ? base::read_bytes(entry.path())
                                          : "";
        return found;
    }
    void is_refused(const char* says, base::ErrorCode code = base::ErrorCode::usage) const {
        const auto before = all();
        const auto time = fs::last_write_time(path);
        try {
            const StateFolder folder(path, [](const std::string&) {});
            ADD_FAILURE() << "taken: " << says;
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), code);
            EXPECT_THAT(error.where(), HasSubstr(path.string()));
            EXPECT_THAT(error.message(), HasSubstr(says));
        }
        EXPECT_EQ(all(), before);
        EXPECT_EQ(fs::last_write_time(path), time) << "not even for a moment";
    }
    void is_taken() {
        said.clear();
        const StateFolder folder(path, [&](const std::string& line) { said.push_back(line); });
        EXPECT_THAT(base::read_text(path / "shadowbench-state"), HasSubstr("\"layout\":1"));
        EXPECT_TRUE(said.empty());
    }
    void empty() const {
        for (const auto& entry : fs::directory_iterator(path)) fs::remove_all(entry.path());
    }
    void write_result(const std::string& id) const {
        write(path / "jobs" / id / "result.json", text_of(made_result("n")));
    }

    const TemporaryFolder temporary;
    const fs::path path = temporary.path() / "state";
    std::vector<std::string> said;
};

TEST_F(StateFolders, AreMadeWhereThereIsNone) {
    const StateFolder folder(path / "deep" / "down", [](const std::string&) {});
    EXPECT_TRUE(fs::exists(path / "deep" / "down" / "shadowbench-state"));
}

TEST_F(StateFolders, TakeAFolderThatHoldsNothing) {
    fs::create_directories(path);
    is_taken();
    is_taken();
    // What a first start had made when it was killed, and what a new file system has.
    const std::map<std::string, std::string> started{{"lock", ""}, {".shadowbench-state.tmp", "{"}, {"jobs.db", ""}};
    for (const auto& [name, text] : started) {
        empty();
        write(path / name, text);
        is_taken();
    }
    empty();
    for (const char* name : {"jobs", "work", "lost+found"}) fs::create_directories(path / name);
    write(path / "lost+found" / "#12", "x");
    is_taken();
}

TEST_F(StateFolders, LeaveFoldersOfOthersAlone) {
    const char* says = "not a state folder";
    write(path / "work" / "a", "a\n");
    fs::create_directories(path / "jobs");
    is_refused(says);
    for (const char* file :
         {"thesis.tex", "jobs/mine", "work/.hidden", "jobs/j-0123456789abcdef/mine", ".git/config"}) {
        empty();
        write(path / file, "x");
        is_refused(says);
    }
    // A lock or a database that has something in it is somebody's, too.
    for (const char* name : {"lock", "jobs.db"}) {
        empty();
        write(path / name, std::string(5000, 'x'));
        is_refused(says);
    }
    empty();
    sqlite::Database(path / "jobs.db", sqlite::Database::Access::write, 0).execute("CREATE TABLE jobs (id)");
    is_refused(says);
    write_result("j-0123456789abcdef");
    is_refused(says);
    empty();
    sqlite::Database(path / "jobs.db", sqlite::Database::Access::write, 7).execute("CREATE TABLE jobs (id)");
    is_refused(says);
    empty();
    fs::create_symlink("/nowhere/at/all", path / "link");
    is_refused(says);
}

TEST_F(StateFolders, TakeThoseOfEarlierVersions) {
    fs::create_directories(path);
    { JobStore store(path / "jobs.db"); }
    write(path / "work" / "x", "x");
    write(path / "notes", "x");
    is_taken();
    EXPECT_EQ(base::read_text(path / "work" / "x"), "x");
    // Their database is gone, or is broken: then results say whose folder it is.
    for (const std::string& database : {std::string("none"), std::string(""), std::string(9000, 'x')}) {
        empty();
        write_result("j-0123456789abcdef");
        if (database != "none") write(path / "jobs.db", database);
        is_taken();
    }
}

TEST_F(StateFolders, HaveNoLinksInThem) {
    const StateFolder made(path, [](const std::string&) {});
    fs::create_directories(temporary.path() / "elsewhere");
    write(temporary.path() / "file", "x");
    for (const char* name : {"jobs", "work", "lost+found", "jobs.db", "jobs.db-wal"}) {
        const bool folder = fs::path(name).extension().empty();
        fs::create_symlink(temporary.path() / (folder ? "elsewhere" : "file"), path / name);
        is_refused("or a link");
        fs::remove(path / name);
        if (folder)
            write(path / name, "x");
        else
            fs::create_directories(path / name);
        is_refused("expected a f");
        fs::remove(path / name);
    }
    fs::remove(path / "shadowbench-state");
    fs::create_symlink(temporary.path() / "file", path / "shadowbench-state");
    is_refused("or a link");
}

TEST_F(StateFolders, MayBeReachedByALink) {
    fs::create_directories(temporary.path() / "real");
    fs::create_symlink("real", path);
    is_taken();
    EXPECT_TRUE(fs::exists(temporary.path() / "real" / "shadowbench-state"));
}

TEST_F(StateFolders, KnowTheirVersion) {
    fs::create_directories(path);
    write(path / "shadowbench-state", R"({"program": "shadowbench", "layout": 2})");
    is_refused("newer", base::ErrorCode::io);
    for (const char* mark : {"", "\xff\xfex", "x", "[]", "{}", R"({"program": "other", "layout": 1})",
                             R"({"program": "shadowbench"})", R"({"program": "shadowbench", "layout": "1"})"}) {
        write(path / "shadowbench-state", mark);
        is_refused("not the mark");
    }
}

TEST_F(StateFolders, AreNoFiles) {
    std::ofstream(path) << "x";
    try {
        const StateFolder folder(path, [](const std::string&) {});
        ADD_FAILURE();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::usage);
    }
    EXPECT_EQ(base::read_text(path), "x");
}

// However often in one second, and whatever lies there already.
TEST_F(StateFolders, SetAsideAndNeverOverwrite) {
    const auto listen = [&](const std::string& line) { said.push_back(line); };
    for (int i = 0; i < 20; ++i) {
        StateFolder folder(path, listen);
        write(path / "work" / "a", std::to_string(i));
        write(path / "work" / "deep" / "b", std::to_string(i));
        EXPECT_TRUE(folder.set_aside("work/a", "unknown"));
        EXPECT_TRUE(folder.set_aside("work/deep", "unknown"));
        fs::create_symlink("/etc/passwd", path / "work" / "link");
        EXPECT_TRUE(folder.set_aside("work/link", "unknown"));
        write(path / "work" / "a", "another");
        EXPECT_FALSE(folder.set_aside("work/a", "unknown")) << "there is one of this name";
        EXPECT_EQ(base::read_text(path / "work" / "a"), "another");
        fs::remove(path / "work" / "a");
    }
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(path / "lost+found")) {
        found.insert(base::read_text(entry.path() / "work" / "a"));
        EXPECT_EQ(base::read_text(entry.path() / "work" / "deep" / "b"), base::read_text(entry.path() / "work" / "a"));
        EXPECT_TRUE(fs::is_symlink(entry.path() / "work" / "link"));
    }
    EXPECT_EQ(found.size(), 20u);
    ASSERT_EQ(said.size(), 80u);
    EXPECT_THAT(said[0],
                HasSubstr((path / "work" / "a").string() + ": unknown; moved to " + (path / "lost+found").string()));
}

}  // namespace
}  // namespace shadowbench::service

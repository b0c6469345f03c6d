#include "service/privacy/hidden_folders.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

const std::vector<HiddenFolder>& folders() {
    static const auto all = hidden_folders("/var/lib/bench", {"/srv/data", "/srv/data/hair/", "/srv/data 2"});
    return all;
}

TEST(HiddenFolders, FilesHaveTheNamesThatTheClientKnows) {
    EXPECT_EQ(hide("/srv/data/hair/ball.tfx:12", folders()), "ball.tfx:12");
    EXPECT_EQ(hide("/srv/data/smoke.vdb: cut", folders()), "smoke.vdb: cut");
    EXPECT_EQ(hide("/srv/data 2/smoke.vdb: cut", folders()), "smoke.vdb: cut");
    EXPECT_EQ(hide("\"/var/lib/bench/work/j-1/result.json\"", folders()), "\"work/j-1/result.json\"");
    EXPECT_EQ(hide("/srv/data//hair///ball.tfx", folders()), "ball.tfx");
    EXPECT_EQ(hide("file:///srv/data/a.obj, --data=/srv/data/b.obj", folders()), "file:a.obj, --data=b.obj");
    EXPECT_EQ(hide("[/srv/data/a.obj]</srv/data/b.obj>|/srv/data/c.obj", folders()), "[a.obj]<b.obj>|c.obj");
}

TEST(HiddenFolders, AFolderItselfHasAName) {
    EXPECT_EQ(hide("looked in: /srv/data, /srv/data/hair", folders()), "looked in: the data folder, the data folder");
    EXPECT_EQ(hide("looked in /srv/data/", folders()), "looked in the data folder");
    EXPECT_EQ(hide("it is not in /srv/data.", folders()), "it is not in the data folder.");
    EXPECT_EQ(hide("/var/lib/bench: cannot be read", folders()), "the server's folder: cannot be read");
}

TEST(HiddenFolders, OtherNamesAndJsonPointersStay) {
    for (const char* text : {"", "/", "/lights/0/angle", "/srv/database and x/srv/data/y", "/mnt/srv/data/x",
                             "/srv/data.old/x", "/srv/data2/x", "srv/data/x", "1/2 / of a/b"})
        EXPECT_EQ(hide(text, folders()), text);
    EXPECT_EQ(hide("no data here", hidden_folders("", {"data"})), "no data here") << "a word, not a path";
    EXPECT_EQ(hide("/lights/0", hidden_folders("", {"/", "."})), "/lights/0");
}

TEST(HiddenFolders, AreKnownHoweverTheyAreWritten) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "real");
    fs::create_directory_symlink("real", folder.path() / "link");
    const std::string link = (folder.path() / "link").string();
    EXPECT_EQ(hide(link + "/a.obj", hidden_folders("", {link})), "a.obj");
    const std::string real = (fs::canonical(folder.path()) / "real/a.obj").string();
    EXPECT_EQ(hide(real, hidden_folders("", {link})), "a.obj");
    const std::string detour = (folder.path() / "real/../link").string();
    EXPECT_EQ(hide(detour + "/a.obj", hidden_folders("", {detour})), "a.obj");
    EXPECT_EQ(hide(link + "/a.obj", hidden_folders("", {detour})), "a.obj");
    const std::string relative = fs::relative(link).string();
    EXPECT_EQ(hide(relative + "/a.obj", hidden_folders("", {relative})), "a.obj");
}

TEST(HiddenFolders, TextsOfOtherProgramsKeepTheLastPartOfAnyPath) {
    const auto hidden = [](const char* text) { return hide(text, folders(), OtherPaths::last_part); };
    EXPECT_EQ(hidden("at /home/me/src/run.cpp:12 in f (/usr/lib/libc.so)"), "at run.cpp:12 in f (libc.so)");
    EXPECT_EQ(hidden("/srv/data/hair/a.tfx"), "a.tfx");
    EXPECT_EQ(hidden("in /srv/data"), "in the data folder");
    EXPECT_EQ(hidden("1/2 / of a/b"), "1/2 / of a/b");
    EXPECT_EQ(hidden("/"), "/");
    EXPECT_EQ(hidden("/home/"), "home/");
    EXPECT_EQ(hidden("file:///home/me/x"), "file:x");
}

TEST(HiddenFolders, OfAnErrorThePlaceAndTheMessage) {
    const base::Error error =
        hide(base::Error(base::ErrorCode::bad_input, "/srv/data/a.ply:3", "not in /srv/data"), folders());
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_EQ(error.where(), "a.ply:3");
    EXPECT_EQ(error.message(), "not in the data folder");
}

}  // namespace
}  // namespace shadowbench::service

#include "service/jobs/folders.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "base/error.h"
#include "base/read_text.h"
#include "jobs/unprivileged.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

class JobFolder : public ::testing::Test {
protected:
    fs::path work(const std::string& name) const { return folders.work / name; }
    static void write(const fs::path& file, const std::string& text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    void publish_one(const std::string& id) const {
        write(work(id) / "result.json", "result of " + id);
        write(work(id) / "images" / "a.png", "picture of " + id);
        publish(folders, work(id), id);
    }

    const TemporaryFolder state;
    const JobFolders folders = make_job_folders(state.path());
};

TEST_F(JobFolder, MovesToItsPlaceAsAWhole) {
    publish_one("j-1");
    EXPECT_TRUE(is_published(folders, "j-1"));
    EXPECT_FALSE(fs::exists(work("j-1")));
    EXPECT_EQ(list_files(folders.jobs / "j-1"), (std::vector<std::string>{"images/a.png", "result.json"}));
}

TEST_F(JobFolder, HoldsNoLinks) {
    write(work("j-1") / "result.json", "{}");
    fs::create_symlink("/etc/passwd", work("j-1") / "link");
    EXPECT_THROW(publish(folders, work("j-1"), "j-1"), base::Error);
    EXPECT_FALSE(is_published(folders, "j-1"));
    make_work_folder(work("j-1"));
    ASSERT_EQ(::mkfifo((work("j-1") / "pipe").c_str(), 0600), 0);
    EXPECT_THROW(publish(folders, work("j-1"), "j-1"), base::Error) << "and does not wait for a writer";
}

TEST_F(JobFolder, GivesTheFilesThatItListsAndNoOthers) {
    publish_one("j-1");
    const fs::path folder = folders.jobs / "j-1";
    write(folder / ".hidden", "x");
    write(folder / ".cache" / "b.png", "x");
    write(state.path() / "secret", "x");
    fs::create_symlink(state.path() / "secret", folder / "link");
    fs::create_directory_symlink(state.path(), folder / "out");
    EXPECT_EQ(list_files(folder), (std::vector<std::string>{"images/a.png", "result.json"}));
    for (const std::string& name : list_files(folder)) EXPECT_EQ(find_file_in(folder, name), folder / name);
    for (const std::string& name : {std::string(),
                                    std::string("."),
                                    std::string(".."),
                                    std::string("/"),
                                    std::string("images"),
                                    std::string("images/"),
                                    std::string("images//a.png"),
                                    std::string("./result.json"),
                                    std::string("images/../result.json"),
                                    std::string("../j-1/result.json"),
                                    std::string("../../secret"),
                                    std::string("/etc/passwd"),
                                    (folder / "result.json").string(),
                                    std::string("link"),
                                    std::string("out/secret"),
                                    std::string(".hidden"),
                                    std::string(".cache/b.png"),
                                    std::string("result.json/"),
                                    std::string("result.json/x"),
                                    std::string("nothing"),
                                    std::string("result.json\0", 12),
                                    std::string(5000, 'a')})
        EXPECT_FALSE(find_file_in(folder, name)) << name;
}

TEST_F(JobFolder, SharesItsFilesWithAnother) {
    publish_one("j-1");
    make_work_folder(work("j-2"));
    link_files(folders.jobs / "j-1", work("j-2"));
    publish(folders, work("j-2"), "j-2");
    remove_folder(folders.jobs / "j-1");
    EXPECT_EQ(base::read_text(folders.jobs / "j-2" / "images" / "a.png"), "picture of j-1");
}

TEST_F(JobFolder, LeavesItsPlaceAsAWhole) {
    publish_one("j-1");
    EXPECT_TRUE(unpublish(folders, "j-1"));
    EXPECT_FALSE(is_published(folders, "j-1"));
    EXPECT_EQ(list_files(removed_folder(folders, "j-1")), (std::vector<std::string>{"images/a.png", "result.json"}));
    EXPECT_FALSE(unpublish(folders, "j-1"));
    publish_one("j-2");
    discard_results(folders, "j-2");
    EXPECT_FALSE(is_published(folders, "j-2"));
    EXPECT_FALSE(fs::exists(removed_folder(folders, "j-2")));
}

TEST_F(JobFolder, KeepsItsRecordUntilTheRestIsGone) {
    publish_one("j-1");
    const fs::path folder = folders.jobs / "j-1", images = folder / "images";
    write(folder / ".job.json", "record");
    fs::permissions(images, fs::perms(0555));
    {
        const Unprivileged unprivileged;
        remove_folder(folder);
    }
    EXPECT_TRUE(fs::exists(folder / ".job.json"));
    fs::permissions(images, fs::perms(0755));
    remove_folder(folder);
    EXPECT_FALSE(fs::exists(folder));
}

TEST_F(JobFolder, EmptiesNoFolderBehindALink) {
    publish_one("j-1");
    fs::create_directory_symlink(folders.jobs / "j-1", folders.work / "link");
    remove_folder(folders.work / "link");
    EXPECT_FALSE(fs::is_symlink(folders.work / "link"));
    EXPECT_EQ(list_files(folders.jobs / "j-1").size(), 2u);
}

TEST_F(JobFolder, CannotBeMadeInAFile) {
    write(state.path() / "file", "x");
    EXPECT_THROW(make_job_folders(state.path() / "file"), base::Error);
}

}  // namespace
}  // namespace shadowbench::service

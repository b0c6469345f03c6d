#include "service/store/folder_lock.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

TEST(FolderLocks, HoldAFolderForOne) {
    const TemporaryFolder folder;
    {
        const FolderLock lock(folder.path());
        try {
            const FolderLock second(folder.path());
            ADD_FAILURE() << "two hold it";
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::io);
            EXPECT_EQ(error.where(), folder.path().string());
            EXPECT_NE(error.message().find("another server"), std::string::npos);
        }
    }
    const FolderLock next(folder.path());
}

TEST(FolderLocks, EndWithAProcessThatIsKilled) {
    const TemporaryFolder folder;
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const FolderLock lock(folder.path());
        if (::write(ready[1], "x", 1) != 1) ::_exit(1);
        for (;;) ::pause();
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_THROW(FolderLock(folder.path()), base::Error);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_NO_THROW(FolderLock(folder.path()));
    ::close(ready[0]);
    ::close(ready[1]);
}

TEST(FolderLocks, OutliveTheirFile) {
    const TemporaryFolder folder;
    {
        const FolderLock lock(folder.path());
        ASSERT_TRUE(std::filesystem::remove(folder.path() / "lock"));
        EXPECT_THROW(FolderLock(folder.path()), base::Error) << "two servers would write one database";
    }
    EXPECT_NO_THROW(FolderLock(folder.path()));
}

TEST(FolderLocks, NeedAFolder) {
    const TemporaryFolder folder;
    EXPECT_THROW(FolderLock(folder.path() / "nowhere"), base::Error);
}

}  // namespace
}  // namespace shadowbench::service

#include "service/store/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "base/error.h"

namespace shadowbench::service {
namespace {

constexpr int attempts = 50;
constexpr std::chrono::milliseconds between{20};

enum class Held { yes, by_another, impossible };  // impossible: errno says why

// Waits a second for a server that is stopping.
Held hold(int file) {
    for (int i = 0; ::flock(file, LOCK_EX | LOCK_NB) != 0; ++i) {
        if (errno == EINTR) continue;
        if (errno != EWOULDBLOCK) return Held::impossible;
        if (i >= attempts) return Held::by_another;
        std::this_thread::sleep_for(between);
    }
    return Held::yes;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
    const auto fail = [&](const std::string& message) {
        release();
        throw base::Error(base::ErrorCode::io, folder.string(), message);
    };
    const auto because = [] { return ": " + std::generic_category().message(errno); };
    file_ = ::open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) fail("the state folder cannot be written" + because());
    Held held = hold(file_);
    if (held == Held::impossible) fail("the state folder cannot be locked" + because());
    // A file system that cannot lock folders leaves it at the file.
    if (held == Held::yes) {
        folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder_ >= 0) held = hold(folder_);
    }
    if (held == Held::by_another) fail("another server holds this state folder; stop that one, or use another folder");
}

FolderLock::~FolderLock() {
    release();
}

void FolderLock::release() {
    for (const int held : {folder_, file_})
        if (held >= 0) ::close(held);
}

}  // namespace shadowbench::service

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

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
    using base::Error, base::ErrorCode;
    const auto fail = [&](const std::string& message) {
        const std::string why = std::generic_category().message(errno);
        if (file_ >= 0) ::close(file_);
        throw Error(ErrorCode::io, folder.string(), message + ": " + why);
    };
    file_ = ::open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) fail("the state folder cannot be written");
    for (int i = 0; ::flock(file_, LOCK_EX | LOCK_NB) != 0; ++i) {
        if (errno == EINTR) continue;
        if (errno != EWOULDBLOCK) fail("the state folder cannot be locked");
        if (i >= attempts) {
            ::close(file_);
            throw Error(ErrorCode::io, folder.string(),
                        "another server holds this state folder; stop that one, or use another folder");
        }
        std::this_thread::sleep_for(between);
    }
}

FolderLock::~FolderLock() {
    ::close(file_);
}

}  // namespace shadowbench::service

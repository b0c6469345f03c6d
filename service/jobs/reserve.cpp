#include "service/jobs/reserve.h"

#include <fcntl.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "service/jobs/room.h"

namespace shadowbench::service {
namespace {

constexpr std::uintmax_t plenty = 4 * reserve_bytes;

}  // namespace

Reserve::Reserve(std::filesystem::path file, const std::filesystem::path& work) : file_(std::move(file)) {
    if (!has_room(work, reserve_bytes)) give_up();
}

void Reserve::take() {
    const std::scoped_lock lock(mutex_);
    if (taken_ || free_bytes(file_.parent_path()).value_or(0) < plenty) return;
    const int file = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file < 0) return;
    taken_ = ::posix_fallocate(file, 0, static_cast<off_t>(reserve_bytes)) == 0;
    ::close(file);
    if (!taken_) ::unlink(file_.c_str());
}

bool Reserve::give_up() {
    const std::scoped_lock lock(mutex_);
    taken_ = false;
    std::error_code ignored;
    return std::filesystem::remove(file_, ignored);
}

}  // namespace shadowbench::service

#include "service/jobs/room.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

constexpr const char* room_prefix = ".room-";

bool write_all(int file, std::size_t bytes) {
    const std::string zeros(bytes, '\0');
    for (std::size_t done = 0; done < bytes;) {
        const ssize_t count = ::write(file, zeros.data() + done, bytes - done);
        if (count < 0 && errno != EINTR) return false;
        if (count > 0) done += static_cast<std::size_t>(count);
    }
    return true;
}

bool reserve(int file, std::uintmax_t bytes) {
    int result = 0;
    while ((result = ::fallocate(file, 0, 0, static_cast<off_t>(bytes))) != 0 && errno == EINTR) {
    }
    return result == 0 || errno == EOPNOTSUPP || errno == ENOSYS;
}

}  // namespace

bool has_room(const fs::path& folder, std::uintmax_t bytes) {
    std::string name = (folder / (std::string(room_prefix) + "XXXXXX")).string();
    const int file = ::mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) return false;
    ::unlink(name.c_str());
    const bool room = write_all(file, least_room) && reserve(file, std::max(bytes, least_room)) && ::fsync(file) == 0;
    ::close(file);
    return room;
}

bool is_room_file(const fs::path& file) {
    std::error_code ignored;
    const std::string name = file.filename().string();
    return name.starts_with(room_prefix) && name.size() == std::string(room_prefix).size() + 6 &&
           fs::is_regular_file(fs::symlink_status(file, ignored));
}

std::optional<std::uintmax_t> free_bytes(const fs::path& folder) {
    std::error_code failed;
    const fs::space_info space = fs::space(folder, failed);
    return failed ? std::nullopt : std::optional(space.available);
}

std::uintmax_t bytes_in(const fs::path& folder) {
    std::uintmax_t bytes = 0;
    std::error_code failed;
    for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        struct stat status {};
        if (::lstat(entry->path().c_str(), &status) == 0) bytes += static_cast<std::uintmax_t>(status.st_blocks) * 512;
    }
    return bytes;
}

}  // namespace shadowbench::service

#include "base/durable_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

#include "base/error.h"
#include "base/pending_file.h"

namespace shadowbench::base {
namespace {

namespace fs = std::filesystem;

// Closes the file, which may be -1. Throws if the last system call failed.
void finish(int file, bool done, const fs::path& place, const char* what) {
    const std::error_code why(errno, std::generic_category());
    if (file >= 0) ::close(file);
    if (!done) throw Error(ErrorCode::io, place.string(), std::string(what) + ": " + why.message());
}

bool write_all(int file, const std::string& content) {
    for (std::size_t written = 0; written < content.size();) {
        const ssize_t more = ::write(file, content.data() + written, content.size() - written);
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) return false;
        written += static_cast<std::size_t>(more);
    }
    return true;
}

}  // namespace

void write_durable(const fs::path& place, const std::string& content) {
    PendingFile pending(place);
    const int file = ::open(pending.temporary().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    finish(file, file >= 0 && write_all(file, content) && ::fsync(file) == 0, place, "cannot write the file");
    pending.commit();
    const fs::path parent = place.parent_path();
    const int folder = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // EINVAL: a file system that syncs no folders.
    const bool synced = folder >= 0 && (::fsync(folder) == 0 || errno == EINVAL);
    finish(folder, synced, place, "its folder cannot be synced to the disk");
}

}  // namespace shadowbench::base

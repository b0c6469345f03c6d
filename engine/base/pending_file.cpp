#include "base/pending_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace shadowbench::base {

PendingFile::PendingFile(std::filesystem::path place) : place_(std::move(place)) {
    std::error_code failed;
    // Refuse it now: rename() would fail only after all the work.
    if (place_.filename().empty() || std::filesystem::is_directory(place_, failed))
        throw Error(ErrorCode::io, place_.string(), "there is a folder of that name; choose another file");
    std::random_device random;
    int file = -1;
    do {
        temporary_ = place_.parent_path() / ("." + place_.stem().string() + "." + std::to_string(random()) + ".tmp" +
                                             place_.extension().string());
        file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file < 0 && errno == EEXIST);
    if (file < 0)
        throw Error(ErrorCode::io, place_.string(),
                    "cannot create the file: " + std::generic_category().message(errno));
    ::close(file);
}

PendingFile::~PendingFile() {
    std::error_code ignored;
    if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void PendingFile::commit() {
    std::error_code failed;
    std::filesystem::rename(temporary_, place_, failed);
    if (failed) throw Error(ErrorCode::io, place_.string(), "cannot replace the file: " + failed.message());
    temporary_.clear();
}

}  // namespace shadowbench::base

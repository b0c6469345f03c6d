#include "service/store/presence.h"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

Presence::Presence(const std::vector<fs::path>& places) {
    for (const fs::path& place : places) {
        struct stat status {};
        if (::stat(place.c_str(), &status) != 0)
            throw base::Error(base::ErrorCode::io, place.string(),
                              "cannot be read: " + std::generic_category().message(errno));
        noted_.push_back({place, status.st_dev, status.st_ino});
    }
}

std::optional<fs::path> Presence::gone() const {
    for (const Noted& noted : noted_) {
        struct stat status {};
        if (::stat(noted.place.c_str(), &status) != 0 || status.st_dev != noted.device || status.st_ino != noted.inode)
            return noted.place;
    }
    return std::nullopt;
}

void Presence::check() const {
    if (const std::optional<fs::path> place = gone())
        throw base::Error(base::ErrorCode::io, place->string(),
                          "it was removed or replaced while the server runs; put it back, or start the server anew");
}

}  // namespace shadowbench::service

#include "service/cli/this_program.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {
namespace {

constexpr const char* self = "/proc/self/exe";

[[noreturn]] void fail(const std::string& cause) {
    throw base::Error(base::ErrorCode::io, self, "cannot find the file of this program: " + cause);
}

}  // namespace

std::string this_program() {
    std::error_code failed;
    const std::filesystem::path program = std::filesystem::read_symlink(self, failed);
    if (failed) fail(failed.message());
    return program.string();
}

HeldProgram::HeldProgram() {
    const int open = ::open(self, O_PATH | O_CLOEXEC);
    if (open < 0) fail(std::strerror(errno));
    // Not a number below 3: those are the standard streams of children.
    descriptor_ = ::fcntl(open, F_DUPFD_CLOEXEC, 3);
    ::close(open);
    if (descriptor_ < 0) fail(std::strerror(errno));
}

HeldProgram::~HeldProgram() {
    ::close(descriptor_);
}

std::string HeldProgram::path() const {
    return "/proc/self/fd/" + std::to_string(descriptor_);
}

}  // namespace shadowbench::service

#include "service/process/descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {

void Descriptor::reset(int number) {
    if (number_ >= 0) ::close(number_);
    number_ = number;
}

Pipe::Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
        throw base::Error(base::ErrorCode::io, "", "a pipe cannot be made: " + std::generic_category().message(errno));
    read.reset(ends[0]);
    write.reset(ends[1]);
}

}  // namespace shadowbench::service

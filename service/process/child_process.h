// The one way in which this program starts another one.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

#include "service/process/bound_group.h"

namespace shadowbench::service {

// The descriptors of this process that a child gets as its standard streams; -1: /dev/null.
struct Streams {
    int in = -1, out = -1, err = -1;
};

// How a child ended.
struct ChildExit {
    bool by_signal;
    int code;  // the exit code, or the number of the signal
};

// The same rules hold for every child:
// - It and all that it starts die with this process, however that ends (BoundGroup). The child itself also dies with
//   the thread that started it.
// - Each signal has its default effect, and none is blocked, whatever this process ignores, handles or blocks.
// - Its standard streams are the only descriptors that it has of this process.
// - It leaves no core file. When the machine runs out of memory, the kernel ends it before this process.
//
// There are two ways to limit its memory. `address_space` is what it may reserve, by RLIMIT_AS: an allocation beyond it
// fails, and the child can say so. It suits small helpers; builds with a sanitizer reserve terabytes and go without it.
// resident() suits measurements, which may reserve far more than they touch: the caller watches it and ends the child.
class ChildProcess {
public:
    // `program` is a path; PATH is not searched. `address_space` in bytes, 0: no limit. Returns once the program runs.
    // Throws Error{io} where no process can be started, and Error{internal} with the reason, place `program`, where it
    // cannot run the program.
    ChildProcess(const std::string& program, const std::vector<std::string>& arguments, const Streams& streams,
                 std::size_t address_space = 0);
    ~ChildProcess();  // as end()
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    bool has_ended() const;        // the child; what it started may still run
    std::size_t resident() const;  // bytes; 0 once it has ended
    void terminate() const;        // asks it to end: SIGTERM
    ChildExit end();               // kills all that still runs of it and its group, and waits for it; once

private:
    BoundGroup group_;
    pid_t child_ = -1;
};

}  // namespace shadowbench::service

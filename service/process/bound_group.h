// A group of processes that does not outlive this process, however this one ends.
#pragma once

#include <sys/types.h>

#include "service/process/descriptor.h"

namespace shadowbench::service {

// The group's leader is a keeper: a process that only waits for the end of this one, which it sees by the closing of a
// pipe, also after SIGKILL. It then kills the group. Whatever a program of the group starts belongs to the group too,
// unless it leaves for another one.
class BoundGroup {
public:
    BoundGroup();   // throws Error{io} where no process can be started
    ~BoundGroup();  // kills all that is left of it
    BoundGroup(const BoundGroup&) = delete;
    BoundGroup& operator=(const BoundGroup&) = delete;

    // For a new process of this one, between fork() and exec(): it joins the group, and dies with the thread that
    // started it if the keeper is gone. Returns false and sets errno if it fails or if this process is dead. Makes only
    // system calls.
    bool join() const;

    void kill() const;  // all of it; whoever started a process of it waits for that one

private:
    pid_t parent_, keeper_ = -1;
    Pipe line_;  // whose writing end the end of this process closes
};

}  // namespace shadowbench::service

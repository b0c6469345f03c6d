// A group of processes that does not outlive this process, however this one ends.
#pragma once

#include <sys/types.h>

namespace shadowbench::service {

// The group's leader is a keeper, a process that does nothing but wait for the end of this one, which the closing of a
// pipe tells it, also after SIGKILL; it then kills the group. Whatever a program of the group starts belongs to it too,
// unless it leaves for a group of its own.
class BoundGroup {
public:
    BoundGroup();   // throws Error{io} where no process can be made
    ~BoundGroup();  // kills all that is left of it
    BoundGroup(const BoundGroup&) = delete;
    BoundGroup& operator=(const BoundGroup&) = delete;

    // Its number, as posix_spawn() takes it. Nobody else's while this object lives.
    pid_t id() const { return keeper_; }

    // For a new process of this one, between fork() and exec(): it joins the group, and dies with the thread that
    // started it, should the keeper be gone. Ends it where this process has died already. System calls alone.
    void join() const;

    void kill() const;  // all of it; who started a process of it waits for that one

private:
    pid_t parent_, keeper_ = -1;
    int line_ = -1;  // closed by the end of this process
};

}  // namespace shadowbench::service

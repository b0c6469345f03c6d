// A process of a technique, and the connection to it.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "service/isolation/isolated.h"
#include "service/isolation/message.h"
#include "service/process/child_process.h"
#include "service/process/descriptor.h"

namespace shadowbench::service {

// The two ends of a connection. Throws Error{io}.
struct SocketPair {
    SocketPair();
    Descriptor own, other;
};

class Connection {
public:
    // Starts `program technique-host library hash`. Throws as ChildProcess does.
    Connection(const IsolationOptions& options, const std::string& library, const std::string& hash);

    bool alive() const { return !dead_; }

    // One request at a time; others wait. Before the first, the process may take half a minute to start. The first
    // opens the library, which may take ten seconds more; to open and describe it may take ten, or those of a call if
    // they are fewer. `function` names it in messages. Throws Error{internal}, place: the library, if the process
    // answers that it failed; if it ends, does not answer in time, or answers what makes no sense, which all end it:
    // then all later requests, and those that waited, fail with the same reason.
    MessageReader ask(Request request, const char* function, const MessageWriter& body);

private:
    using Clock = std::chrono::steady_clock;

    void allow(double seconds);  // from now on, for what follows
    void send(const void* from, std::size_t size, const char* function);
    void receive(void* to, std::size_t size, const char* function);
    void wait(short events, const char* function);
    [[noreturn]] void end(const std::string& why);
    [[noreturn]] void end_lost(const char* function);
    [[noreturn]] void fail(const std::string& why);

    std::string library_;
    double call_seconds_;
    SocketPair sockets_;
    ChildProcess child_;
    std::mutex mutex_;
    std::atomic<bool> dead_ = false;
    std::string why_;  // it is dead
    bool started_ = false, opened_ = false;
    double seconds_ = 0.0;     // that what is waited for may take
    Clock::time_point until_;  // of it
};

}  // namespace shadowbench::service

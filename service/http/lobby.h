// The connections that wait for a thread, and the threads that serve them. It knows sockets, and of HTTP only how a
// request of a monitor begins.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

namespace shadowbench::service {

class Lobby {
public:
    using Serve = std::function<void(int socket)>;  // owns the socket from then on; throws nothing

    // `threads` serve the connections in the order of their arrival. One thread more serves monitors, with
    // `serve_monitor`: connections that still wait and have sent the whole head of a request for /healthz, /readyz or
    // /metrics. So slow clients on all threads do not delay them. `waiting` gets the number of connections that wait;
    // at most `most` do.
    Lobby(std::size_t threads, std::size_t most, std::atomic<std::size_t>& waiting, Serve serve, Serve serve_monitor);
    ~Lobby();
    Lobby(const Lobby&) = delete;
    Lobby& operator=(const Lobby&) = delete;

    // Returns false when too many wait. First closes one that has sent nothing for a second.
    bool add(int socket);

    // Serves the connections that wait, and ends the threads.
    void stop();

private:
    using Clock = std::chrono::steady_clock;
    struct Visitor {
        int socket;
        Clock::time_point since;
        bool is_other;  // it is known to be no monitor
    };

    void serve_all();
    void serve_monitors();
    int take(std::list<Visitor>::iterator visitor);
    int take_monitor();  // -1: there is none
    bool drop_silent();

    const std::size_t most_;
    std::atomic<std::size_t>& waiting_;
    const Serve serve_, serve_monitor_;
    std::mutex mutex_;
    std::condition_variable came_, came_for_monitors_;
    std::list<Visitor> visitors_;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

enum class Asks { unclear, monitor, other };
// What a connection asks for that has sent this so far.
Asks asks(std::string_view start);

}  // namespace shadowbench::service

#include "service/http/lobby.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

namespace shadowbench::service {
namespace {

constexpr std::chrono::milliseconds between_looks{20};
constexpr std::chrono::seconds silence{1};
constexpr std::size_t longest_monitor_head = 4096;

// As recv() does, without taking the bytes and without waiting.
long peek(int socket, char* to, std::size_t size) {
    return ::recv(socket, to, size, MSG_PEEK | MSG_DONTWAIT);
}

}  // namespace

Asks asks(std::string_view start) {
    for (const char* method : {"GET ", "HEAD "})
        for (const char* path : {"/healthz", "/readyz", "/metrics"}) {
            const std::string begins = method + std::string(path) + " HTTP/1.";
            if (begins.starts_with(start)) return Asks::unclear;
            if (!start.starts_with(begins)) continue;
            if (start.find("\r\n\r\n") != std::string_view::npos) return Asks::monitor;
            return start.size() < longest_monitor_head ? Asks::unclear : Asks::other;
        }
    return Asks::other;
}

Lobby::Lobby(std::size_t threads, std::size_t most, std::atomic<std::size_t>& waiting, Serve serve, Serve serve_monitor)
    : most_(most), waiting_(waiting), serve_(std::move(serve)), serve_monitor_(std::move(serve_monitor)) {
    try {
        for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { serve_all(); });
        threads_.emplace_back([this] { serve_monitors(); });
    } catch (...) {
        stop();
        throw;
    }
}

Lobby::~Lobby() {
    stop();
}

bool Lobby::add(int socket) {
    {
        const std::scoped_lock lock(mutex_);
        if (visitors_.size() >= most_ && !drop_silent()) return false;
        visitors_.push_back({socket, Clock::now(), false});
        waiting_ = visitors_.size();
    }
    came_.notify_one();
    came_for_monitors_.notify_one();
    return true;
}

void Lobby::stop() {
    {
        const std::scoped_lock lock(mutex_);
        stopping_ = true;
    }
    came_.notify_all();
    came_for_monitors_.notify_all();
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

void Lobby::serve_all() {
    for (;;) {
        int socket = -1;
        {
            std::unique_lock lock(mutex_);
            came_.wait(lock, [&] { return stopping_ || !visitors_.empty(); });
            if (visitors_.empty()) return;
            socket = take(visitors_.begin());
        }
        serve_(socket);
    }
}

void Lobby::serve_monitors() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        came_for_monitors_.wait(lock, [&] { return stopping_ || !visitors_.empty(); });
        // Most connections find a thread within this time.
        came_for_monitors_.wait_for(lock, between_looks, [&] { return stopping_; });
        for (int socket = take_monitor(); socket >= 0; socket = take_monitor()) {
            lock.unlock();
            serve_monitor_(socket);
            lock.lock();
        }
    }
}

int Lobby::take(std::list<Visitor>::iterator visitor) {
    const int socket = visitor->socket;
    visitors_.erase(visitor);
    waiting_ = visitors_.size();
    return socket;
}

int Lobby::take_monitor() {
    char start[longest_monitor_head];
    for (auto visitor = visitors_.begin(); visitor != visitors_.end(); ++visitor) {
        if (visitor->is_other) continue;
        const long n = peek(visitor->socket, start, sizeof start);
        if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        const Asks what = n <= 0 ? Asks::other : asks({start, static_cast<std::size_t>(n)});
        if (what == Asks::monitor) return take(visitor);
        visitor->is_other = what == Asks::other;
    }
    return -1;
}

// Closes the connection that has waited longest without a byte, if that is long.
bool Lobby::drop_silent() {
    const auto now = Clock::now();
    const auto silent = std::find_if(visitors_.begin(), visitors_.end(), [&](const Visitor& visitor) {
        char byte;
        return now - visitor.since > silence && peek(visitor.socket, &byte, 1) <= 0;
    });
    if (silent == visitors_.end()) return false;
    ::close(take(silent));
    return true;
}

}  // namespace shadowbench::service

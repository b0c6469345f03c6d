// The connection of one client: it reads and writes bytes within limits and deadlines. All it knows of HTTP is where a
// head ends, and that none begins as TLS does.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace shadowbench::service {

struct ChannelLimits {
    std::size_t head = 32 * 1024;  // bytes
    // A connection may wait this long for its next request, but not at all when others wait for a thread.
    double idle_seconds = 30.0;
    double head_seconds = 10.0;   // for a head; a tenth of it when others wait for a thread
    double body_seconds = 30.0;   // for a body
    double write_seconds = 10.0;  // the longest time in which a client receives nothing
    // A body must come at this rate, in bytes a second, counted from some seconds after its head.
    double body_rate = 1024.0, body_grace = 5.0;
};

class Channel {
public:
    // Owns the socket. `hurry` returns whether other connections wait for a thread.
    Channel(int socket, const ChannelLimits& limits, const std::atomic<bool>& stopping, std::function<bool()> hurry);
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    enum class Outcome { complete, closed, too_slow, too_large, tls };
    // Reads a head, with the empty line at its end. `closed` also when no request came in time, and when the server
    // stops. `tls`: the client begins as for https://; at once, since it waits for an answer too.
    Outcome read_head(std::string& head);

    // Allows read() this many bytes, until the time for a body is over or it comes too slowly.
    void begin_body(std::size_t most);
    // Reads as recv() does: 0 at the end, -1 when it failed, took too long or exceeded the limit.
    long read(char* to, std::size_t size);

    bool write(const char* bytes, std::size_t size);

    // The address of the client; empty where it is unknown.
    const std::string& peer() const { return peer_; }

    // Whether the client has closed the connection and nothing is left to read.
    bool gone() const;

    // Reads and discards what the client still sends, so that it can read the answer: if the server closed the
    // connection at once, the client could lose the answer.
    void linger();

private:
    using Clock = std::chrono::steady_clock;
    enum class Ready { yes, timed_out, failed };
    Ready wait(short what, Clock::time_point end, const std::function<bool()>& give_up) const;
    long receive(char* to, std::size_t size) const;
    Clock::time_point end_of_body() const;

    const int socket_;
    const ChannelLimits limits_;
    const std::atomic<bool>& stopping_;
    const std::function<bool()> hurry_;
    const std::string peer_;
    std::string buffer_;                         // received, but not yet read by a caller
    std::size_t body_most_ = 0, body_left_ = 0;  // bytes that read() may give, in all and from now on
    Clock::time_point body_begin_{};
    bool first_ = true;
};

}  // namespace shadowbench::service

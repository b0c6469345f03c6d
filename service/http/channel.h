// One client's connection: bytes in, within limits and deadlines, and bytes out. Of HTTP it knows where a head ends.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace shadowbench::service {

struct ChannelLimits {
    std::size_t head = 32 * 1024;  // bytes
    double idle_seconds =
        30.0;  // a connection may wait for its next request; when others wait for a thread, not at all
    double head_seconds = 10.0;   // a head may take; when others wait, a tenth
    double body_seconds = 30.0;   // a body may take
    double write_seconds = 10.0;  // a client may take nothing of what is sent
};

class Channel {
public:
    // Takes the socket. `hurry` tells whether other connections wait for a thread.
    Channel(int socket, const ChannelLimits& limits, const std::atomic<bool>& stopping, std::function<bool()> hurry);
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    enum class Outcome { complete, closed, too_slow, too_large };
    // Up to and with the empty line. `closed` also when nothing came in time, and when the server stops.
    Outcome read_head(std::string& head);

    // From here on, read() gives at most so many bytes, until the time for a body is over.
    void begin_body(std::size_t most);
    // As recv(): 0 at the end, -1 when it failed, took too long or gave too much.
    long read(char* to, std::size_t size);

    bool write(const char* bytes, std::size_t size);

    // Whether the client has closed its side, and sent nothing more.
    bool gone() const;

    // Lets the client read the answer even while it still sends: closing at once would throw the answer away.
    void linger();

private:
    using Clock = std::chrono::steady_clock;
    enum class Ready { yes, no, failed };
    Ready wait(short what, Clock::time_point end, const std::function<bool()>& give_up) const;
    long receive(char* to, std::size_t size) const;

    const int socket_;
    const ChannelLimits limits_;
    const std::atomic<bool>& stopping_;
    const std::function<bool()> hurry_;
    std::string buffer_;  // received, not yet given
    std::size_t body_left_ = 0;
    Clock::time_point body_end_{};
    bool first_ = true;
};

}  // namespace shadowbench::service

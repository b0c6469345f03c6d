#include "service/http/channel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace shadowbench::service {
namespace {

constexpr auto slice = std::chrono::milliseconds(100);  // between two checks for other reasons to stop waiting
constexpr char tls_handshake = 0x16;                    // the first byte of a client that speaks TLS
constexpr std::size_t linger_bytes = std::size_t{16} << 20;
constexpr double linger_seconds = 2.0;

std::chrono::steady_clock::duration duration(double seconds) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

std::string peer_of(int socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    char text[NI_MAXHOST];
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (::getpeername(socket, any, &size) != 0) return "";
    return ::getnameinfo(any, size, text, sizeof text, nullptr, 0, NI_NUMERICHOST) == 0 ? text : "";
}

}  // namespace

Channel::Channel(int socket, const ChannelLimits& limits, const std::atomic<bool>& stopping,
                 std::function<bool()> hurry)
    : socket_(socket), limits_(limits), stopping_(stopping), hurry_(std::move(hurry)), peer_(peer_of(socket)) {}

Channel::~Channel() {
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
}

Channel::Ready Channel::wait(short what, Clock::time_point end, const std::function<bool()>& give_up) const {
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
        pollfd polled{socket_, what, 0};
        const int ready = ::poll(
            &polled, 1,
            static_cast<int>(std::clamp(left, std::chrono::milliseconds(0), std::chrono::milliseconds(slice)).count()));
        if (ready > 0) return Ready::yes;
        if (ready < 0 && errno != EINTR) return Ready::failed;
        if (left.count() <= 0 || (give_up && give_up())) return Ready::timed_out;
    }
}

long Channel::receive(char* to, std::size_t size) const {
    for (;;) {
        const ssize_t n = ::recv(socket_, to, size, MSG_DONTWAIT);
        if (n >= 0 || errno != EINTR) return n;
    }
}

Channel::Outcome Channel::read_head(std::string& head) {
    const auto start = Clock::now();
    Clock::time_point begun = start;  // when the head began
    std::size_t looked_at = 0;
    bool waiting = true;
    char piece[4096];
    for (;;) {
        // Empty lines before a request are skipped (RFC 9112, 2.2).
        while (waiting && buffer_.starts_with("\r\n")) buffer_.erase(0, 2);
        if (waiting && !buffer_.empty()) {
            waiting = false;
            begun = Clock::now();
            if (buffer_[0] == tls_handshake) return Outcome::tls;
        }
        if (const std::size_t end = buffer_.find("\r\n\r\n", looked_at); end != std::string::npos) {
            if (end + 4 > limits_.head) return Outcome::too_large;
            head = buffer_.substr(0, end + 4);
            buffer_.erase(0, end + 4);
            first_ = false;
            return Outcome::complete;
        }
        if (buffer_.size() > limits_.head) return Outcome::too_large;
        looked_at = buffer_.size() < 3 ? 0 : buffer_.size() - 3;
        const auto limit = duration(waiting ? limits_.idle_seconds : limits_.head_seconds);
        const auto since = waiting ? start : begun;
        const Ready ready = wait(POLLIN, since + limit, [&] {
            if (stopping_) return true;
            if (!hurry_()) return false;
            // A new client gets a moment to send its first request.
            return waiting && !first_ ? true : Clock::now() >= since + duration(0.1 * limits_.head_seconds);
        });
        if (ready == Ready::failed) return Outcome::closed;
        if (ready == Ready::timed_out) return waiting || stopping_ ? Outcome::closed : Outcome::too_slow;
        const long n = receive(piece, sizeof piece);
        if (n == 0 || (n < 0 && errno != EAGAIN)) return Outcome::closed;
        if (n > 0) buffer_.append(piece, static_cast<std::size_t>(n));
    }
}

void Channel::begin_body(std::size_t most) {
    body_most_ = body_left_ = most;
    body_begin_ = Clock::now();
}

Channel::Clock::time_point Channel::end_of_body() const {
    const double expected = static_cast<double>(body_most_ - body_left_) / limits_.body_rate;
    return body_begin_ + duration(std::min(limits_.body_seconds, limits_.body_grace + expected));
}

long Channel::read(char* to, std::size_t size) {
    size = std::min(size, body_left_);
    if (size == 0) return -1;
    long n = 0;
    if (buffer_.empty()) {
        char piece[16384];
        do {
            if (wait(POLLIN, end_of_body(), [&] { return stopping_.load(); }) != Ready::yes) return -1;
            n = receive(piece, sizeof piece);
        } while (n < 0 && errno == EAGAIN);
        if (n <= 0) return n;
        buffer_.assign(piece, static_cast<std::size_t>(n));
    }
    size = std::min(size, buffer_.size());
    std::memcpy(to, buffer_.data(), size);
    buffer_.erase(0, size);
    body_left_ -= size;
    return static_cast<long>(size);
}

bool Channel::write(const char* bytes, std::size_t size) {
    auto end = Clock::now() + duration(limits_.write_seconds);
    for (std::size_t sent = 0; sent < size;) {
        const ssize_t n = ::send(socket_, bytes + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) {
            sent += static_cast<std::size_t>(n);
            end = Clock::now() + duration(limits_.write_seconds);
        } else if (n < 0 && errno != EAGAIN && errno != EINTR) {
            return false;
        } else if (wait(POLLOUT, end, {}) != Ready::yes) {
            return false;
        }
    }
    return true;
}

bool Channel::gone() const {
    char byte;
    const ssize_t n = ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
}

void Channel::linger() {
    ::shutdown(socket_, SHUT_WR);
    const auto end = Clock::now() + duration(linger_seconds);
    char piece[16384];
    for (std::size_t discarded = 0; discarded < linger_bytes;) {
        if (wait(POLLIN, end, [&] { return stopping_ || hurry_(); }) != Ready::yes) return;
        const long n = receive(piece, sizeof piece);
        if (n == 0 || (n < 0 && errno != EAGAIN)) return;
        if (n > 0) discarded += static_cast<std::size_t>(n);
    }
}

}  // namespace shadowbench::service

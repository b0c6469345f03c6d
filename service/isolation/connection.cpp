#include "service/isolation/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace shadowbench::service {

using base::Error;
using base::ErrorCode;

namespace {

constexpr double starting_seconds = 30.0, opening_seconds = 10.0;
constexpr std::uint64_t most_answered = std::uint64_t{1} << 30;  // bytes of an answer

}  // namespace

SocketPair::SocketPair() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw Error(ErrorCode::io, "", std::string("cannot connect to another process: ") + std::strerror(errno));
    own.reset(ends[0]);
    other.reset(ends[1]);
}

Connection::Connection(const IsolationOptions& options, const std::string& library, const std::string& hash)
    : library_(library),
      call_seconds_(options.call_seconds),
      child_(options.program, {"technique-host", library, hash},
             {.in = sockets_.other.number(), .out = sockets_.other.number(), .err = -1}, options.memory) {
    sockets_.other.close();  // so that the end of the process is the end of the connection
}

MessageReader Connection::ask(Request request, const char* function, const MessageWriter& body) {
    const std::lock_guard lock(mutex_);
    if (dead_) throw Error(ErrorCode::internal, library_, why_);
    MessageHead answer;
    if (!started_) {
        allow(starting_seconds);
        receive(&answer, sizeof answer, "main");
        started_ = true;
    }
    const double opening = std::exchange(opened_, true) ? 0.0 : opening_seconds;
    allow(request == Request::describe ? std::min(call_seconds_, opening_seconds) : call_seconds_ + opening);
    const MessageHead head{static_cast<std::uint32_t>(request), body.body().size()};
    send(&head, sizeof head, function);
    send(body.body().data(), body.body().size(), function);
    receive(&answer, sizeof answer, function);
    if (answer.size > most_answered) end(fmt::format("{}() answered {} bytes", function, answer.size));
    std::string text(static_cast<std::size_t>(answer.size), '\0');
    receive(text.data(), text.size(), function);
    MessageReader reader(std::move(text));
    if (static_cast<ReplyKind>(answer.kind) == ReplyKind::done) return reader;
    throw Error(ErrorCode::internal, library_, reader.get_text());
}

void Connection::allow(double seconds) {
    seconds_ = seconds;
    until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

void Connection::send(const void* from, std::size_t size, const char* function) {
    const char* at = static_cast<const char*>(from);
    while (size > 0) {
        const ssize_t count = ::send(sockets_.own.number(), at, size, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
            wait(POLLOUT, function);
            continue;
        }
        if (count < 0) end_lost(function);
        at += count;
        size -= static_cast<std::size_t>(count);
    }
}

void Connection::receive(void* to, std::size_t size, const char* function) {
    char* at = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t count = ::recv(sockets_.own.number(), at, size, MSG_DONTWAIT);
        if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
            wait(POLLIN, function);
            continue;
        }
        if (count <= 0) end_lost(function);
        at += count;
        size -= static_cast<std::size_t>(count);
    }
}

void Connection::wait(short events, const char* function) {
    const double left = std::chrono::duration<double, std::milli>(until_ - Clock::now()).count();
    if (left <= 0.0) end(fmt::format("{}() did not answer within {:g} s", function, seconds_));
    pollfd waiting{sockets_.own.number(), events, 0};
    ::poll(&waiting, 1, static_cast<int>(std::ceil(std::min(left, 1e6))));
}

void Connection::end(const std::string& why) {
    child_.end();
    fail(why);
}

void Connection::end_lost(const char* function) {
    const ChildExit exit = child_.end();
    const char* name = exit.by_signal ? ::sigdescr_np(exit.code) : nullptr;
    fail(exit.by_signal
             ? fmt::format("{}() ended its process by signal {} ({})", function, exit.code, name ? name : "?")
             : fmt::format("{}() ended its process with exit code {}", function, exit.code));
}

void Connection::fail(const std::string& why) {
    why_ = why;
    dead_ = true;
    throw Error(ErrorCode::internal, library_, why);
}

}  // namespace shadowbench::service

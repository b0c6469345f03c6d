#include "http/raw.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <utility>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace shadowbench::service {

Raw::Raw(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
}

Raw::~Raw() {
    ::close(socket_);
}

bool Raw::send(const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
        const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (n <= 0) return false;
        sent += static_cast<std::size_t>(n);
    }
    return true;
}

void Raw::end() {
    ::shutdown(socket_, SHUT_WR);
}

bool Raw::fill() {
    pollfd one{socket_, POLLIN, 0};
    if (::poll(&one, 1, 60'000) <= 0) {
        ADD_FAILURE() << "the server says nothing";
        return false;
    }
    char piece[65536];
    const ssize_t n = ::recv(socket_, piece, sizeof piece, 0);
    if (n > 0) buffer_.append(piece, static_cast<std::size_t>(n));
    return n > 0;
}

std::string Raw::receive_until(const std::string& end) {
    std::size_t at;
    while ((at = buffer_.find(end)) == std::string::npos)
        if (!fill()) return {};
    std::string text = buffer_.substr(0, at + end.size());
    buffer_.erase(0, text.size());
    return text;
}

RawAnswer Raw::receive(bool head_only) {
    RawAnswer answer;
    answer.head = receive_until("\r\n\r\n");
    if (answer.head.size() < 12) return answer;
    answer.status = std::atoi(answer.head.c_str() + 9);
    if (head_only || answer.status == 100 || answer.status == 204 || answer.status == 304) return answer;
    if (answer.has("Transfer-Encoding: chunked")) {
        for (;;) {
            const std::size_t size = std::strtoul(receive_until("\r\n").c_str(), nullptr, 16);
            while (buffer_.size() < size + 2)
                if (!fill()) return answer;
            answer.body += buffer_.substr(0, size);
            buffer_.erase(0, size + 2);
            if (size == 0) return answer;
        }
    }
    const std::size_t at = answer.head.find("Content-Length: ");
    if (at == std::string::npos) {
        while (fill()) {
        }
        answer.body = std::exchange(buffer_, {});
        return answer;
    }
    const std::size_t size = std::strtoul(answer.head.c_str() + at + 16, nullptr, 10);
    while (buffer_.size() < size)
        if (!fill()) return answer;
    answer.body = buffer_.substr(0, size);
    buffer_.erase(0, size);
    return answer;
}

bool Raw::closed() {
    return buffer_.empty() && !fill();
}

RawAnswer Raw::ask(const std::string& bytes) {
    send(bytes);
    return receive();
}

std::string get(const std::string& target, const std::string& headers, const std::string& method) {
    return method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n";
}

std::string post(const std::string& target, const std::string& body, const std::string& headers) {
    return "POST " + target + " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n" + headers + "\r\n" + body;
}

}  // namespace shadowbench::service

// A client that sends given bytes unchanged.
#pragma once

#include <string>

namespace shadowbench::service {

struct RawAnswer {
    int status = 0;    // 0: there was none
    std::string head;  // with its empty line
    std::string body;  // chunks joined

    bool has(const std::string& text) const { return head.find(text) != std::string::npos; }
};

class Raw {
public:
    explicit Raw(int port);
    ~Raw();
    Raw(const Raw&) = delete;
    Raw& operator=(const Raw&) = delete;

    // False when the server has closed the connection.
    bool send(const std::string& bytes);
    // Says that nothing more will come.
    void end();
    // The next answer, by its length or chunks; without a body after a HEAD. A minute without a byte fails the test.
    RawAnswer receive(bool head_only = false);
    // The next bytes up to and with `end`.
    std::string receive_until(const std::string& end);
    // Whether the server closes the connection without another byte.
    bool closed();

    RawAnswer ask(const std::string& bytes);

private:
    bool fill();
    int socket_ = -1;
    std::string buffer_;
};

// "GET /healthz" -> the whole request, with further header lines.
std::string get(const std::string& target, const std::string& headers = "", const std::string& method = "GET");
std::string post(const std::string& target, const std::string& body, const std::string& headers = "");

}  // namespace shadowbench::service

// An HTTP client for a shadowbench server.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "service/api/message.h"

namespace shadowbench::service {

struct Reply {
    int status = 0;
    std::string type, body, location;
};

class Client {
public:
    // `url` has the form http://host:port/path. `token` may be empty, and so may `certificates`, a file of those to
    // trust. Throws Error{usage} for any other URL.
    Client(const std::string& url, const std::string& token, const std::string& certificates = "");
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    // `path` is one below the URL, or a link of an answer. Both throw Error{io} when the server does not answer, and
    // Error{usage} where no other try would mend that: there is no such host, it speaks no TLS, or its certificate is
    // not trusted.
    Reply get(const std::string& path);
    Reply post_json(const std::string& path, const std::string& body, const std::vector<Field>& headers);

    // The whole URL of such a path.
    std::string url_of(const std::string& path) const;

private:
    struct State;
    std::string place_of(const std::string& path) const;
    std::string url_, base_;  // base_: the path of the URL
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service

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
    // `url` has the form http://host:port. `token` may be empty. Throws Error{usage} for any other text.
    Client(const std::string& url, const std::string& token);
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    // Both throw Error{io} when the server does not answer.
    Reply get(const std::string& path);
    Reply post_json(const std::string& path, const std::string& body, const std::vector<Field>& headers);

private:
    struct State;
    std::string url_;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service

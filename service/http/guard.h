// Refuses requests without the token, for another host, or from pages of other origins.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/api/message.h"

namespace shadowbench::service {

struct AccessToken {
    std::string name;  // of who has it; may be empty
    std::string secret;
};

struct GuardOptions {
    bool loopback = true;                  // the server listens only on this machine
    std::vector<AccessToken> tokens = {};  // empty: requests need none
};

// Whether only this machine can reach an address: "localhost", "127.0.0.1", "::1".
bool is_loopback(const std::string& host);

// The answer that refuses a request; nothing: go on. Sets the client of a request that comes with a token.
//  - 421: on loopback, a Host that is not this machine. A page whose name an attacker resolves to 127.0.0.1 (DNS
//    rebinding) cannot send another Host.
//  - 403: the browser reports that a page of another origin sent the request.
//  - 401: "Authorization: Bearer TOKEN" is missing or has another token. The comparison takes constant time. /healthz,
//    /readyz, the page and its assets need no token: the page asks the user for it.
std::optional<ApiResponse> guard(ApiRequest& request, const GuardOptions& options);

// Its time does not depend on where the texts differ.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

}  // namespace shadowbench::service

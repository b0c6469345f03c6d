// Who may ask: the token, the host that was meant, the page that asks.
#pragma once

#include <optional>
#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

struct GuardOptions {
    bool loopback = true;  // the server listens to this machine alone
    std::string token;     // empty: none is needed
};

// Whether an address is one of this machine alone: "localhost", "127.0.0.1", "::1".
bool is_loopback(const std::string& host);

// The answer to whoever may not ask; nothing: go on.
//  - 421: on loopback, a Host that is not this machine. A page elsewhere whose name was made to mean 127.0.0.1 (DNS
//    rebinding) cannot pretend another Host.
//  - 403: a browser says that a page of another origin asks.
//  - 401: no token, or another, in "Authorization: Bearer TOKEN". Compared in constant time. /healthz and /readyz need
//    none, nor do the page and its assets, which ask for it.
std::optional<ApiResponse> guard(const ApiRequest& request, const GuardOptions& options);

// Takes as long for texts that differ early as for those that differ late.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

}  // namespace shadowbench::service

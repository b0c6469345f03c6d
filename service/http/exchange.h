// One request and its answer, from the head to the line in the log; without a library.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "service/api/message.h"
#include "service/http/channel.h"
#include "service/http/head.h"
#include "service/log/log.h"

namespace shadowbench::service {

struct Exchange {
    explicit Exchange(Channel& of) : channel(of) {}
    Channel& channel;
    Head head;
    std::optional<ApiResponse> refusal;  // the answer, if the service is not asked
    bool keep = false;                   // the connection stays open afterwards
    bool at_once = false;                // nothing may wait for the client
    int status = 0;                      // of the answer; 0: there was none
    std::uint64_t bytes = 0;             // of its content
    std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();  // when the head was complete
};

// The head that httplib gets. httplib decodes header values, reads a POST without a length to the end of the
// connection, matches paths with recursive regular expressions, and mistakes a REMOTE_ADDR from the client for its own.
// This head gives it no occasion.
std::string canonical_head(const Exchange& exchange);

// The id of a request: its X-Request-Id if that has 1 to 128 letters, digits and any of "-_.:/+=@", else a new one.
std::string request_id(const ApiRequest& request);

// Gives an answer the fields that all answers have, and the id of its request, also in problem+json. Notes what the log
// needs of it.
void dress(ApiResponse& answer, Exchange& exchange);

// The line of the log about a request that was answered, with the address of the client. Requests of monitors have the
// level debug: they come every few seconds.
LogEvent access_event(const Exchange& exchange);

}  // namespace shadowbench::service

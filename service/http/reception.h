// What is done with a request before its body is read and before the service is asked.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "service/api/service.h"
#include "service/http/exchange.h"
#include "service/http/guard.h"
#include "service/http/server.h"

namespace shadowbench::service {

class Reception {
public:
    // A connection ends after a request while others wait: `waiting` is their number.
    Reception(Service& service, const HttpOptions& options, const std::atomic<std::size_t>& waiting);

    // Reads the head of the next request and checks what it shows: a request that is refused gets its answer. Returns
    // false where the client sent none.
    bool receive(Exchange& exchange) const;

    ApiResponse too_large() const;  // the answer to a body that is too large

private:
    void check(const std::string& text, Exchange& exchange) const;

    Service& service_;
    const HttpOptions& options_;
    const std::atomic<std::size_t>& waiting_;
    const GuardOptions guard_;
};

}  // namespace shadowbench::service

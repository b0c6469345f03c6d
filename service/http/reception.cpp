#include "service/http/reception.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "service/api/problem.h"
#include "service/http/head.h"
#include "service/http/prefix.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t framing = 64 * 1024;  // bytes that the framing of chunks may add to a body

}  // namespace

Reception::Reception(Service& service, const HttpOptions& options, const std::atomic<std::size_t>& waiting)
    : service_(service), options_(options), waiting_(waiting), guard_{is_loopback(options.host), options.tokens} {}

bool Reception::receive(Exchange& exchange) const {
    std::string text;
    const Channel::Outcome outcome = exchange.channel.read_head(text);
    exchange.begun = std::chrono::steady_clock::now();
    switch (outcome) {
        case Channel::Outcome::closed:
            return false;
        case Channel::Outcome::too_slow:
            exchange.refusal = problem(408, "The request took too long to arrive.");
            break;
        case Channel::Outcome::too_large:
            exchange.refusal = problem(431, "The head of the request is too long.");
            break;
        case Channel::Outcome::tls:
            exchange.refusal = problem(400, "The server speaks HTTP without TLS; use http://, or a proxy with TLS.");
            break;
        case Channel::Outcome::complete:
            check(text, exchange);
            break;
    }
    if (exchange.refusal) service_.count_refusal(exchange.head.request, exchange.refusal->status);
    return true;
}

void Reception::check(const std::string& text, Exchange& exchange) const {
    Head& head = exchange.head;
    if (const auto fault = parse_head(text, head)) {
        exchange.refusal = problem(fault->status, fault->detail);
        return;
    }
    exchange.refusal = take_prefix(head.request, options_.base_path);
    if (!exchange.refusal) exchange.refusal = guard(head.request, guard_);
    if (!exchange.refusal) exchange.refusal = service_.refuse(head.request);
    if (!exchange.refusal && head.content_length.value_or(0) > service_.limits().body) exchange.refusal = too_large();
    // A body that was not read must not be taken for the next request.
    exchange.keep =
        head.keep_alive && waiting_ == 0 && !exchange.at_once && !(exchange.refusal && head.request.has_body);
    exchange.channel.begin_body(service_.limits().body + framing);
}

ApiResponse Reception::too_large() const {
    return problem(413, fmt::format("The body is larger than {} bytes.", service_.limits().body));
}

}  // namespace shadowbench::service

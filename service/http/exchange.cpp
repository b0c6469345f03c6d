#include "service/http/exchange.h"

#include <algorithm>
#include <random>
#include <string_view>

#include <fmt/format.h>

#include "service/api/problem.h"
#include "service/http/lobby.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t longest_id = 128;

bool is_id_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_.:/+=@").find(c) != std::string_view::npos;
}

std::string path_of(const ApiRequest& request) {
    std::string path = request.prefix;
    for (const std::string& segment : request.path) path += "/" + segment;
    return path;
}

bool is_of_monitor(const ApiRequest& request) {
    return request.path.size() == 1 &&
           (request.path[0] == "healthz" || request.path[0] == "readyz" || request.path[0] == "metrics");
}

}  // namespace

std::string canonical_head(const Exchange& exchange) {
    const Head& head = exchange.head;
    if (exchange.refusal) return head.request.method == "HEAD" ? "HEAD / HTTP/1.1\r\n\r\n" : "GET / HTTP/1.1\r\n\r\n";
    std::string text = fmt::format("{} / HTTP/1.1\r\n", head.request.method);
    // Of a chunked body it does not know: see read_body() in http.cpp.
    if (head.request.method == "POST") text += fmt::format("Content-Length: {}\r\n", head.content_length.value_or(0));
    if (head.request.has_body && head.expects_continue) text += "Expect: 100-continue\r\n";
    return text + "\r\n";
}

std::string request_id(const ApiRequest& request) {
    const std::string* given = request.header("x-request-id");
    if (given && !given->empty() && given->size() <= longest_id &&
        std::all_of(given->begin(), given->end(), is_id_letter))
        return *given;
    thread_local std::mt19937_64 random{std::random_device()()};
    return fmt::format("{:016x}", random());
}

void dress(ApiResponse& answer, Exchange& exchange) {
    const std::string& id = exchange.head.request.id;
    if (answer.type == problem_type) add_request_id(answer, id);
    answer.headers.push_back({"X-Request-Id", id});
    answer.headers.push_back({"X-Content-Type-Options", "nosniff"});
    answer.headers.push_back({"Referrer-Policy", "no-referrer"});
    answer.headers.push_back({"Cross-Origin-Resource-Policy", "same-origin"});
    answer.headers.push_back({"X-Frame-Options", "SAMEORIGIN"});
    if (!answer.header("Content-Security-Policy"))
        answer.headers.push_back({"Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'; sandbox"});
    exchange.status = answer.status;
    exchange.bytes = answer.file ? answer.file->length : answer.body.size();
}

LogEvent access_event(const Exchange& exchange) {
    const ApiRequest& request = exchange.head.request;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - exchange.begun;
    LogEvent event{is_of_monitor(request) ? LogLevel::debug : LogLevel::info,
                   "request",
                   "",
                   {{"method", request.method},
                    {"path", path_of(request)},
                    {"status", std::int64_t{exchange.status}},
                    {"bytes", static_cast<std::int64_t>(exchange.bytes)},
                    {"seconds", took.count()},
                    {"from", exchange.channel.peer()},
                    {"request_id", request.id}}};
    if (!request.client.empty()) event.fields.push_back({"client", request.client});
    return event;
}

}  // namespace shadowbench::service

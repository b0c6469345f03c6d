#include "service/http/guard.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "service/api/problem.h"
#include "service/http/head.h"

namespace shadowbench::service {
namespace {

bool is_port(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// "[::1]:8080" -> "::1", "localhost:8080" -> "localhost"; empty where anything but a port follows the name.
std::string without_port(std::string_view host) {
    const bool bracketed = host.starts_with('[');
    if (bracketed) host.remove_prefix(1);
    const std::size_t end = host.find(bracketed ? ']' : ':');
    if (end == std::string_view::npos) return bracketed ? std::string() : std::string(host);
    const std::string_view rest = host.substr(end + std::size_t{bracketed});
    const bool good = rest.empty() || (rest.starts_with(':') && is_port(rest.substr(1)));
    return good ? std::string(host.substr(0, end)) : std::string();
}

std::string token_of(const ApiRequest& request) {
    const std::string* authorization = request.header("authorization");
    if (!authorization) return {};
    const std::string scheme = lower(std::string_view(*authorization).substr(0, authorization->find(' ')));
    const std::size_t at = authorization->find_first_not_of(' ', scheme.size());
    return scheme == "bearer" && at != std::string::npos ? authorization->substr(at) : "";
}

bool needs_no_token(const ApiRequest& request) {
    const std::string& first = request.path[0];
    const bool is_single = request.path.size() == 1;
    return first == "assets" || (is_single && (first.empty() || first == "healthz" || first == "readyz"));
}

bool is_cross_origin(const ApiRequest& request) {
    const std::string *origin = request.header("origin"), *host = request.header("host");
    if (const std::string* site = request.header("sec-fetch-site"); site && !origin)
        return (*site == "cross-site" || *site == "same-site") && request.method != "GET" && request.method != "HEAD";
    if (!origin) return false;
    const std::size_t scheme = origin->find("://");
    return !host || scheme == std::string::npos || lower(origin->substr(scheme + 3)) != lower(*host);
}

}  // namespace

bool is_loopback(const std::string& host) {
    const std::string name = lower(host);
    return name == "localhost" || name == "127.0.0.1" || name == "::1";
}

bool equal_in_constant_time(const std::string& given, const std::string& secret) {
    volatile unsigned char differs = given.size() == secret.size() ? 0 : 1;
    for (std::size_t i = 0; i < secret.size(); ++i) {
        const char c = given.empty() ? '\0' : given[i % given.size()];
        differs = static_cast<unsigned char>(differs |
                                             (static_cast<unsigned char>(c) ^ static_cast<unsigned char>(secret[i])));
    }
    return differs == 0;
}

std::optional<ApiResponse> guard(ApiRequest& request, const GuardOptions& options) {
    const std::string* host = request.header("host");
    if (options.loopback && host && !is_loopback(without_port(*host)))
        return problem(421, "This server answers only to the hosts localhost, 127.0.0.1 and [::1].");
    if (is_cross_origin(request)) return problem(403, "Pages of other origins may not use this server.");
    const std::string token = token_of(request);
    bool known = false;
    for (const AccessToken& each : options.tokens)  // all of them, so that the time tells nothing
        if (equal_in_constant_time(token, each.secret)) {
            known = true;
            request.client = each.name;
        }
    if (known || options.tokens.empty() || needs_no_token(request)) return {};
    ApiResponse response = problem(401, "The request needs a token of the server, as in Authorization: Bearer TOKEN.");
    response.headers.push_back({"WWW-Authenticate", "Bearer realm=\"shadowbench\""});
    return response;
}

}  // namespace shadowbench::service

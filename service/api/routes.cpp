#include "service/api/routes.h"

#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace shadowbench::service {
namespace {

constexpr const char* json_type = "application/json";

constexpr Route table[] = {
    {"POST", "/v1/jobs", json_type, true, post_job},
    {"GET", "/v1/jobs", json_type, false, list_jobs, {"state", "limit", "cursor", "owner", "label", "text"}},
    {"GET", "/v1/jobs/{id}", json_type, false, get_job},
    {"DELETE", "/v1/jobs/{id}", "", false, delete_job},
    {"GET", "/v1/jobs/{id}/events", "text/event-stream", false, job_events},
    {"POST", "/v1/jobs/{id}/cancel", json_type, false, cancel_job},
    {"POST", "/v1/jobs/{id}/retry", json_type, false, retry_job},
    {"POST", "/v1/jobs/{id}/pin", json_type, false, pin_job},
    {"POST", "/v1/jobs/{id}/unpin", json_type, false, unpin_job},
    {"GET", "/v1/jobs/{id}/scenario", json_type, false, job_scenario},
    {"GET", "/v1/jobs/{id}/result", json_type, false, job_result},
    {"GET", "/v1/jobs/{id}/result.csv", "text/csv", false, job_csv},
    {"GET", "/v1/jobs/{id}/artifacts/{name...}", "", false, job_artifact},
    {"GET", "/v1/jobs/{id}/report", "text/html", false, job_report},
    {"GET", "/v1/jobs/{id}/curves", json_type, false, job_curves, {"light", "variant", "x", "y"}},
    {"POST", "/v1/recommendations", json_type, true, post_recommendation},
    {"POST", "/v1/compare", json_type, true, compare},
    {"POST", "/v1/validate", json_type, true, validate_scenario},
    {"GET", "/v1/files", json_type, false, list_files},
    {"POST", "/v1/new", json_type, true, new_scenario},
    {"GET", "/v1/techniques", json_type, false, list_techniques},
    {"GET", "/v1/scenarios", json_type, false, list_scenarios},
    {"GET", "/v1/schema", json_type, false, get_schema},
    {"GET", "/openapi.json", json_type, false, get_openapi},
    {"GET", "/healthz", json_type, false, get_health},
    {"GET", "/readyz", json_type, false, get_ready},
    {"GET", "/metrics", "text/plain", false, get_metrics},
    {"GET", "/", "text/html", false, get_page},
    {"GET", "/assets/{name...}", "", false, get_asset},
};

std::vector<std::string_view> segments_of(std::string_view pattern) {
    std::vector<std::string_view> segments;
    pattern.remove_prefix(1);
    for (;;) {
        const std::size_t slash = pattern.find('/');
        segments.push_back(pattern.substr(0, slash));
        if (slash == std::string_view::npos) return segments;
        pattern.remove_prefix(slash + 1);
    }
}

std::optional<PathParameters> match(const char* pattern, const std::vector<std::string>& path) {
    const std::vector<std::string_view> wanted = segments_of(pattern);
    PathParameters parameters;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (i >= path.size()) return {};
        const std::string_view segment = wanted[i];
        if (!segment.starts_with('{')) {
            if (path[i] != segment) return {};
            continue;
        }
        std::string name(segment.substr(1, segment.size() - 2));
        if (!name.ends_with("...")) {
            parameters[name] = path[i];
            continue;
        }
        std::string rest = path[i];
        for (std::size_t k = i + 1; k < path.size(); ++k) rest += "/" + path[k];
        parameters[name.substr(0, name.size() - 3)] = rest;
        return parameters;
    }
    if (path.size() > wanted.size()) return {};
    return parameters;
}

}  // namespace

const std::string& Call::parameter(const char* name) const {
    const auto found = path.find(name);
    if (found != path.end()) return found->second;
    throw base::Error(base::ErrorCode::internal, "path", std::string("the route has no parameter ") + name);
}

std::span<const Route> routes() {
    return table;
}

const Route* find_route(const ApiRequest& request, PathParameters& parameters, std::string& allowed) {
    const std::string method = request.method == "HEAD" ? "GET" : request.method;
    for (const Route& route : table) {
        std::optional<PathParameters> matched = match(route.pattern, request.path);
        if (!matched) continue;
        if (method == route.method) {
            parameters = std::move(*matched);
            return &route;
        }
        allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
        if (std::string_view(route.method) == "GET") allowed += ", HEAD";
    }
    return nullptr;
}

}  // namespace shadowbench::service

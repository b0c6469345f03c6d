#include "service/api/service.h"

#include <chrono>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "service/api/accept.h"
#include "service/api/context.h"
#include "service/api/describe.h"
#include "service/api/problem.h"
#include "service/api/routes.h"

namespace shadowbench::service {
namespace {

std::vector<std::string> helper_arguments(const char* command, const ServiceOptions& options) {
    std::vector<std::string> arguments{command};
    for (const std::filesystem::path& folder : options.data) arguments.push_back("--data=" + folder.string());
    return arguments;
}

std::vector<std::string> examine_arguments(const ServiceOptions& options) {
    std::vector<std::string> arguments = helper_arguments("examine", options);
    arguments.push_back(fmt::format("--pace={}", options.pace));
    return arguments;
}

bool is_json(const std::string& type) {
    const std::string name = media_type(type);
    return name == "application/json" || (name.starts_with("application/") && name.ends_with("+json"));
}

ApiResponse not_allowed(const std::string& allowed) {
    ApiResponse response = problem(405, "This path takes " + allowed + ".");
    response.headers.push_back({"Allow", allowed});
    return response;
}

std::optional<ApiResponse> refuse_query(const ApiRequest& request, const Route& route) {
    std::set<std::string> seen;
    for (const Field& given : request.query) {
        if (!seen.insert(given.name).second)
            return problem(400, "The parameter \"" + given.name + "\" is given twice; give it once.");
        std::string known;
        bool found = false;
        for (const char* name : route.query) {
            if (!name) break;
            known += (known.empty() ? "" : ", ") + std::string(name);
            found = found || given.name == name;
        }
        if (!found)
            return problem(400, "Unknown parameter \"" + given.name + "\"; " +
                                    (known.empty() ? "this request takes none." : "there are: " + known + "."));
    }
    return {};
}

std::optional<ApiResponse> refuse_body(const ApiRequest& request, const Route& route) {
    if (!request.has_body) return {};
    if (!route.takes_body) return problem(400, "This request takes no body.");
    if (request.header("content-encoding")) return problem(415, "The body must be sent without Content-Encoding.");
    const std::string* type = request.header("content-type");
    if (!type || !is_json(*type)) {
        ApiResponse response = problem(415, "The body must be JSON, with Content-Type: application/json.");
        response.headers.push_back({"Accept-Post", "application/json"});
        return response;
    }
    return {};
}

std::optional<ApiResponse> refuse_request(const ApiRequest& request, const Route* route, const std::string& allowed) {
    if (!route && !allowed.empty()) return not_allowed(allowed);
    if (!route) return problem(404, "There is nothing at this path; /openapi.json lists all paths.");
    if (route->type[0] != '\0' && !accepts(request, route->type))
        return problem(406,
                       std::string("This path answers with ") + route->type + ", which the Accept header excludes.");
    if (auto refusal = refuse_query(request, *route)) return refusal;
    return refuse_body(request, *route);
}

// The cause of a fault on this side goes to the operator, not to the client: it may name folders of the server.
void log_fault(const Context& context, const ApiRequest& request, const Route& route, const char* cause) {
    say(context.options.log, {LogLevel::error,
                              "fault",
                              cause,
                              {{"method", request.method}, {"route", route.pattern}, {"request_id", request.id}}});
}

ApiResponse answer(Context& context, const ApiRequest& request, const Route& route, const PathParameters& parameters) {
    try {
        return route.answer(context, {request, parameters});
    } catch (const base::Error& error) {
        if (error.code() == base::ErrorCode::io || error.code() == base::ErrorCode::internal)
            log_fault(context, request, route, error.what());
        return problem_of(error);
    } catch (const Busy&) {
        ApiResponse response = problem(503, "The server works on too many requests of this kind; try again later.");
        response.headers.push_back({"Retry-After", "2"});
        return response;
    } catch (const std::exception& fault) {
        log_fault(context, request, route, fault.what());
        return problem(500, "Internal fault of the server.");
    }
}

}  // namespace

struct Service::State : Context {
    using Context::Context;
};

Context::Context(Jobs& the_jobs, const ServiceOptions& the_options)
    : jobs(the_jobs),
      options(the_options),
      examiner(options.start_helper, examine_arguments(options), options.helper_seconds, options.waiting),
      curves(options.start_helper, helper_arguments("curves", options), options.helper_seconds, options.waiting),
      scenarios(read_scenarios(options.scenarios)) {}

Service::Service(Jobs& jobs, ServiceOptions options) : state_(std::make_unique<State>(jobs, std::move(options))) {}

Service::~Service() = default;

std::optional<ApiResponse> Service::refuse(const ApiRequest& request) const {
    PathParameters parameters;
    std::string allowed;
    const Route* route = find_route(request, parameters, allowed);
    return refuse_request(request, route, allowed);
}

ApiResponse Service::handle(const ApiRequest& request) {
    const auto start = std::chrono::steady_clock::now();
    PathParameters parameters;
    std::string allowed;
    const Route* route = find_route(request, parameters, allowed);
    std::optional<ApiResponse> response = refuse_request(request, route, allowed);
    if (!response && request.body.size() > limits().body)
        response = problem(413, "The body is larger than " + std::to_string(limits().body) + " bytes.");
    if (!response) response = answer(*state_, request, *route, parameters);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    state_->metrics.count(route ? request.method : "other", route ? route->pattern : "none", response->status,
                          seconds.count());
    return std::move(*response);
}

void Service::count_refusal(const ApiRequest& request, int status) {
    PathParameters parameters;
    std::string allowed;
    const Route* route = find_route(request, parameters, allowed);
    state_->metrics.count(route ? request.method : "other", route ? route->pattern : "none", status, 0.0);
}

const CostLimits& Service::limits() const {
    return state_->options.limits;
}

}  // namespace shadowbench::service

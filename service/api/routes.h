// The routes of the API. openapi.json documents the same list; a test compares the two.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>

#include "service/api/context.h"
#include "service/api/message.h"

namespace shadowbench::service {

using PathParameters = std::map<std::string, std::string>;

struct Call {
    const ApiRequest& request;
    const PathParameters& path;
    // The part of the path in the place of {name}. Throws Error{internal} where the route's pattern does not have it.
    const std::string& parameter(const char* name) const;
};

struct Route {
    const char* method;
    const char* pattern;  // "{name}" is one segment, "{name...}" the rest of the path
    const char* type;     // media type of a successful answer; "": several types
    bool takes_body;      // JSON
    ApiResponse (*answer)(Context& context, const Call& call);
    std::array<const char*, 6> query = {};  // names of its parameters, then null
};

std::span<const Route> routes();

// The route of a request; HEAD finds that of GET. Null where there is none. `allowed` then gets the methods that the
// path has; it stays empty for an unknown path.
const Route* find_route(const ApiRequest& request, PathParameters& parameters, std::string& allowed);

// The answers.
ApiResponse post_job(Context& context, const Call& call);
ApiResponse post_recommendation(Context& context, const Call& call);
ApiResponse list_jobs(Context& context, const Call& call);
ApiResponse get_job(Context& context, const Call& call);
ApiResponse cancel_job(Context& context, const Call& call);
ApiResponse retry_job(Context& context, const Call& call);
ApiResponse pin_job(Context& context, const Call& call);
ApiResponse unpin_job(Context& context, const Call& call);
ApiResponse delete_job(Context& context, const Call& call);
ApiResponse job_events(Context& context, const Call& call);
ApiResponse job_result(Context& context, const Call& call);
ApiResponse job_csv(Context& context, const Call& call);
ApiResponse job_artifact(Context& context, const Call& call);
ApiResponse job_report(Context& context, const Call& call);
ApiResponse job_scenario(Context& context, const Call& call);
ApiResponse job_curves(Context& context, const Call& call);
ApiResponse compare(Context& context, const Call& call);
ApiResponse validate_scenario(Context& context, const Call& call);
ApiResponse list_files(Context& context, const Call& call);
ApiResponse new_scenario(Context& context, const Call& call);
ApiResponse list_techniques(Context& context, const Call& call);
ApiResponse list_scenarios(Context& context, const Call& call);
ApiResponse get_schema(Context& context, const Call& call);
ApiResponse get_openapi(Context& context, const Call& call);
ApiResponse get_page(Context& context, const Call& call);
ApiResponse get_asset(Context& context, const Call& call);
ApiResponse get_health(Context& context, const Call& call);
ApiResponse get_ready(Context& context, const Call& call);
ApiResponse get_metrics(Context& context, const Call& call);

}  // namespace shadowbench::service

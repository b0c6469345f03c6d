#include "service/api/routes.h"

#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>
#include <tuple>

#include "api/fixture.h"
#include "base/error.h"
#include "document/document.h"
#include "service/api/openapi_text.h"
#include "techniques/technique.h"

namespace shadowbench::service {
namespace {

struct RoutesApi : ApiTest {};

std::string documented_path(std::string pattern) {
    if (const std::size_t dots = pattern.find("..."); dots != std::string::npos) pattern.erase(dots, 3);
    return pattern;
}

TEST(Routes, AParameterThatAPatternDoesNotHaveIsAFaultOfTheProgram) {
    const ApiRequest request{};
    const PathParameters path{{"id", "7"}};
    const Call call{request, path};
    EXPECT_EQ(call.parameter("id"), "7");
    EXPECT_THROW(call.parameter("name"), base::Error);
}

TEST(OpenApi, HasEveryRouteAndNoOther) {
    const nlohmann::json document = nlohmann::json::parse(openapi_text());
    EXPECT_TRUE(document["openapi"].get<std::string>().starts_with("3.0."));
    std::set<std::string> documented, there;
    for (const auto& [path, operations] : document["paths"].items())
        for (const auto& [method, operation] : operations.items()) documented.insert(method + " " + path);
    for (const Route& route : routes()) {
        std::string method = route.method;
        for (char& c : method) c = static_cast<char>(std::tolower(c));
        there.insert(method + " " + documented_path(route.pattern));
    }
    EXPECT_EQ(documented, there);
}

TEST(OpenApi, SaysWhatTheRoutesSay) {
    const nlohmann::json document = nlohmann::json::parse(openapi_text());
    std::set<std::string> names;
    for (const Route& route : routes()) {
        std::string method = route.method;
        for (char& c : method) c = static_cast<char>(std::tolower(c));
        const nlohmann::json& operation = document["paths"][documented_path(route.pattern)][method];
        EXPECT_EQ(operation.contains("requestBody"), route.takes_body) << route.pattern;
        EXPECT_TRUE(names.insert(operation["operationId"]).second) << route.pattern;
        for (const auto& [status, response] : operation["responses"].items())
            if (status[0] == '2' && response.contains("content") && route.type[0] != '\0') {
                EXPECT_TRUE(response["content"].contains(route.type)) << route.pattern << " " << status;
            }
    }
}

std::set<std::string> documented_query(const nlohmann::json& operation) {
    std::set<std::string> names;
    for (const nlohmann::json& parameter : operation.value("parameters", nlohmann::json::array()))
        if (parameter.value("in", "") == "query") names.insert(parameter["name"]);
    return names;
}

TEST(OpenApi, HasEveryQueryParameterAndNoOther) {
    const nlohmann::json document = nlohmann::json::parse(openapi_text());
    for (const Route& route : routes()) {
        std::string method = route.method;
        for (char& c : method) c = static_cast<char>(std::tolower(c));
        std::set<std::string> known;
        for (const char* name : route.query)
            if (name) known.insert(name);
        EXPECT_EQ(documented_query(document["paths"][documented_path(route.pattern)][method]), known) << route.pattern;
    }
}

TEST(OpenApi, RefersToWhatItHas) {
    const nlohmann::json document = nlohmann::json::parse(openapi_text());
    const std::function<void(const nlohmann::json&)> walk = [&](const nlohmann::json& part) {
        if (part.is_object() && part.contains("$ref")) {
            const std::string reference = part["$ref"];
            EXPECT_TRUE(document.contains(nlohmann::json::json_pointer(reference.substr(1)))) << reference;
        }
        if (part.is_structured())
            for (const auto& child : part) walk(child);
    };
    walk(document);
}

TEST_F(RoutesApi, SayWhatIsNotThere) {
    for (const char* target :
         {"/v2/jobs", "/v1", "/v1/jobs/", "/v1/jobs/a/b", "/v1/jobs/a/events/x", "/index.html", "/v1//jobs"})
        EXPECT_EQ(answer(request("GET", target)).status, 404) << target;
    EXPECT_EQ(answer(request("GET", "/assets/none.js")).status, 404);
}

TEST_F(RoutesApi, RefuseParametersThatTheyDoNotKnow) {
    for (const Route& route : routes()) {
        std::string target = route.pattern;
        for (const char* name : {"{id}", "{name...}"})
            if (const std::size_t at = target.find(name); at != std::string::npos)
                target.replace(at, std::string(name).size(), "a");
        refused(request(route.method, target + "?lite=1"), 400, "Unknown parameter \"lite\"");
        EXPECT_TRUE(service_->refuse(request(route.method, target + "?lite=1"))) << "known from its head";
    }
    refused(request("GET", "/v1/jobs?limit=1&status=queued"), 400, "there are: state, limit, cursor");
    refused(request("GET", "/v1/techniques?x=1"), 400, "takes none");
    refused(request("GET", "/v1/jobs?state=queued&state=failed"), 400, "given twice");
}

TEST_F(RoutesApi, SayWhichMethodsTheyTake) {
    for (const auto& [method, target, allowed] :
         {std::tuple("PUT", "/v1/jobs", "POST, GET, HEAD"), std::tuple("POST", "/v1/jobs/j-1", "GET, HEAD, DELETE"),
          std::tuple("GET", "/v1/compare", "POST"), std::tuple("HEAD", "/v1/validate", "POST"),
          std::tuple("BREW", "/", "GET, HEAD")}) {
        const ApiResponse response = answer(request(method, target));
        EXPECT_EQ(response.status, 405) << target;
        ASSERT_TRUE(response.header("Allow")) << target;
        EXPECT_EQ(*response.header("Allow"), allowed) << target;
    }
}

TEST_F(RoutesApi, LookAtTheTypesBeforeTheBody) {
    EXPECT_EQ(answer(request("GET", "/v1/jobs", {{"accept", "text/html"}})).status, 406);
    EXPECT_EQ(answer(request("GET", "/v1/jobs", {{"accept", "application/*"}})).status, 200);
    const std::string scenario = tiny_scenario().dump();
    for (const char* type :
         {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", ""}) {
        const ApiRequest form = post("/v1/jobs", scenario, {{"content-type", type}});
        EXPECT_EQ(answer(form).status, 415) << type;
        EXPECT_EQ(service_->refuse(form)->status, 415) << "known from its head";
    }
    for (const char* type : {"application/json; charset=utf-8", "Application/JSON", "application/ld+json"})
        EXPECT_EQ(answer(post("/v1/jobs", scenario, {{"content-type", type}})).status, 202) << type;
    for (const char* coding : {"gzip", "br", "identity"})
        EXPECT_EQ(answer(post("/v1/jobs", scenario, {{"content-encoding", coding}})).status, 415) << coding;
    ApiRequest get = request("GET", "/v1/jobs");
    get.has_body = true;
    EXPECT_EQ(answer(get).status, 400);
    EXPECT_FALSE(service_->refuse(request("HEAD", "/v1/jobs")));
}

TEST_F(RoutesApi, HoldBodiesToTheLimit) {
    ServiceOptions options = standard_options();
    options.limits.body = 100;
    start(options);
    EXPECT_EQ(answer(post("/v1/jobs", std::string(101, ' '))).status, 413);
    EXPECT_EQ(answer(post("/v1/jobs", std::string(100, ' '))).status, 400) << "accepted, but not JSON";
}

TEST_F(RoutesApi, DescribeEveryTechnique) {
    const nlohmann::json list = json(request("GET", "/v1/techniques"), 200)["techniques"];
    ASSERT_EQ(list.size(), techniques::all().size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const techniques::Technique& row = techniques::all()[i];
        EXPECT_EQ(list[i]["id"], row.id);
        EXPECT_EQ(list[i]["promises"]["opaque_only"], row.promises.opaque_only);
        EXPECT_EQ(list[i]["promises"]["approximate"], row.promises.approximate);
        EXPECT_EQ(list[i]["promises"]["early"], row.promises.early);
        ASSERT_EQ(list[i]["parameters"].size(), row.parameters.size());
        // Its own defaults are within what it says of its parameters.
        for (const nlohmann::json& parameter : list[i]["parameters"]) {
            const nlohmann::json& standard = parameter["default"];
            if (standard.is_number()) {
                EXPECT_GE(standard, parameter["minimum"]) << row.id << parameter;
                EXPECT_LE(standard, parameter["maximum"]) << row.id << parameter;
            } else {
                EXPECT_NE(std::find(parameter["values"].begin(), parameter["values"].end(), standard),
                          parameter["values"].end())
                    << row.id << parameter;
            }
        }
    }
}

TEST_F(RoutesApi, GiveScenariosThatAreTaken) {
    const nlohmann::json list = json(request("GET", "/v1/scenarios"), 200)["scenarios"];
    const auto named = [&](const char* name) {
        return std::find_if(list.begin(), list.end(), [&](const nlohmann::json& one) { return one["name"] == name; });
    };
    ASSERT_NE(named("quickstart"), list.end());
    EXPECT_FALSE((*named("quickstart"))["purpose"].get<std::string>().empty());
    EXPECT_EQ(answer(post("/v1/validate", (*named("quickstart"))["document"].dump())).status, 200);
}

TEST_F(RoutesApi, GiveTheSchemaAndThisDescription) {
    EXPECT_EQ(json(request("GET", "/v1/schema"), 200), document::full_schema());
    EXPECT_EQ(json(request("GET", "/openapi.json"), 200), nlohmann::json::parse(openapi_text()));
    const ApiResponse schema = answer(request("GET", "/v1/schema"));
    EXPECT_EQ(answer(request("GET", "/v1/schema", {{"if-none-match", *schema.header("ETag")}})).status, 304);
}

TEST_F(RoutesApi, GiveThePageUnderAStrictPolicy) {
    const ApiResponse page = answer(request("GET", "/"));
    EXPECT_EQ(page.status, 200);
    const std::string policy = *page.header("Content-Security-Policy");
    EXPECT_TRUE(policy.starts_with("default-src 'none';")) << policy;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos) << policy;
    EXPECT_EQ(answer(request("GET", "/", {{"if-none-match", *page.header("ETag")}})).status, 304);
}

TEST_F(RoutesApi, CountWhatTheyAnswered) {
    submit();
    answer(request("GET", "/v1/jobs/j-1"));
    answer(request("GET", "/v1/jobs/j-2"));
    answer(request("PROPFIND", "/nowhere"));
    const ApiResponse response = answer(request("GET", "/metrics"));
    EXPECT_TRUE(response.type.starts_with("text/plain; version=0.0.4"));
    const auto has = [&](const std::string& line) {
        EXPECT_NE(response.body.find(line + "\n"), std::string::npos) << line << " is missing in\n" << response.body;
    };
    has("shadowbench_jobs{state=\"queued\"} 1");
    has("shadowbench_jobs{state=\"failed\"} 0");
    has("shadowbench_queue_length 1");
    has("shadowbench_http_requests_total{method=\"GET\",route=\"/v1/jobs/{id}\",code=\"404\"} 2");
    has("shadowbench_http_requests_total{method=\"POST\",route=\"/v1/jobs\",code=\"202\"} 1");
    has("shadowbench_http_requests_total{method=\"other\",route=\"none\",code=\"404\"} 1");
    has("shadowbench_http_request_seconds_bucket{method=\"GET\",route=\"/v1/jobs/{id}\",le=\"+Inf\"} 2");
    has("shadowbench_http_request_seconds_count{method=\"GET\",route=\"/v1/jobs/{id}\"} 2");
    has("# TYPE shadowbench_http_request_seconds histogram");
    has("shadowbench_jobs_ended_total{state=\"failed\"} 0");
    for (const char* name :
         {"process_cpu_seconds_total ", "process_resident_memory_bytes ", "process_open_fds ",
          "process_start_time_seconds ", "shadowbench_build_info{version=\"", "shadowbench_results_bytes "})
        EXPECT_NE(response.body.find("\n" + std::string(name)), std::string::npos) << name;
}

TEST_F(RoutesApi, CountWhatBecameOfJobs) {
    JobTally tally;
    tally.submitted = 5;
    tally.runs = 7;
    tally.ended["failed"] = 2;
    tally.requeued["died"] = 3;
    tally.seconds.add(0.05);
    tally.seconds.add(50.0);
    tally.waits.add(1e6);
    fake::set_tally(*jobs_, tally);
    const std::string text = answer(request("GET", "/metrics")).body;
    for (const char* line :
         {"shadowbench_jobs_submitted_total 5", "shadowbench_job_runs_total 7",
          "shadowbench_jobs_ended_total{state=\"failed\"} 2", "shadowbench_jobs_ended_total{state=\"succeeded\"} 0",
          "shadowbench_jobs_requeued_total{reason=\"died\"} 3", "shadowbench_job_seconds_bucket{le=\"0.1\"} 1",
          "shadowbench_job_seconds_bucket{le=\"30\"} 1", "shadowbench_job_seconds_bucket{le=\"60\"} 2",
          "shadowbench_job_seconds_sum 50.05", "shadowbench_job_wait_seconds_bucket{le=\"86400\"} 0",
          "shadowbench_job_wait_seconds_bucket{le=\"+Inf\"} 1"})
        EXPECT_NE(text.find(std::string(line) + "\n"), std::string::npos) << line << " is missing in\n" << text;
}

// What a fault on this side says of itself stays here.
TEST_F(RoutesApi, SayNothingOfTheCauseOfTheirOwnFaults) {
    ServiceOptions options = standard_options();
    options.start_helper = [](const std::vector<std::string>&) -> std::unique_ptr<Helper> {
        throw std::runtime_error("secret /etc/path");
    };
    start(options);
    ApiResponse response = answer(post("/v1/jobs", tiny_scenario().dump()));
    EXPECT_EQ(response.status, 500);
    EXPECT_EQ(response.body.find("secret"), std::string::npos);
    options.start_helper = [](const std::vector<std::string>&) -> std::unique_ptr<Helper> {
        throw base::Error(base::ErrorCode::io, "/secret/place", "secret");
    };
    start(options);
    response = answer(post("/v1/jobs", tiny_scenario().dump()));
    EXPECT_EQ(response.status, 503);
    EXPECT_EQ(response.body.find("secret"), std::string::npos);
}

}  // namespace
}  // namespace shadowbench::service

// The answers under /v1/jobs that submit, list, show, cancel, retry and remove jobs and give their files.
#include <algorithm>
#include <charconv>

#include <nlohmann/json.hpp>

#include "service/api/file_answer.h"
#include "service/api/job_json.h"
#include "service/api/problem.h"
#include "service/api/routes.h"
#include "service/api/submit.h"
#include "service/web/report.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t longest_key = 255, longest_page = 200, page = 50;

ApiResponse no_such_job() {
    return problem(404, "There is no such job.");
}

ApiResponse try_later(int status, const std::string& detail, const char* seconds) {
    ApiResponse response = problem(status, detail);
    response.headers.push_back({"Retry-After", seconds});
    return response;
}

ApiResponse queue_is_full() {
    return try_later(429, "The queue of jobs is full; try again later.", "30");
}

bool is_key(const std::string& key) {
    return !key.empty() && key.size() <= longest_key &&
           std::all_of(key.begin(), key.end(), [](char c) { return c >= 0x20 && c <= 0x7e; });
}

ApiResponse submitted(const Context& context, const ApiRequest& request, const Submitted& outcome) {
    switch (outcome.outcome) {
        case Submitted::Outcome::conflict:
            return problem(409, "This Idempotency-Key was already used for another request.");
        case Submitted::Outcome::queue_full:
            return queue_is_full();
        case Submitted::Outcome::owner_queue_full:
            return try_later(429, "As many jobs of this token wait as may; try again later.", "30");
        case Submitted::Outcome::owner_bytes:
            return try_later(429, "The results of this token take as much space as they may; delete jobs.", "3600");
        case Submitted::Outcome::created:
        case Submitted::Outcome::existing:
            break;
    }
    ApiResponse response = json_answer(202, job_json(context.jobs, outcome.job, request.prefix));
    response.headers.push_back({"Location", request.prefix + "/v1/jobs/" + outcome.job.id});
    return response;
}

// A file of a job, or the answer that says why there is none.
ApiResponse job_file(const Context& context, const Call& call, const std::string& name) {
    const std::string& id = call.parameter("id");
    const std::optional<JobInfo> job = context.jobs.find(id);
    if (!job) return no_such_job();
    if (const auto file = context.jobs.artifact(id, name)) return file_answer(call.request, *file);
    if (job->state == JobState::succeeded) return problem(404, "There is no such file.");
    return problem(409,
                   std::string("The job is ") + to_string(job->state) + "; only a job that succeeded has results.");
}

// Queues what `read` finds in the body.
ApiResponse queue(Context& context, const Call& call,
                  std::variant<PostedScenario, ApiResponse> (*read)(const std::string& body)) {
    if (context.jobs.stopping()) return try_later(503, "The server is stopping.", "10");
    const std::string* key = call.request.header("idempotency-key");
    if (key && !is_key(*key)) return problem(400, "An Idempotency-Key must have 1 to 255 printable ASCII characters.");
    auto posted = read(call.request.body);
    if (auto* refusal = std::get_if<ApiResponse>(&posted)) return std::move(*refusal);
    auto& scenario = std::get<PostedScenario>(posted);
    auto examined = examine_posted(context, scenario);
    if (auto* refusal = std::get_if<ApiResponse>(&examined)) return std::move(*refusal);
    const auto& facts = std::get<nlohmann::json>(examined);
    JobRequest request;
    request.scenario = std::move(scenario.text);
    request.name = facts.at("name").get<std::string>();
    request.hash = facts.at("hash").get<std::string>();
    request.seed = facts.at("seed").get<std::uint64_t>();
    request.pictures = scenario.pictures;
    request.recommend = std::move(scenario.recommend);
    request.reuse = scenario.reuse;
    request.labels = std::move(scenario.labels);
    request.priority = scenario.priority;
    request.owner = call.request.client;
    if (key) request.idempotency_key = *key;
    return submitted(context, call.request, context.jobs.submit(request));
}

ApiResponse set_pinned(Context& context, const Call& call, bool pinned) {
    const std::string& id = call.parameter("id");
    const Jobs::Change change = context.jobs.pin(id, pinned);
    const std::optional<JobInfo> job = context.jobs.find(id);
    if (change == Jobs::Change::not_found || !job) return no_such_job();
    return json_answer(200, job_json(context.jobs, *job, call.request.prefix));
}

}  // namespace

ApiResponse post_job(Context& context, const Call& call) {
    return queue(context, call, read_posted);
}

ApiResponse post_recommendation(Context& context, const Call& call) {
    return queue(context, call, read_posted_recommendation);
}

ApiResponse list_jobs(Context& context, const Call& call) {
    JobFilter filter;
    for (const auto& [name, wanted] :
         {std::pair("owner", &filter.owner), std::pair("label", &filter.label), std::pair("text", &filter.text)})
        if (const std::string* text = call.request.parameter(name)) *wanted = *text;
    if (const std::string* text = call.request.parameter("state")) {
        filter.state = parse_job_state(*text);
        if (!filter.state)
            return problem(400, "The parameter state must be queued, running, succeeded, failed or cancelled.");
    }
    std::size_t limit = page;
    if (const std::string* text = call.request.parameter("limit")) {
        const auto [rest, fault] = std::from_chars(text->data(), text->data() + text->size(), limit);
        if (fault != std::errc() || rest != text->data() + text->size() || limit < 1 || limit > longest_page)
            return problem(400, "The parameter limit must be a number from 1 to 200.");
    }
    const std::string* cursor = call.request.parameter("cursor");
    const JobPage found = context.jobs.list(filter, limit, cursor ? *cursor : "");
    nlohmann::ordered_json jobs = nlohmann::ordered_json::array();
    for (const JobInfo& job : found.jobs) jobs.push_back(job_json(context.jobs, job, call.request.prefix));
    nlohmann::ordered_json answer = {{"jobs", std::move(jobs)}, {"next", nullptr}};
    if (!found.next.empty()) answer["next"] = found.next;
    return json_answer(200, answer);
}

ApiResponse get_job(Context& context, const Call& call) {
    const std::optional<JobInfo> job = context.jobs.find(call.parameter("id"));
    return job ? json_answer(200, job_json(context.jobs, *job, call.request.prefix)) : no_such_job();
}

ApiResponse cancel_job(Context& context, const Call& call) {
    const std::string& id = call.parameter("id");
    const Jobs::Change change = context.jobs.cancel(id);
    const std::optional<JobInfo> job = context.jobs.find(id);
    if (change == Jobs::Change::not_found || !job) return no_such_job();
    if (change == Jobs::Change::refused) return problem(409, "The job has already ended.");
    return json_answer(202, job_json(context.jobs, *job, call.request.prefix));
}

ApiResponse retry_job(Context& context, const Call& call) {
    if (context.jobs.stopping()) return try_later(503, "The server is stopping.", "10");
    const std::string& id = call.parameter("id");
    switch (context.jobs.retry(id)) {
        case Jobs::Retry::not_found:
            return no_such_job();
        case Jobs::Retry::refused:
            return problem(409, "Only a job that failed or was cancelled can be retried.");
        case Jobs::Retry::busy:
            return try_later(503, "The last run of the job is still ending; try again later.", "2");
        case Jobs::Retry::full:
            return queue_is_full();
        case Jobs::Retry::queued:
            break;
    }
    const std::optional<JobInfo> job = context.jobs.find(id);
    return job ? json_answer(202, job_json(context.jobs, *job, call.request.prefix)) : no_such_job();
}

ApiResponse pin_job(Context& context, const Call& call) {
    return set_pinned(context, call, true);
}

ApiResponse unpin_job(Context& context, const Call& call) {
    return set_pinned(context, call, false);
}

ApiResponse delete_job(Context& context, const Call& call) {
    const Jobs::Change change = context.jobs.remove(call.parameter("id"));
    if (change == Jobs::Change::not_found) return no_such_job();
    if (change == Jobs::Change::refused) return problem(409, "The job is running; cancel it first.");
    ApiResponse response;
    response.status = 204;
    return response;
}

ApiResponse job_scenario(Context& context, const Call& call) {
    const std::optional<std::string> text = context.jobs.scenario(call.parameter("id"));
    return text ? text_answer(call.request, "application/json", *text) : no_such_job();
}

ApiResponse job_result(Context& context, const Call& call) {
    return job_file(context, call, "result.json");
}

ApiResponse job_csv(Context& context, const Call& call) {
    return job_file(context, call, "result.csv");
}

ApiResponse job_artifact(Context& context, const Call& call) {
    return job_file(context, call, call.parameter("name"));
}

ApiResponse job_report(Context& context, const Call& call) {
    ApiResponse file = job_result(context, call);
    if (file.status != 200) return file;
    const auto result = context.jobs.artifact(call.parameter("id"), "result.json");
    if (!result) return no_such_job();
    const nlohmann::json document = nlohmann::json::parse(read_all(*file.file));
    ApiResponse response;
    response.type = "text/html; charset=utf-8";
    // The report is sandboxed: its inline scripts run, but cannot reach this server.
    response.headers = {{"Cache-Control", "private, no-cache"},
                        {"Content-Security-Policy",
                         "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; "
                         "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
                         "frame-ancestors 'self'"}};
    try {
        response.body = report_html(document, result->parent_path() / "images");
    } catch (const base::Error&) {  // its place is a folder of the server
        return problem(500, "The pictures of this job cannot be read.");
    }
    return response;
}

}  // namespace shadowbench::service

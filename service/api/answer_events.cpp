// GET /v1/jobs/{id}/events: the changes of a job as server-sent events (HTML standard, 9.2).
#include <charconv>
#include <chrono>

#include <nlohmann/json.hpp>

#include "service/api/job_json.h"
#include "service/api/problem.h"
#include "service/api/routes.h"

namespace shadowbench::service {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds heartbeat{15};
// Longest wait of one call, in seconds. The server looks for closed connections between calls.
constexpr double slice = 1.0;

// Counts one client that follows events, from take() on for as long as it lives.
class Place {
public:
    static std::shared_ptr<Place> take(Context& context) {
        std::shared_ptr<Place> place(new Place(context.streams));
        return place->number_ <= context.options.event_streams ? place : nullptr;
    }
    ~Place() { --*count_; }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

private:
    explicit Place(std::shared_ptr<std::atomic<std::size_t>> count) : count_(std::move(count)), number_(++*count_) {}
    std::shared_ptr<std::atomic<std::size_t>> count_;
    std::size_t number_;
};

// What one client has received.
struct Follower {
    std::string id, prefix;
    std::uint64_t revision = 0;
    std::optional<JobState> state;
    bool started = false, ended = false;
    Clock::time_point last_sent = Clock::now();
};

std::string event_text(const Jobs& jobs, const JobInfo& job, Follower& follower) {
    const bool new_state = follower.state != job.state;
    follower.revision = job.revision;
    follower.state = job.state;
    follower.ended = has_ended(job);
    const char* kind = follower.ended ? "end" : new_state ? "state" : "progress";
    const nlohmann::ordered_json value = job_json(jobs, job, follower.prefix);
    return "id: " + std::to_string(job.revision) + "\nevent: " + kind +
           "\ndata: " + value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n\n";
}

std::optional<std::string> next_events(const Jobs& jobs, Follower& follower) {
    if (follower.ended || jobs.stopping()) return {};
    std::string text;
    if (!follower.started) text = "retry: 2000\n\n";
    const std::optional<JobInfo> job =
        follower.started ? jobs.wait(follower.id, follower.revision, slice) : jobs.find(follower.id);
    if (!job) return {};  // removed
    if (job->revision > follower.revision || (!follower.started && follower.revision == 0))
        text += event_text(jobs, *job, follower);
    else if (Clock::now() - follower.last_sent >= heartbeat)
        text += ": here\n\n";
    follower.started = true;
    if (!text.empty()) follower.last_sent = Clock::now();
    return text;
}

// The number in Last-Event-ID; 0, before all events, where it has none.
std::uint64_t last_event(const ApiRequest& request) {
    const std::string* text = request.header("last-event-id");
    std::uint64_t id = 0;
    if (text && std::from_chars(text->data(), text->data() + text->size(), id).ec != std::errc()) id = 0;
    return id;
}

}  // namespace

ApiResponse job_events(Context& context, const Call& call) {
    const std::optional<JobInfo> job = context.jobs.find(call.parameter("id"));
    if (!job) return problem(404, "There is no such job.");
    Follower follower;
    follower.id = job->id;
    follower.prefix = call.request.prefix;
    follower.revision = last_event(call.request);
    ApiResponse response;
    if (follower.revision > job->revision) follower.revision = 0;  // from an earlier run of the server
    if (has_ended(*job) && follower.revision == job->revision && follower.revision > 0) {
        response.status = 204;  // no event will follow; the client does not reconnect
        return response;
    }
    std::shared_ptr<Place> place = Place::take(context);
    if (!place || context.jobs.stopping()) {
        response = problem(503, place ? "The server is stopping." : "Too many clients follow events; try again later.");
        response.headers.push_back({"Retry-After", "5"});
        return response;
    }
    response.type = "text/event-stream";
    response.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
    response.events = [&jobs = context.jobs, place, follower]() mutable { return next_events(jobs, follower); };
    return response;
}

}  // namespace shadowbench::service

#include <optional>
#include <sstream>
#include <utility>

#include "api/fixture.h"

namespace shadowbench::service {
namespace {

struct Event {
    std::string id, kind;
    nlohmann::json data;
};

std::vector<Event> events_of(const std::string& text) {
    std::vector<Event> events;
    Event event;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("id: ")) event.id = line.substr(4);
        if (line.starts_with("event: ")) event.kind = line.substr(7);
        if (line.starts_with("data: ")) event.data = nlohmann::json::parse(line.substr(6));
        if (line.empty() && !event.kind.empty()) events.push_back(std::exchange(event, {}));
    }
    return events;
}

struct EventsApi : ApiTest {
    ApiResponse follow(const std::string& id, const std::string& last = "") {
        std::vector<Field> headers;
        if (!last.empty()) headers.push_back({"last-event-id", last});
        ApiResponse response = service_->handle(request("GET", "/v1/jobs/" + id + "/events", headers));
        return response;
    }
    // What comes next, if not nothing.
    std::vector<Event> next(ApiResponse& stream) {
        const std::optional<std::string> text = stream.events();
        EXPECT_TRUE(text) << "the stream has ended";
        return events_of(text.value_or(""));
    }
};

TEST_F(EventsApi, TellEveryChangeOfAJob) {
    const std::string id = submit();
    ApiResponse stream = follow(id);
    EXPECT_EQ(stream.status, 200);
    EXPECT_EQ(stream.type, "text/event-stream");
    std::vector<Event> events = next(stream);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, "state");
    EXPECT_EQ(events[0].data["state"], "queued");
    fake::run(*jobs_, id);
    events = next(stream);
    EXPECT_EQ(events[0].kind, "state");
    EXPECT_EQ(events[0].data["state"], "running");
    fake::progress(*jobs_, id, {"build", "", 1, 2, 0.5});
    events = next(stream);
    EXPECT_EQ(events[0].kind, "progress");
    EXPECT_EQ(events[0].data["progress"]["fraction"], 0.5);
    fake::succeed(*jobs_, id, {{"result.json", "{}"}});
    events = next(stream);
    EXPECT_EQ(events[0].kind, "end");
    EXPECT_EQ(events[0].data["artifacts"], nlohmann::json{"result.json"});
    EXPECT_EQ(events[0].id, std::to_string(jobs_->find(id)->revision));
    EXPECT_FALSE(stream.events()) << "nothing follows the end";
}

TEST_F(EventsApi, GoOnBehindTheLastOneSeen) {
    const std::string id = submit();
    ApiResponse first = follow(id);
    const std::string seen = next(first)[0].id;
    ApiResponse again = follow(id, seen);
    EXPECT_TRUE(events_of(*again.events()).empty()) << "it has seen that";
    fake::run(*jobs_, id);
    EXPECT_EQ(next(again)[0].data["state"], "running");
    fake::succeed(*jobs_, id, {});
    ApiResponse late = follow(id, seen);
    EXPECT_EQ(next(late)[0].kind, "end");
    const std::string end = std::to_string(jobs_->find(id)->revision);
    EXPECT_EQ(follow(id, end).status, 204) << "a client that has seen the end does not come again";
    for (const char* odd : {"x", "-1", "99999999999999999999999", "7000"}) {
        ApiResponse from_start = follow(id, odd);
        EXPECT_EQ(from_start.status, 200) << odd;
        EXPECT_EQ(next(from_start)[0].kind, "end") << odd;
    }
}

TEST_F(EventsApi, EndWhenTheJobIsRemovedOrTheServerStops) {
    const std::string id = submit(), other = submit();
    ApiResponse removed = follow(id), stopped = follow(other);
    next(removed);
    next(stopped);
    jobs_->remove(id);
    EXPECT_FALSE(removed.events());
    jobs_->stop();
    EXPECT_FALSE(stopped.events());
    EXPECT_EQ(follow(other).status, 503);
    EXPECT_EQ(follow(id).status, 404);
}

TEST_F(EventsApi, AreForSoManyClientsAtATime) {
    ServiceOptions options = standard_options();
    options.event_streams = 2;
    start(options);
    const std::string id = submit();
    std::vector<ApiResponse> streams;
    streams.push_back(follow(id));
    streams.push_back(follow(id));
    const ApiResponse third = follow(id);
    EXPECT_EQ(third.status, 503);
    EXPECT_TRUE(third.header("Retry-After"));
    streams.pop_back();
    EXPECT_EQ(follow(id).status, 200) << "a place is free again";
    EXPECT_NE(service_->handle(request("GET", "/metrics")).body.find("shadowbench_event_streams 1\n"),
              std::string::npos);
}

}  // namespace
}  // namespace shadowbench::service

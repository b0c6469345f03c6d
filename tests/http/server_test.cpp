// Every endpoint over the line, and what HTTP itself asks for.
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "http/fixture.h"
#include "service/http/client.h"

namespace shadowbench::service {
namespace {

struct Server : HttpTest {};

TEST_F(Server, AnswersEveryEndpoint) {
    const std::string id = ended_job(), job = "/v1/jobs/" + id;
    for (const std::string& target :
         {std::string("/"), std::string("/healthz"), std::string("/readyz"), std::string("/metrics"),
          std::string("/openapi.json"), std::string("/v1/techniques"), std::string("/v1/scenarios"),
          std::string("/v1/schema"), std::string("/v1/jobs"), std::string("/v1/jobs?state=succeeded&limit=1"), job,
          job + "/scenario", job + "/result", job + "/result.csv", job + "/report",
          job + "/artifacts/images/reference.png", job + "/artifacts/images/empty.exr"})
        EXPECT_EQ(ask(get(target)).status, 200) << target;
    EXPECT_EQ(ask(post("/v1/validate", scenario)).status, 200);
    refused(post("/v1/compare", "{}"), 422, "job");
    refused(get(job + "/curves"), 400, "pixel");
    const std::string other = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    const RawAnswer cancelled = ask(post("/v1/jobs/" + other + "/cancel", ""));
    EXPECT_EQ(cancelled.status, 202) << cancelled.body;
    EXPECT_EQ(ask(post("/v1/jobs/" + other + "/retry", "")).status, 202);
    const RawAnswer removed = ask(get("/v1/jobs/" + other, "", "DELETE"));
    EXPECT_EQ(removed.status, 204);
    EXPECT_FALSE(removed.has("Content-Length")) << removed.head;
    refused(get("/v1/jobs/" + other), 404);
    refused(get("/assets/none.js"), 404);
}

TEST_F(Server, TellsWhereANewJobIs) {
    const RawAnswer answer = ask(post("/v1/jobs", scenario));
    EXPECT_EQ(answer.status, 202);
    EXPECT_TRUE(answer.has("Location: /v1/jobs/j-"));
}

TEST_F(Server, KeepsConnectionsAndTakesRequestsAheadOfTheirTime) {
    Raw raw(port());
    raw.send(get("/healthz") + post("/v1/jobs", scenario) + get("/readyz") + get("/nothing") + get("/healthz"));
    for (const int status : {200, 202, 200, 404, 200}) EXPECT_EQ(raw.receive().status, status);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(raw.ask(get("/healthz")).status, 200) << i;
    const RawAnswer last = raw.ask(get("/healthz", "Connection: close\r\n"));
    EXPECT_TRUE(last.has("Connection: close"));
    EXPECT_TRUE(raw.closed());
}

TEST_F(Server, TakesARequestThatComesInPieces) {
    Raw raw(port());
    const std::string text = "\r\n" + post("/v1/jobs", scenario);
    for (const char c : text) ASSERT_TRUE(raw.send(std::string(1, c)));
    EXPECT_EQ(raw.receive().status, 202);
}

TEST_F(Server, AnswersHeadWithoutABody) {
    const std::string target = "/v1/jobs/" + ended_job() + "/artifacts/images/reference.png";
    Raw raw(port());
    raw.send(get(target, "", "HEAD") + get("/healthz", "", "HEAD") + get("/healthz"));
    const RawAnswer file = raw.receive(true);
    EXPECT_EQ(file.status, 200);
    EXPECT_TRUE(file.has("Content-Length: 10\r\n")) << file.head;
    EXPECT_TRUE(file.has("Accept-Ranges: bytes")) << file.head;
    EXPECT_EQ(raw.receive(true).status, 200);
    EXPECT_EQ(raw.receive().body, "{\"status\":\"ok\"}\n") << "the next answer follows at once";
}

TEST_F(Server, RefusesMethodsItDoesNotKnow) {
    for (const char* method : {"PUT", "PATCH", "OPTIONS", "TRACE", "CONNECT", "PRI", "BREW", "get"}) {
        refused(get("/v1/jobs", "", method), 405);
        EXPECT_TRUE(ask(get("/v1/jobs", "", method)).has("Allow: POST, GET, HEAD")) << method;
    }
    refused(get("/v1/jobs", "", "G(T"), 400);
}

TEST_F(Server, GivesOneRangeOfAFileAndItsVersion) {
    const std::string target = "/v1/jobs/" + ended_job() + "/artifacts/images/";
    const RawAnswer part = ask(get(target + "reference.png", "Range: bytes=2-4\r\n"));
    EXPECT_EQ(part.status, 206);
    EXPECT_EQ(part.body, "234");
    EXPECT_TRUE(part.has("Content-Range: bytes 2-4/10"));
    for (const char* range : {"bytes=20-", "bytes=-0", "bytes=x"})
        refused(get(target + "reference.png", std::string("Range: ") + range + "\r\n"), 416);
    for (const char* ranges : {"bytes=0-1,3-4", "bytes=0-0,0-0,0-0,0-0,0-0,0-0,0-0,0-0"}) {
        const RawAnswer all = ask(get(target + "reference.png", std::string("Range: ") + ranges + "\r\n"));
        EXPECT_EQ(all.status, 200) << ranges;
        EXPECT_EQ(all.body, "0123456789") << ranges;
    }
    Raw head(port());
    head.send(get(target + "reference.png", "Range: bytes=2-4\r\n", "HEAD"));
    const RawAnswer length = head.receive(true);
    EXPECT_EQ(length.status, 200);
    EXPECT_TRUE(length.has("Content-Length: 10\r\n")) << length.head;
    const RawAnswer whole = ask(get(target + "large.exr"));
    EXPECT_EQ(whole.body.size(), 1'288'890u);
    EXPECT_EQ(ask(get(target + "large.exr", "Range: bytes=1000000-\r\n")).body, whole.body.substr(1'000'000));
    const std::size_t at = whole.head.find("ETag: ") + 6;
    const std::string etag = whole.head.substr(at, whole.head.find("\r\n", at) - at);
    const RawAnswer known = ask(get(target + "large.exr", "If-None-Match: " + etag + "\r\n"));
    EXPECT_EQ(known.status, 304);
    EXPECT_FALSE(known.has("Content-Length")) << known.head;
}

TEST_F(Server, SaysOnceWhenABodyMayCome) {
    Raw raw(port());
    raw.send(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nExpect: 100-continue\r\n"
        "Content-Length: " +
        std::to_string(scenario.size()) + "\r\n\r\n");
    EXPECT_EQ(raw.receive().status, 100);
    EXPECT_EQ(raw.ask(scenario).status, 202);
    Raw refused(port());
    refused.send(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\nExpect: 100-continue\r\n"
        "Content-Length: 5\r\n\r\n");
    EXPECT_EQ(refused.receive().status, 415) << "and not 100 before";
}

TEST_F(Server, SpeaksToOldClients) {
    Raw raw(port());
    const RawAnswer answer = raw.ask("GET /healthz HTTP/1.0\r\n\r\n");
    EXPECT_EQ(answer.status, 200);
    EXPECT_TRUE(raw.closed());
    refused("GET / HTTP/3.0\r\nHost: localhost\r\n\r\n", 505);
}

TEST_F(Server, SendsEventsAsTheyCome) {
    const std::string id = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    Raw raw(port());
    raw.send(get("/v1/jobs/" + id + "/events"));
    EXPECT_NE(raw.receive_until("\r\n\r\n").find("text/event-stream"), std::string::npos);
    EXPECT_NE(raw.receive_until("\n\n\r\n").find("\"state\":\"queued\""), std::string::npos);
    fake::run(*jobs_, id);
    EXPECT_NE(raw.receive_until("\n\n\r\n").find("\"state\":\"running\""), std::string::npos);
    fake::succeed(*jobs_, id, {});
    EXPECT_NE(raw.receive_until("\n\n\r\n").find("event: end"), std::string::npos);
    EXPECT_NE(raw.receive_until("0\r\n\r\n"), "");
    EXPECT_TRUE(raw.closed());
    const std::string last = std::to_string(jobs_->find(id)->revision);
    EXPECT_EQ(ask(get("/v1/jobs/" + id + "/events", "Last-Event-ID: " + last + "\r\n")).status, 204);
}

TEST_F(Server, GuardsItsPages) {
    const RawAnswer page = ask(get("/"));
    EXPECT_TRUE(page.has("Content-Security-Policy: default-src 'none'; script-src 'self'")) << page.head;
    for (const RawAnswer& answer : {page, ask(get("/healthz")), ask(get("/nothing"))}) {
        EXPECT_TRUE(answer.has("X-Content-Type-Options: nosniff")) << answer.head;
        EXPECT_TRUE(answer.has("Referrer-Policy: no-referrer")) << answer.head;
    }
    refused("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", 421);
    refused(get("/", "Origin: http://evil.example\r\n"), 403);
}

TEST_F(Server, AsksForItsToken) {
    http_options_.tokens = {{"", "0123456789abcdef"}};
    restart();
    const RawAnswer answer = ask(get("/v1/jobs"));
    EXPECT_EQ(answer.status, 401);
    EXPECT_TRUE(answer.has("WWW-Authenticate: Bearer"));
    EXPECT_EQ(ask(get("/v1/jobs", "Authorization: Bearer 0123456789abcdef\r\n")).status, 200);
    EXPECT_EQ(ask(post("/v1/jobs", scenario, "Authorization: Bearer wrong\r\n")).status, 401);
    EXPECT_EQ(ask(get("/healthz")).status, 200);
    EXPECT_EQ(ask(get("/")).status, 200) << "the page asks for the token";
    Client client(server_->url(), "0123456789abcdef");
    EXPECT_EQ(client.get("/v1/jobs").status, 200);
    EXPECT_EQ(Client(server_->url(), "").get("/v1/jobs").status, 401);
}

TEST_F(Server, ListensBeyondThisMachineOnlyWithAToken) {
    HttpOptions options;
    options.host = "0.0.0.0";
    EXPECT_THROW(HttpServer(*service_, 1, options), base::Error);
    options.tokens = {{"", "0123456789abcdef"}};
    EXPECT_GT(HttpServer(*service_, 1, options).port(), 0);
}

TEST_F(Server, SaysWhenItsPortIsTaken) {
    HttpOptions options;
    options.port = port();
    try {
        const HttpServer second(*service_, 1, options);
        ADD_FAILURE() << "two servers listen at one port";
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::io);
    }
}

TEST_F(Server, StopsWhileClientsAreConnected) {
    const std::string id = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    Raw idle(port()), follower(port()), half(port()), body(port());
    EXPECT_EQ(idle.ask(get("/healthz")).status, 200);
    follower.send(get("/v1/jobs/" + id + "/events"));
    follower.receive_until("queued");
    half.send("GET /heal");
    body.send(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 5\r\n\r\n{");
    stop();
    EXPECT_TRUE(idle.closed());
}

TEST_F(Server, StopsBeforeItRuns) {
    HttpServer other(*service_, 1, {});
    other.stop();
    other.run();
}

TEST(HttpClient, SaysWhenThereIsNoServer) {
    EXPECT_THROW(Client("ftp://x", ""), base::Error);
    Client client("http://127.0.0.1:1", "");  // a port that only root could listen at, and does not
    EXPECT_THROW(client.get("/"), base::Error);
}

}  // namespace
}  // namespace shadowbench::service

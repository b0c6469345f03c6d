// /healthz, /readyz and /metrics while other clients hold all threads.
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "http/fixture.h"
#include "service/http/lobby.h"

namespace shadowbench::service {
namespace {

// All but the end of a request.
std::string slow_body(const std::string& headers = "") {
    const std::string body(5000, ' '), text = post("/v1/jobs", body, headers);
    return text.substr(0, text.size() - body.size() + 1);
}

struct Monitors : HttpTest {
    // So many clients that send this and then nothing.
    void occupy(int clients, const std::string& text) {
        for (int i = 0; i < clients; ++i) {
            others.push_back(std::make_unique<Raw>(port()));
            others.back()->send(text);
        }
    }
    void are_answered() {
        for (const char* target : {"/healthz", "/readyz", "/metrics", "/healthz"}) {
            const auto start = std::chrono::steady_clock::now();
            EXPECT_EQ(ask(get(target)).status, 200) << target;
            // Otherwise they would wait until the other clients are cut off, after 5 s and more.
            EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4)) << target;
        }
    }
    std::vector<std::unique_ptr<Raw>> others;
};

TEST_F(Monitors, AreAnsweredBesideSlowBodies) {
    occupy(96, slow_body());
    are_answered();
    Raw head(port());
    head.send(get("/readyz", "", "HEAD"));
    EXPECT_EQ(head.receive(true).status, 200);
    EXPECT_TRUE(head.closed()) << "its thread waits for nobody";
    // One who sends the head in pieces is answered when it is there.
    Raw pieces(port());
    for (const char c : get("/metrics")) pieces.send(std::string(1, c));
    EXPECT_EQ(pieces.receive().status, 200);
}

TEST_F(Monitors, AreAnsweredBesideIdleConnections) {
    occupy(200, "");
    are_answered();
}

TEST_F(Monitors, AreAnsweredBesideHalfHeads) {
    occupy(100, "GET /healthz HTTP/1.1\r\nHost: local");
    are_answered();
}

// Who has said nothing for a second makes room for others.
TEST_F(Monitors, AreAnsweredWhereTooManyIdleConnectionsWait) {
    http_options_.waiting = 10;
    restart();
    occupy(8, slow_body());  // on every thread
    occupy(40, "");
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    are_answered();
}

TEST_F(Monitors, NeedTheTokenAsOnAnyThread) {
    http_options_.tokens = {{"", "0123456789abcdef"}};
    restart();
    occupy(30, slow_body("Authorization: Bearer 0123456789abcdef\r\n"));
    EXPECT_EQ(ask(get("/healthz")).status, 200);
    EXPECT_EQ(ask(get("/metrics")).status, 401);
    EXPECT_EQ(ask(get("/metrics", "Authorization: Bearer 0123456789abcdef\r\n")).status, 200);
    EXPECT_EQ(ask("GET /healthz HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 421);
}

TEST(Lobbies, KnowMonitorsByTheirWholeHead) {
    EXPECT_EQ(asks(get("/healthz")), Asks::monitor);
    EXPECT_EQ(asks(get("/readyz", "", "HEAD")), Asks::monitor);
    EXPECT_EQ(asks("GET /metrics HTTP/1.0\r\n\r\n"), Asks::monitor);
    for (const char* start :
         {"G", "GET /", "GET /healthz", "HEAD /metrics HTTP/1.", "GET /healthz HTTP/1.1\r\nHost: a\r\n"})
        EXPECT_EQ(asks(start), Asks::unclear) << start;
    for (const char* start :
         {"P", "GET  /", "GET /v1/jobs HTTP/1.1\r\n\r\n", "GET /healthzz", "POST /healthz HTTP/1.1\r\n"})
        EXPECT_EQ(asks(start), Asks::other) << start;
    EXPECT_EQ(asks("GET /healthz HTTP/1.1\r\nX: " + std::string(5000, 'x')), Asks::other) << "it has no end";
}

}  // namespace
}  // namespace shadowbench::service

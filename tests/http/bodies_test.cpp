// How bodies come in.
#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "http/fixture.h"

namespace shadowbench::service {
namespace {

struct Bodies : HttpTest {};

TEST_F(Bodies, HaveTrailersThatAreNotTakenForTheNextRequest) {
    const std::string chunked =
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        "Transfer-Encoding: chunked\r\n\r\n10\r\n" +
        scenario + "\r\n";
    Raw raw(port());
    raw.send(chunked + "0\r\nContent-Length: 7\r\nX: y\r\n\r\n" + get("/healthz"));
    EXPECT_EQ(raw.receive().status, 202);
    EXPECT_EQ(raw.receive().body, "{\"status\":\"ok\"}\n");
}

TEST_F(Bodies, AreCutOffThatDrip) {
    http_options_.channel.body_grace = 0.5;
    http_options_.channel.body_rate = 1000.0;
    restart();
    Raw drip(port());
    const auto start = std::chrono::steady_clock::now();
    drip.send(post("/v1/jobs", std::string(5000, ' ')).substr(0, 150));
    for (int i = 0; i < 60 && drip.send(" "); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(drip.receive().status, 400);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(15)) << "and not after 30 s";
    // One that comes as fast as it must may take longer than that.
    Raw steady(port());
    std::string body = scenario + std::string(3000, ' ');
    steady.send(post("/v1/jobs", body).substr(0, post("/v1/jobs", body).size() - body.size()));
    for (; !body.empty(); body.erase(0, std::min<std::size_t>(body.size(), 250))) {
        ASSERT_TRUE(steady.send(body.substr(0, 250)));
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_EQ(steady.receive().status, 202);
}

}  // namespace
}  // namespace shadowbench::service

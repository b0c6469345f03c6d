// What cpp-httplib 0.11.4 would let through, and other ways to harm a server, byte for byte.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "http/fixture.h"

namespace shadowbench::service {
namespace {

struct Holes : HttpTest {};

const std::string chunked_head =
    "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n";

std::string chunk(const std::string& bytes) {
    char size[32];
    std::snprintf(size, sizeof size, "%zx\r\n", bytes.size());
    return size + bytes + "\r\n";
}

TEST_F(Holes, ChunkedBodiesAreTakenWithinTheLimit) {
    std::string text = chunked_head;
    for (const char c : scenario) text += chunk(std::string(1, c));
    EXPECT_EQ(ask(text + "0\r\n\r\n").status, 202);
    EXPECT_EQ(ask(chunked_head + chunk(scenario + std::string(9000, ' ')) + "0\r\n\r\n").status, 202);
}

TEST_F(Holes, ChunkedBodiesPastTheLimitAreRefused) {
    refused(chunked_head + chunk(std::string(10'001, ' ')) + "0\r\n\r\n", 413, "10000");
    std::string many = chunked_head;
    for (int i = 0; i < 200; ++i) many += chunk(std::string(100, ' '));
    refused(many, 413);
    Raw endless(port());
    endless.send(chunked_head);
    const std::string piece = chunk(std::string(1000, ' '));
    for (int i = 0; i < 100'000 && endless.send(piece); ++i) {
    }
    EXPECT_EQ(endless.receive().status, 413) << "and the answer is not lost";
    EXPECT_TRUE(endless.closed());
}

TEST_F(Holes, BrokenChunksAreRefused) {
    http_options_.channel.body_seconds = 1.0;  // some leave the server waiting for more
    restart();
    for (const char* body :
         {"zz\r\n", "-5\r\nabcde\r\n0\r\n\r\n", "5\r\nabcdeXX0\r\n\r\n", "\r\n\r\n", "0x2\r\n{}\r\n0\r\n\r\n",
          "+2\r\n{}\r\n0\r\n\r\n", " 2\r\n{}\r\n0\r\n\r\n", "2 2\r\n{}\r\n0\r\n\r\n", "2\n{}\n0\n\n"})
        refused(chunked_head + body, 400);
    refused(chunked_head + "ffffffffffffffff\r\n", 400);
    // Chunk sizes that never end.
    Raw endless(port());
    endless.send(chunked_head);
    for (int i = 0; i < 1000 && endless.send(std::string(1000, '0')); ++i) {
    }
    EXPECT_EQ(endless.receive().status, 400);
}

TEST_F(Holes, LargeBodiesAreRefusedBeforeTheyCome) {
    refused(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 10001\r\n\r\n",
        413, "10000");
    refused(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        "Content-Length: 18446744073709551615\r\n\r\n",
        413);
    // One who sends it all the same still gets to read why not.
    EXPECT_EQ(ask(post("/v1/jobs", std::string(2'000'000, ' '))).status, 413);
}

TEST_F(Holes, EncodedBodiesAreRefused) {
    for (const char* coding : {"gzip", "deflate", "br", "identity", "x, br"})
        refused(post("/v1/jobs", scenario, std::string("Content-Encoding: ") + coding + "\r\n"), 415,
                "Content-Encoding");
}

TEST_F(Holes, FormsOfAnySizeAreRefused) {
    for (const std::size_t size : {10u, 8191u, 8193u, 9999u}) {
        std::string form = post("/v1/jobs", "a=" + std::string(size, 'b'));
        form.replace(form.find("application/json"), 16, "application/x-www-form-urlencoded");
        refused(form, 415, "application/json");
    }
    std::string form = post("/v1/jobs", "--x\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\nb\r\n--x--\r\n");
    form.replace(form.find("application/json"), 16, "multipart/form-data; boundary=x");
    refused(form, 415, "application/json");
}

TEST_F(Holes, BodiesWhereNoneBelongAreRefused) {
    // Left unread, they would be taken for the next request.
    const std::string hidden = get("/v1/jobs/j-1/hidden");
    for (const char* method : {"GET", "HEAD", "DELETE"}) {
        Raw raw(port());
        raw.send(get("/v1/jobs/j-1", "Content-Length: " + std::to_string(hidden.size()) + "\r\n", method) + hidden);
        EXPECT_EQ(raw.receive(method == std::string("HEAD")).status, 400) << method;
        EXPECT_TRUE(raw.closed()) << method;
    }
    Raw raw(port());
    raw.send(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 4\r\n"
        "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n" +
        hidden);
    EXPECT_EQ(raw.receive().status, 400);
    EXPECT_TRUE(raw.closed());
}

TEST_F(Holes, APostWithoutALengthHasNoBody) {
    const std::string id = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    Raw raw(port());
    raw.send("POST /v1/jobs/" + id + "/cancel HTTP/1.1\r\nHost: localhost\r\n\r\n" + get("/healthz"));
    EXPECT_EQ(raw.receive().status, 202) << "and does not wait for the end of the connection";
    EXPECT_EQ(raw.receive().status, 200);
}

TEST_F(Holes, FaultsKeepTheirCauseToThemselves) {
    service_options_.start_helper = [](const std::vector<std::string>&) -> std::unique_ptr<Helper> {
        throw std::runtime_error("secret\r\nInjected: yes");
    };
    restart();
    const RawAnswer answer = ask(post("/v1/jobs", scenario));
    EXPECT_EQ(answer.status, 500);
    for (const char* text : {"EXCEPTION_WHAT", "secret", "Injected"}) {
        EXPECT_FALSE(answer.has(text)) << answer.head;
        EXPECT_EQ(answer.body.find(text), std::string::npos) << answer.body;
    }
}

TEST_F(Holes, AddressesThatClientsTellAreNobodysBusiness) {
    http_options_.tokens = {{"", "0123456789abcdef"}};
    restart();
    const std::string lies =
        "REMOTE_ADDR: 127.0.0.1\r\nREMOTE_PORT: 1\r\nLOCAL_ADDR: 127.0.0.1\r\nX-Forwarded-For: ::1\r\n";
    EXPECT_EQ(ask(get("/v1/jobs", lies)).status, 401);
    EXPECT_EQ(ask(get("/v1/jobs", lies + "Authorization: Bearer 0123456789abcdef\r\n")).status, 200);
}

TEST_F(Holes, PathsLeadNowhereElse) {
    std::ofstream(folder_ / "secret.txt") << "secret";
    const std::string id = ended_job(), target = "/v1/jobs/" + id + "/artifacts/";
    std::filesystem::create_symlink(folder_ / "secret.txt", fake::folder(*jobs_, id) / "images/link.png");
    for (const std::string& way :
         {std::string("../../secret.txt"), std::string("%2e%2e/%2e%2e/secret.txt"), std::string("..%2f..%2fsecret.txt"),
          std::string("images/..\\..\\..\\secret.txt"), std::string("%252e%252e/secret.txt"),
          "/" + (folder_ / "secret.txt").string(), std::string("images/link.png"), std::string("..%c0%afsecret.txt"),
          std::string("result.json%00.png"), std::string("images/"), std::string("")}) {
        const RawAnswer answer = ask(get(target + way));
        EXPECT_TRUE(answer.status == 400 || answer.status == 404) << way << " " << answer.status;
        EXPECT_EQ(answer.body.find("secret\n"), std::string::npos) << way;
        EXPECT_NE(answer.body, "secret") << way;
    }
    EXPECT_EQ(ask(get(target + "result.json")).status, 200);
    for (const char* path : {"/../../../etc/passwd", "/assets/../../etc/passwd", "/assets/%2e%2e/%2e%2e/etc/passwd"})
        EXPECT_EQ(ask(get(path)).status, 400) << path;
}

TEST_F(Holes, HeadsWithoutEndAreCutOff) {
    for (const char* start :
         {"GET /", "GET / HTTP/1.1\r\nHost: localhost\r\nX: ", "GET / HTTP/1.1\r\nHost: localhost\r\n"}) {
        Raw raw(port());
        raw.send(start);
        const std::string more =
            start[5] == ' ' && std::string(start).ends_with("\r\n") ? "A: b\r\n" : std::string(1000, 'x');
        for (int i = 0; i < 100'000 && raw.send(more); ++i) {
        }
        EXPECT_EQ(raw.receive().status, 431) << start;
    }
    EXPECT_EQ(ask(get("/healthz", "X: " + std::string(20'000, 'x') + "\r\n")).status, 200);
    EXPECT_EQ(ask(get("/" + std::string(20'000, 'a'))).status, 404) << "a long path causes no deep recursion";
}

TEST_F(Holes, SlowClientsDoNotKeepOthersOut) {
    http_options_.channel.head_seconds = 1.0;
    http_options_.channel.body_seconds = 2.0;
    restart();
    std::vector<std::unique_ptr<Raw>> slow;
    // More than there are threads: some say nothing, some half a head, some half a body.
    for (int i = 0; i < 24; ++i) {
        slow.push_back(std::make_unique<Raw>(port()));
        if (i % 3 == 1) slow.back()->send("GET / HTTP/1.1\r\nHost: loc");
        if (i % 3 == 2)
            slow.back()->send(
                "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                "Content-Length: 100\r\n\r\n{");
    }
    for (int i = 0; i < 10; ++i) EXPECT_EQ(ask(get("/v1/jobs")).status, 200);
}

TEST_F(Holes, ConnectionsThatWaitForTheirNextRequestMakeRoom) {
    std::vector<std::unique_ptr<Raw>> idle;
    for (int i = 0; i < 30; ++i) {
        idle.push_back(std::make_unique<Raw>(port()));
        EXPECT_EQ(idle.back()->ask(get("/healthz")).status, 200) << i;
    }
}

TEST_F(Holes, TooManyConnectionsAreTurnedAway) {
    http_options_.workers = 1;
    http_options_.waiting = 2;
    service_options_.event_streams = 1;
    restart();
    const std::string id = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    // Both threads are at work: with events, and with a body that does not come.
    Raw follower(port());
    follower.send(get("/v1/jobs/" + id + "/events"));
    follower.receive_until("queued");
    Raw busy(port());
    busy.send(
        "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nExpect: 100-continue\r\n"
        "Content-Length: 10\r\n\r\n");
    ASSERT_EQ(busy.receive().status, 100) << "a thread waits for its body";
    const Raw first(port()), second(port());  // these wait for a thread
    const RawAnswer answer = Raw(port()).receive();
    EXPECT_EQ(answer.status, 503);
    EXPECT_TRUE(answer.has("Retry-After"));
}

TEST_F(Holes, FollowersOfEventsAreSoManyAtATime) {
    const std::string id = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    const std::string events = get("/v1/jobs/" + id + "/events");
    std::vector<std::unique_ptr<Raw>> followers;
    for (int i = 0; i < 4; ++i) {
        followers.push_back(std::make_unique<Raw>(port()));
        followers.back()->send(events);
        followers.back()->receive_until("queued");
    }
    refused(events, 503, "follow events");
    EXPECT_TRUE(ask(events).has("Retry-After"));
    // Those that went are seen to be gone.
    followers.clear();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    int status = 503;
    while (status == 503 && std::chrono::steady_clock::now() < end) {
        Raw again(port());
        again.send(events);
        status = std::atoi(again.receive_until("\r\n\r\n").substr(9, 3).c_str());
        if (status == 503) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_EQ(status, 200);
}

TEST_F(Holes, ClientsThatGoInTheMiddleHarmNobody) {
    const std::string target = "/v1/jobs/" + ended_job() + "/artifacts/images/large.exr";
    for (int i = 0; i < 20; ++i) {
        Raw raw(port());
        raw.send(i % 2 ? get(target) : post("/v1/jobs", scenario).substr(0, 150));
    }
    EXPECT_EQ(ask(get("/healthz")).status, 200);
}

TEST_F(Holes, NoiseIsAnsweredOrDropped) {
    std::uint64_t state = 1;
    for (int i = 0; i < 200; ++i) {
        std::string noise = i % 2 ? post("/v1/jobs", scenario) : "";
        for (int k = 0; k < 200; ++k) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const char c = static_cast<char>(state >> 56);
            if (noise.size() < 200)
                noise += c;
            else
                noise[(state >> 20) % noise.size()] = c;
        }
        Raw raw(port());
        raw.send(noise);
        raw.end();
        raw.receive();
    }
    EXPECT_EQ(ask(get("/healthz")).status, 200);
}

// 200 clients that read again and again, beside 50 that follow events.
TEST_F(Holes, ManyReadersAndFollowersAreServed) {
    service_options_.event_streams = 50;
    http_options_.workers = 16;
    restart();
    const std::string id = nlohmann::json::parse(ask(post("/v1/jobs", scenario)).body).at("id");
    std::vector<std::unique_ptr<Raw>> followers;
    for (int i = 0; i < 50; ++i) {
        followers.push_back(std::make_unique<Raw>(port()));
        followers.back()->send(get("/v1/jobs/" + id + "/events"));
    }
    for (const auto& follower : followers) EXPECT_NE(follower->receive_until("queued"), "");
    std::atomic<int> good = 0;
    std::vector<std::thread> readers;
    for (int i = 0; i < 200; ++i)
        readers.emplace_back([&] {
            for (int k = 0; k < 5; ++k)
                if (Raw(port()).ask(get("/v1/jobs/" + id)).status == 200) ++good;
        });
    for (std::thread& reader : readers) reader.join();
    EXPECT_EQ(good, 1000);
    fake::succeed(*jobs_, id, {});
    for (const auto& follower : followers) EXPECT_NE(follower->receive_until("event: end"), "");
}

}  // namespace
}  // namespace shadowbench::service

// What the operator of a server sees and sets: request ids, the log, names of tokens, and a proxy in front.
#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "http/fixture.h"
#include "service/http/client.h"
#include "service/http/prefix.h"

namespace shadowbench::service {
namespace {

class Operator : public HttpTest {
protected:
    Operator() {
        http_options_.log = service_options_.log = [this](const LogEvent& event) {
            const std::scoped_lock lock(mutex_);
            events_.push_back(event);
        };
        restart();
    }
    ~Operator() override { stop(); }

    static std::string field(const LogEvent& event, const std::string& name) {
        for (const LogField& each : event.fields)
            if (each.name == name) {
                const auto* text = std::get_if<std::string>(&each.value);
                const auto* number = std::get_if<std::int64_t>(&each.value);
                return text ? *text : number ? std::to_string(*number) : "a fraction";
            }
        return "none";
    }
    // The line of a request. The client may have its answer a moment before.
    LogEvent line_of(const std::string& id, const std::string& kind = "request") {
        for (int i = 0; i < 6000; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
            const std::scoped_lock lock(mutex_);
            for (const LogEvent& event : events_)
                if (event.kind == kind && field(event, "request_id") == id) return event;
        }
        ADD_FAILURE() << "no line about " << id;
        return {};
    }
    static std::string id_of(const RawAnswer& answer) {
        const std::string name = "X-Request-Id: ";
        const std::size_t at = answer.head.find(name);
        if (at == std::string::npos) return "";
        return answer.head.substr(at + name.size(), answer.head.find('\r', at) - at - name.size());
    }
    std::string job_of(const std::string& token, const std::string& headers = "") {
        const RawAnswer answer = ask(post("/v1/jobs", scenario, "Authorization: Bearer " + token + "\r\n" + headers));
        EXPECT_EQ(answer.status, 202) << answer.body;
        return answer.body;
    }

    std::mutex mutex_;
    std::vector<LogEvent> events_;
};

TEST_F(Operator, TakesOrMakesTheIdOfARequestAndGivesItBack) {
    const RawAnswer given = ask(get("/v1/jobs/none", "X-Request-Id: trace-1.a/B=\r\n"));
    EXPECT_EQ(id_of(given), "trace-1.a/B=");
    EXPECT_EQ(nlohmann::json::parse(given.body)["request_id"], "trace-1.a/B=");
    const std::string made = id_of(ask(get("/v1/jobs"))), other = id_of(ask(get("/v1/jobs")));
    EXPECT_EQ(made.size(), 16u);
    EXPECT_NE(made, other);
    // Nothing that could forge a line of a log, or break one.
    for (const std::string& bad :
         {std::string("a b"), std::string("a\"b"), std::string(129, 'x'), std::string("\xc3\xa9")})
        EXPECT_EQ(id_of(ask(get("/v1/jobs", "X-Request-Id: " + bad + "\r\n"))).size(), 16u) << bad;
    const RawAnswer malformed = ask("GET /\x01 HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(malformed.status, 400);
    EXPECT_EQ(nlohmann::json::parse(malformed.body)["request_id"], id_of(malformed)) << "also refused by its head";
}

TEST_F(Operator, WritesALineAboutEachRequest) {
    ask(get("/v1/jobs/none", "X-Request-Id: one\r\n"));
    const LogEvent line = line_of("one");
    EXPECT_EQ(line.level, LogLevel::info);
    EXPECT_EQ(field(line, "method"), "GET");
    EXPECT_EQ(field(line, "path"), "/v1/jobs/none");
    EXPECT_EQ(field(line, "status"), "404");
    EXPECT_EQ(field(line, "from"), "127.0.0.1");
    ask(get("/healthz", "X-Request-Id: two\r\n"));
    EXPECT_EQ(line_of("two").level, LogLevel::debug) << "a monitor asks every few seconds";
}

TEST_F(Operator, WritesTheCauseOfItsOwnFaults) {
    service_options_.start_helper = [](const std::vector<std::string>&) -> std::unique_ptr<Helper> {
        throw base::Error(base::ErrorCode::io, "/state/place", "no space");
    };
    restart();
    const RawAnswer answer = ask(post("/v1/jobs", scenario, "X-Request-Id: bad\r\n"));
    EXPECT_EQ(answer.status, 503);
    EXPECT_EQ(answer.body.find("/state/place"), std::string::npos);
    const LogEvent line = line_of("bad", "fault");
    EXPECT_EQ(line.level, LogLevel::error);
    EXPECT_NE(line.message.find("/state/place"), std::string::npos);
}

TEST_F(Operator, KnowsTheOwnersOfTokens) {
    http_options_.tokens = {{"ann", "0123456789abcdef"}, {"bo", "fedcba9876543210"}};
    restart();
    EXPECT_EQ(nlohmann::json::parse(job_of("0123456789abcdef"))["owner"], "ann");
    EXPECT_EQ(nlohmann::json::parse(job_of("fedcba9876543210", "X-Request-Id: b\r\n"))["owner"], "bo");
    EXPECT_EQ(field(line_of("b"), "client"), "bo");
    EXPECT_EQ(ask(get("/v1/jobs", "Authorization: Bearer \r\n")).status, 401);
    EXPECT_EQ(ask(get("/v1/jobs", "Authorization: Bearer ann\r\n")).status, 401);
}

TEST_F(Operator, LinksHaveThePrefixOfAProxy) {
    const std::string through = "X-Forwarded-Prefix: /tools/lab\r\n";
    const RawAnswer answer = ask(post("/v1/jobs", scenario, through));
    const nlohmann::json job = nlohmann::json::parse(answer.body);
    const std::string self = "/tools/lab/v1/jobs/" + job["id"].get<std::string>();
    EXPECT_TRUE(answer.has("Location: " + self + "\r\n")) << answer.head;
    EXPECT_EQ(job["links"]["result"], self + "/result");
    const std::string page = ask(get("/", through)).body;
    EXPECT_NE(page.find("\"/tools/lab/assets/"), std::string::npos);
    EXPECT_EQ(page.find("\"/assets/"), std::string::npos);
    const std::string odd = ask(get("/", "X-Forwarded-Prefix: /v1/lab\r\n")).body;
    EXPECT_NE(odd.find("\"/v1/lab/assets/"), std::string::npos) << "a prefix is no path of the page itself";
    const std::string script = ask(get("/assets/app.js", through)).body;
    EXPECT_NE(script.find("/tools/lab/v1/jobs"), std::string::npos);
    for (const char* evil : {"//evil.example", "/a/../b", "lab", "/a\"b", "/a/", "https://evil.example"})
        EXPECT_TRUE(ask(post("/v1/jobs", scenario, "X-Forwarded-Prefix: " + std::string(evil) + "\r\n"))
                        .has("Location: /v1/jobs/"))
            << evil;
}

TEST_F(Operator, TakesItsBasePathOffThePath) {
    http_options_.base_path = "/lab";
    restart();
    EXPECT_EQ(ask(get("/lab/healthz")).status, 200);
    EXPECT_EQ(ask(get("/healthz")).status, 200) << "a proxy may take it off, and a monitor need not know it";
    EXPECT_EQ(ask(get("/labs/healthz")).status, 404);
    EXPECT_EQ(ask(get("/lab/")).status, 200);
    const RawAnswer bare = ask(get("/lab"));
    EXPECT_EQ(bare.status, 308);
    EXPECT_TRUE(bare.has("Location: /lab/\r\n")) << bare.head;
    EXPECT_TRUE(ask(post("/lab/v1/jobs", scenario)).has("Location: /lab/v1/jobs/"));
}

TEST_F(Operator, ClientsFollowLinksBelowThePathOfTheirServer) {
    http_options_.base_path = "/lab";
    restart();
    Client client(server_->url() + "/lab", "");
    const Reply posted = client.post_json("/v1/jobs", scenario, {});
    EXPECT_EQ(posted.status, 202);
    EXPECT_TRUE(posted.location.starts_with("/lab/v1/jobs/")) << posted.location;
    EXPECT_EQ(client.get(posted.location).status, 200);
    EXPECT_EQ(client.url_of(posted.location), server_->url() + posted.location);
    EXPECT_EQ(client.url_of("/v1/jobs"), server_->url() + "/lab/v1/jobs");
    for (const char* url : {"localhost:8080", "ftp://localhost", "http://localhost/a/../b", "http://localhost/a?b"})
        EXPECT_THROW(Client(url, ""), base::Error) << url;
}

// What the client throws on asking this server.
std::optional<base::Error> fault_of(const std::string& url, const std::string& certificates = "") {
    try {
        Client(url, "", certificates).get("/v1/jobs");
    } catch (const base::Error& error) {
        return error;
    }
    ADD_FAILURE() << "no error: " << url;
    return std::nullopt;
}

// Else submit --wait would try them again for a minute, and then say nothing of the remedy.
TEST_F(Operator, ClientsTellFaultsThatNoOtherTryWouldMend) {
    const std::string plain = server_->url();
    const auto no_tls = fault_of("https" + plain.substr(4));
    ASSERT_TRUE(no_tls);
    EXPECT_EQ(no_tls->code(), base::ErrorCode::usage) << no_tls->what();
    EXPECT_NE(no_tls->message().find("no TLS connection: wrong version number; check the scheme"), std::string::npos)
        << no_tls->message();
    const auto no_certificates = fault_of("https" + plain.substr(4), "/dev/null");
    ASSERT_TRUE(no_certificates);
    EXPECT_EQ(no_certificates->code(), base::ErrorCode::usage) << no_certificates->what();
    EXPECT_NE(no_certificates->message().find("/dev/null has no certificates"), std::string::npos)
        << no_certificates->message();
    const auto no_host = fault_of("http://a..b:1");  // no name service need be asked
    ASSERT_TRUE(no_host);
    EXPECT_EQ(no_host->code(), base::ErrorCode::usage) << no_host->what();
    EXPECT_NE(no_host->message().find("there is no host a..b; check the name"), std::string::npos);
}

// Else submit --wait would not outlive the restart of a server, or of the proxy in front.
TEST(Clients, TakeAConnectionThatIsRefusedOrCutForAServerThatStarts) {
    const int door = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(door, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ::getsockname(door, reinterpret_cast<sockaddr*>(&address), &size);
    const std::string place = "://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    const auto refused = fault_of("http" + place);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->code(), base::ErrorCode::io) << refused->what();
    ::listen(door, 1);
    for (const bool reset : {false, true}) {
        std::thread cutting([&] {
            const int guest = ::accept(door, nullptr, nullptr);
            const linger at_once{reset, 0};
            ::setsockopt(guest, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
            char hello[64];
            EXPECT_GT(::recv(guest, hello, sizeof hello, 0), 0);
            ::close(guest);
        });
        const auto cut = fault_of("https" + place);
        cutting.join();
        ASSERT_TRUE(cut);
        EXPECT_EQ(cut->code(), base::ErrorCode::io) << cut->what();
    }
    ::close(door);
}

TEST(Prefixes, ArePlainPaths) {
    for (const char* good : {"/lab", "/a/b-c_d.e~f", "/..."}) EXPECT_TRUE(is_prefix(good)) << good;
    for (const char* bad : {"", "/", "lab", "/lab/", "//lab", "/a//b", "/a/./b", "/..", "/a b", "/a%2fb", "/a\r\n"})
        EXPECT_FALSE(is_prefix(bad)) << bad;
    EXPECT_FALSE(is_prefix("/" + std::string(200, 'a')));
}

}  // namespace
}  // namespace shadowbench::service

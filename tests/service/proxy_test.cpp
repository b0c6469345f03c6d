// The server behind nginx, with the configuration that service/README.md shows. Skipped where nginx or openssl is
// missing.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "processes.h"
#include "service/http/client.h"
#include "service/program.h"
#include "service/run_cli.h"
#include "service/tiny_scenario.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const nginx = "/usr/sbin/nginx";
const char* const openssl = "/usr/bin/openssl";

sockaddr_in local_address(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

int free_port() {
    sockaddr_in address = local_address(0);
    socklen_t size = sizeof address;
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ::bind(socket, reinterpret_cast<const sockaddr*>(&address), size);
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(socket);
    return ntohs(address.sin_port);
}

bool answers(int port) {
    const sockaddr_in address = local_address(port);
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool done = ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(socket);
    return done;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << "the README no longer has " << from;
    text.replace(at, from.size(), to);
}

class Proxy : public testing::Test {
protected:
    void SetUp() override {
        if (::access(nginx, X_OK) != 0 || ::access(openssl, X_OK) != 0) GTEST_SKIP() << "nginx or openssl is missing";
        write("tiny.json", tiny);
        fs::permissions(write("token", "0123456789abcdef\n"), fs::perms::owner_read | fs::perms::owner_write);
    }
    std::string path(const std::string& name) const { return folder_.path(name); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
        return path(name);
    }
    void make_certificate() const {
        Program request({openssl, "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
                         "-days", "1", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost", "-keyout",
                         path("key.pem"), "-out", path("cert.pem")},
                        path("openssl.log"));
        ASSERT_EQ(request.wait(), 0) << base::read_text(path("openssl.log"));
    }
    // The block of the README, for these ports and files.
    void configure(const std::string& server_port) const {
        const std::string readme = base::read_text(fs::path(SHADOWBENCH_SOURCE_DIR) / "service" / "README.md");
        const std::size_t begin = readme.find("server {\n    listen 443 ssl;");
        ASSERT_NE(begin, std::string::npos);
        std::string block = readme.substr(begin, readme.find("```", begin) - begin);
        replace(block, "listen 443 ssl", "listen 127.0.0.1:" + std::to_string(port_) + " ssl");
        replace(block, "server_name bench.example", "server_name localhost");
        replace(block, "/etc/ssl/certs/bench.example.pem", path("cert.pem"));
        replace(block, "/etc/ssl/private/bench.example.key", path("key.pem"));
        replace(block, "127.0.0.2:8080", "127.0.0.2:" + server_port);
        std::string folders;
        for (const char* name : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"})
            folders += std::string("    ") + name + "_temp_path " + path(name) + ";\n";
        write("nginx.conf", "daemon off;\nerror_log stderr;\npid " + path("nginx.pid") + ";\nevents {}\nhttp {\n" +
                                "    access_log " + path("access.log") + ";\n" + folders + block + "}\n");
    }

    // A proxy that keeps events back would show no progress until the job ends.
    void check_events(Client& client, const std::string& host) const {
        nlohmann::json scenario = nlohmann::json::parse(tiny);
        scenario["timing"] = {{"repetitions", 200}, {"lookups", 1'000'000}};
        const Reply posted = client.post_json("/v1/jobs", scenario.dump(), {{"Idempotency-Key", "one"}});
        ASSERT_EQ(posted.status, 202) << posted.body;
        EXPECT_THAT(posted.location, StartsWith("/lab/v1/jobs/j-"));
        write("request", "GET " + posted.location + "/events HTTP/1.1\r\nHost: " + host +
                             "\r\nAuthorization: Bearer 0123456789abcdef\r\n\r\n");
        Program reader({openssl, "s_client", "-quiet", "-CAfile", path("cert.pem"), "-connect", host}, path("events"),
                       path("request"));
        const auto has = [&](const char* text) {
            return base::read_text(path("events")).find(text) != std::string::npos;
        };
        EXPECT_TRUE(soon([&] { return fs::exists(path("events")) && has("event: progress"); }));
        const std::string state = nlohmann::json::parse(client.get(posted.location).body).at("state");
        EXPECT_THAT(state, ::testing::AnyOf("queued", "running")) << "the event came too late";
        EXPECT_EQ(client.post_json(posted.location + "/cancel", "", {}).status, 202);
        EXPECT_TRUE(soon([&] { return has("\"cancelled\""); }));
    }
    // The page, and its program from the address that it names.
    static void check_page(Client& client) {
        const Reply page = client.get("/");
        EXPECT_EQ(page.status, 200);
        std::smatch named;
        ASSERT_TRUE(std::regex_search(page.body, named, std::regex("src=\"/lab(/assets/[^\"]+[.]js)\"")));
        const Reply asset = client.get(named[1]);
        EXPECT_EQ(asset.status, 200);
        EXPECT_THAT(asset.type, HasSubstr("javascript"));
        EXPECT_GT(asset.body.size(), 10'000u);
    }

    const TemporaryFolder folder_;
    const int port_ = free_port();
};

TEST_F(Proxy, TheConfigurationOfTheReadmeServes) {
    const std::string server_port = std::to_string(free_port());
    ASSERT_NO_FATAL_FAILURE(make_certificate());
    ASSERT_NO_FATAL_FAILURE(configure(server_port));
    Program proxy({nginx, "-p", folder_.path().string(), "-c", path("nginx.conf")}, path("nginx.log"));
    ASSERT_TRUE(soon([&] { return answers(port_); })) << base::read_text(path("nginx.log"));

    const std::string host = "localhost:" + std::to_string(port_), url = "https://" + host + "/lab";
    const std::vector<std::string> words = {"submit", path("tiny.json"), "--server",     url,
                                            "--wait", "--no-pictures",   "--token-file", path("token")};
    const Outcome distrusting = cli(words);
    EXPECT_EQ(distrusting.code, 64) << "nobody vouches for the certificate, and no other try would mend that";
    EXPECT_THAT(distrusting.err, HasSubstr("not trusted: self-signed certificate; give --cacert"));
    std::vector<std::string> trusting = words;
    trusting.insert(trusting.end(), {"--cacert", path("cert.pem")});
    std::vector<std::string> misnamed = trusting;
    misnamed[3] = "https://127.0.0.1:" + std::to_string(port_) + "/lab";
    const Outcome mistaken = cli(misnamed);
    EXPECT_EQ(mistaken.code, 64);
    EXPECT_THAT(mistaken.err, HasSubstr("its certificate is not for 127.0.0.1"));

    Outcome submitted;
    std::thread waiting([&] { submitted = cli(trusting); });
    EXPECT_TRUE(soon([&] { return base::read_text(path("access.log")).find(" 502 ") != std::string::npos; }));
    Program server({SHADOWBENCH_PROGRAM, "serve", "--host", "127.0.0.2", "--port", server_port, "--state",
                    path("state"), "--grace", "0", "--token-file", path("token")},
                   path("server.log"));
    waiting.join();
    EXPECT_EQ(submitted.code, 0) << "it waits for a server that is missing behind its proxy: " << submitted.err
                                 << base::read_text(path("server.log"));
    EXPECT_THAT(submitted.out, HasSubstr("  uncompressed "));
    EXPECT_THAT(submitted.out, HasSubstr("result: " + url + "/v1/jobs/j-"));

    Client client(url, "0123456789abcdef", path("cert.pem"));
    const nlohmann::json jobs = nlohmann::json::parse(client.get("/v1/jobs?text=TIN").body);
    ASSERT_EQ(jobs.at("jobs").size(), 1u);
    const std::string self = jobs["jobs"][0].at("links").at("self");
    EXPECT_THAT(self, StartsWith("/lab/v1/jobs/j-")) << "links have the path of the proxy";
    EXPECT_EQ(client.get(self + "/result").status, 200);
    check_events(client, host);
    check_page(client);
    Client stranger(url, "", path("cert.pem"));
    EXPECT_EQ(stranger.get("/v1/jobs").status, 401);
    // nginx names each request to the server.
    EXPECT_THAT(base::read_text(path("server.log")), ::testing::ContainsRegex("request_id=[0-9a-f]{32}"));
}

}  // namespace
}  // namespace shadowbench::service

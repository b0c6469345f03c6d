// That options of `serve` and limits of its token file reach the server, as a client and its log show.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "processes.h"
#include "service/http/client.h"
#include "service/program.h"
#include "service/tiny_scenario.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char *ann = "0123456789abcdef", *bo = "fedcba9876543210";

class ServeOptions : public testing::Test {
protected:
    void SetUp() override {
        std::ofstream(path("tokens")) << "ann " << ann << " queued=1 running=1\nbo " << bo << "\n";
        fs::permissions(path("tokens"), fs::perms::owner_read | fs::perms::owner_write);
    }
    std::string path(const std::string& name) const { return folder_.path(name); }
    std::string log() const { return base::read_text(path("log")); }
    // The words that start a server. Its log begins anew.
    std::vector<std::string> serve(const std::vector<std::string>& options) const {
        for (const char* name : {"port", "log"}) fs::remove(path(name));
        std::vector<std::string> words{SHADOWBENCH_PROGRAM, "serve",      "--port",       "0",
                                       "--port-file",       path("port"), "--state",      path("state"),
                                       "--grace",           "0",          "--token-file", path("tokens")};
        words.insert(words.end(), options.begin(), options.end());
        return words;
    }
    std::string url() const {
        EXPECT_TRUE(soon([&] { return fs::exists(path("port")); }));
        return "http://127.0.0.1:" + std::to_string(std::stoi(base::read_text(path("port"))));
    }
    // A job that runs until it is cancelled.
    static Reply post(Client& client) {
        json scenario = json::parse(tiny);
        scenario["timing"] = {{"repetitions", 200}, {"lookups", 10'000'000}};
        return client.post_json("/v1/jobs", json{{"scenario", scenario}, {"options", {{"cache", "fresh"}}}}.dump(), {});
    }
    static std::string state_of(Client& client, const std::string& job) {
        return json::parse(client.get(job).body).at("state");
    }
    static json storage_of(Client& client) { return json::parse(client.get("/readyz").body).at("storage"); }

    const TemporaryFolder folder_;
};

TEST_F(ServeOptions, ReachTheServer) {
    std::string first;
    {
        Program server(serve({"--parallel", "2"}), path("log"));
        Client client(url(), ann), other(url(), bo);
        EXPECT_EQ(storage_of(client)["min_free_bytes"], 512 << 20) << "the default of --min-free";
        EXPECT_THAT(log(), HasSubstr(" info server started url="));
        EXPECT_THAT(log(), HasSubstr(" pace="));
        first = post(client).location;
        EXPECT_TRUE(soon([&] { return state_of(client, first) == "running"; }));
        const Reply second = post(client);
        EXPECT_EQ(second.status, 202) << "one may wait";
        const Reply third = post(client);
        EXPECT_EQ(third.status, 429) << third.body;
        const Reply others = post(other);
        EXPECT_EQ(others.status, 202) << "who has no limits";
        EXPECT_TRUE(soon([&] { return state_of(other, others.location) == "running"; }));
        EXPECT_EQ(state_of(client, second.location), "queued") << "one may run, though another could";
        for (const std::string& job : {first, second.location, others.location})
            EXPECT_EQ(client.post_json(job + "/cancel", "", {}).status, 202) << job;
    }
    Program server(serve({"--log-format", "json", "--keep-jobs", "1", "--min-free", "1", "--base-path", "/lab"}),
                   path("log"));
    Client client(url() + "/lab", ann);
    EXPECT_EQ(storage_of(client)["min_free_bytes"], 1 << 20);
    EXPECT_THAT(post(client).location, StartsWith("/lab/v1/jobs/j-"));
    const std::string id = first.substr(first.rfind('/') + 1);
    EXPECT_TRUE(soon([&] { return log().find("\"removed\",\"job\":\"" + id + "\"") != std::string::npos; })) << log();
    std::istringstream lines(log());
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("shadowbench serves ") || lines.eof()) continue;  // its greeting; a line that is not whole
        const json event = json::parse(line, nullptr, false);
        ASSERT_TRUE(event.is_object()) << line;
        if (event.at("message") == "removed") {
            EXPECT_EQ(event.at("reason"), "number");
        }
    }
}

}  // namespace
}  // namespace shadowbench::service

// POST /v1/recommendations.
#include <set>

#include "api/fixture.h"
#include "base/hash_text.h"

namespace shadowbench::service {
namespace {

using nlohmann::json;

constexpr const char* target = "/v1/recommendations";

struct RecommendationsApi : ApiTest {
    static nlohmann::json body(nlohmann::json recommend = {{"error", 0.02}}) {
        return {{"scenario", tiny_scenario()}, {"recommend", std::move(recommend)}};
    }
    std::set<std::string> pointers(const nlohmann::json& body) {
        std::set<std::string> found;
        const nlohmann::json problem = refused(post(target, body.dump()), 422, "");
        for (const nlohmann::json& error : problem["errors"]) found.insert(error["pointer"]);
        return found;
    }
};

TEST_F(RecommendationsApi, QueuesAJobOfItsKind) {
    const ApiResponse response = answer(post(target, body().dump()));
    ASSERT_EQ(response.status, 202) << response.body;
    const nlohmann::json job = json::parse(response.body);
    EXPECT_EQ(*response.header("Location"), "/v1/jobs/" + job["id"].get<std::string>());
    EXPECT_EQ(job["kind"], "recommendation");
    EXPECT_EQ(job["state"], "queued");
    EXPECT_EQ(job["name"], "tiny");
    EXPECT_EQ(job["scenario_hash"], base::hash_text(tiny_scenario().dump()));
    EXPECT_EQ(job["pictures"], false);
    const nlohmann::json asked = {{"error", 0.02},
                                  {"measure", "rms"},
                                  {"cheapest", {"lookup", "bytes", "build"}},
                                  {"at_most", json::object()},
                                  {"budget", 300.0}};
    EXPECT_EQ(job["recommend"], asked) << "with the default values";
    EXPECT_EQ(json::parse(fake::last_request(*jobs_).recommend), asked);
    EXPECT_EQ(json::parse(fake::last_request(*jobs_).scenario), tiny_scenario());
    EXPECT_TRUE(fake::last_request(*jobs_).reuse);

    submit();
    const nlohmann::json list = json(request("GET", "/v1/jobs"), 200)["jobs"];
    EXPECT_EQ(list[0]["kind"], "run");
    EXPECT_TRUE(list[0]["recommend"].is_null());
    EXPECT_EQ(list[1]["kind"], "recommendation");
}

TEST_F(RecommendationsApi, ReadsAllThatCanBeAsked) {
    const nlohmann::json asked = {{"error", 0.5},
                                  {"measure", "p99"},
                                  {"cheapest", {"lookup"}},
                                  {"at_most", {{"bytes", 4194304.0}, {"lookup", 50.0}}},
                                  {"budget", 60.0},
                                  {"light", "sun"},
                                  {"only", {"avsm", "deep"}}};
    nlohmann::json given = asked;
    given["cheapest"] = "lookup";
    given["only"] = {"deep", "avsm", "deep"};
    nlohmann::json whole = body(given);
    whole["options"] = {{"cache", "fresh"}};
    EXPECT_EQ(json(post(target, whole.dump()), 202)["recommend"], asked);
    EXPECT_FALSE(fake::last_request(*jobs_).reuse);
    given["light"] = "0";
    EXPECT_EQ(json(post(target, body(given).dump()), 202)["recommend"]["light"], "0");
}

TEST_F(RecommendationsApi, ReportsAllFaultsAtOnce) {
    nlohmann::json wrong = body({{"error", 2},
                                 {"measure", "mean"},
                                 {"cheapest", {"lookup", "nodes"}},
                                 {"at_most", {{"bytes", 0}, {"nodes", 5}}},
                                 {"budget", "5min"},
                                 {"light", 1},
                                 {"only", {"deep", "shallow", 3}},
                                 {"a/b", 1}});
    wrong["options"] = {{"cache", "old"}, {"pictures", true}};
    wrong["more"] = 1;
    wrong["scenario"]["rays"]["resolution"] = "large";
    EXPECT_EQ(pointers(wrong),
              (std::set<std::string>{"/recommend/error", "/recommend/measure", "/recommend/cheapest/1",
                                     "/recommend/at_most/bytes", "/recommend/at_most/nodes", "/recommend/budget",
                                     "/recommend/light", "/recommend/only/1", "/recommend/only/2", "/recommend/a~1b",
                                     "/options/cache", "/options/pictures", "/more", "/rays/resolution"}));
    EXPECT_EQ(pointers({{"scenario", tiny_scenario()}}), std::set<std::string>{"/recommend/error"});
    EXPECT_EQ(pointers({{"recommend", 3}}), (std::set<std::string>{"/recommend", "/scenario"}));
    EXPECT_EQ(pointers(body({{"error", 0.1}, {"cheapest", json::array()}, {"only", json::array()}})),
              (std::set<std::string>{"/recommend/cheapest", "/recommend/only"}));
    EXPECT_EQ(pointers(json::array()), std::set<std::string>{""});
    refused(post(target, "{"), 400, "body:1:2");
    EXPECT_EQ(jobs_->count(JobState::queued), 0u);
}

// Faults that show only with the scenario.
TEST_F(RecommendationsApi, ChecksTheRequestAgainstTheScenario) {
    EXPECT_EQ(pointers(body({{"error", 0.1}, {"light", "moon"}})), std::set<std::string>{"/recommend/light"});
    nlohmann::json whole = body();
    whole["scenario"]["lights"].push_back({{"type", "directional"}, {"name", "sky"}, {"direction", {0, -1, 0.1}}});
    EXPECT_EQ(pointers(whole), std::set<std::string>{"/recommend/light"}) << "it must choose one";
    whole["recommend"]["light"] = "sky";
    json(post(target, whole.dump()), 202);
    whole["scenario"]["sweeps"] = {{"/rays/samples_per_pixel", {1, 4}}, {"/techniques/0/tolerance", {0.1, 0.2}}};
    json(post(target, whole.dump()), 202);
    whole["scenario"]["sweeps"]["/rays/resolution"] = {8, 16};
    EXPECT_EQ(pointers(whole), std::set<std::string>{"/sweeps"});
    whole = body();
    whole["scenario"]["lights"][0] = {
        {"type", "spot"}, {"name", "sun"}, {"position", {0, 5, 0}}, {"target", {0, 9, 0}}, {"angle", 10}};
    EXPECT_EQ(pointers(whole), std::set<std::string>{"/lights/0"}) << "it sees nothing";
}

TEST_F(RecommendationsApi, CountsItsBudgetAgainstTheLimitOfSeconds) {
    ServiceOptions options = standard_options();
    options.limits.seconds = 100.0;
    start(options);
    const nlohmann::json problem = refused(post(target, body().dump()), 422, "this server allows 100");
    EXPECT_EQ(problem["errors"][0]["pointer"], "/recommend/budget");
    EXPECT_GT(problem["estimate"]["seconds"], 300.0) << "the truth is computed before";
    EXPECT_LT(problem["estimate"]["seconds"], 301.0);
    json(post(target, body({{"error", 0.02}, {"budget", 90}}).dump()), 202);
    options.limits.resolution = 7;
    start(options);
    EXPECT_EQ(pointers(body()), (std::set<std::string>{"/rays/resolution", "/recommend/budget"}));
}

TEST_F(RecommendationsApi, HonoursAnIdempotencyKey) {
    const std::vector<Field> key = {{"idempotency-key", "once"}};
    const nlohmann::json first = json(post(target, body().dump(), key), 202);
    EXPECT_EQ(json(post(target, body().dump(), key), 202)["id"], first["id"]);
    EXPECT_EQ(json(post(target, body({{"error", 0.02}, {"budget", 300}}).dump(), key), 202)["id"], first["id"])
        << "it asks the same";
    refused(post(target, body({{"error", 0.03}}).dump(), key), 409, "Idempotency-Key");
    refused(post("/v1/jobs", tiny_scenario().dump(), key), 409, "Idempotency-Key");
}

TEST_F(RecommendationsApi, SaysWhetherTheErrorIsReached) {
    const std::string id = json(post(target, body().dump()), 202)["id"];
    EXPECT_TRUE(json(request("GET", "/v1/jobs/" + id), 200)["reached"].is_null());
    fake::succeed(*jobs_, id, {{"table.txt", "tiny, light sun\n"}});
    const nlohmann::json job = json(request("GET", "/v1/jobs/" + id), 200);
    EXPECT_EQ(job["reached"], true);
    EXPECT_TRUE(job["promises_kept"].is_null());
    EXPECT_EQ(job["artifacts"], json::array({"table.txt"}));
    EXPECT_EQ(body_of(answer(request("GET", "/v1/jobs/" + id + "/artifacts/table.txt"))), "tiny, light sun\n");
    const std::string ran = submit();
    fake::succeed(*jobs_, ran, {});
    EXPECT_TRUE(json(request("GET", "/v1/jobs/" + ran), 200)["reached"].is_null());
}

}  // namespace
}  // namespace shadowbench::service

#include <fstream>
#include <set>

#include "api/fixture.h"
#include "base/hash_text.h"
#include "document/document.h"

namespace shadowbench::service {
namespace {

using nlohmann::json;

struct JobsApi : ApiTest {};

TEST_F(JobsApi, TakesAScenarioAndTellsWhereItsJobIs) {
    const ApiResponse response = answer(post("/v1/jobs", tiny_scenario().dump()));
    EXPECT_EQ(response.status, 202);
    const nlohmann::json job = json::parse(response.body);
    EXPECT_EQ(*response.header("Location"), "/v1/jobs/" + job["id"].get<std::string>());
    EXPECT_EQ(job["state"], "queued");
    EXPECT_EQ(job["name"], "tiny");
    EXPECT_EQ(job["seed"], 5);
    EXPECT_EQ(job["scenario_hash"], base::hash_text(tiny_scenario().dump()));
    EXPECT_EQ(job["position"], 0);
    EXPECT_TRUE(job["progress"].is_null());
    const JobRequest request = fake::last_request(*jobs_);
    EXPECT_EQ(json::parse(request.scenario), tiny_scenario());
    EXPECT_TRUE(request.reuse);
    EXPECT_TRUE(request.pictures);
}

TEST_F(JobsApi, TakesAScenarioWithOptions) {
    const nlohmann::json body = {{"scenario", tiny_scenario()}, {"options", {{"cache", "fresh"}, {"pictures", false}}}};
    json(post("/v1/jobs", body.dump()), 202);
    EXPECT_FALSE(fake::last_request(*jobs_).reuse);
    EXPECT_FALSE(fake::last_request(*jobs_).pictures);
    EXPECT_EQ(json::parse(fake::last_request(*jobs_).scenario), tiny_scenario());
    for (const nlohmann::json& wrong : {nlohmann::json{{"cache", "old"}}, nlohmann::json{{"pictures", 1}},
                                        nlohmann::json{{"colour", true}}, nlohmann::json(3)}) {
        const nlohmann::json body_with_options = {{"scenario", tiny_scenario()}, {"options", wrong}};
        const nlohmann::json problem = refused(post("/v1/jobs", body_with_options.dump()), 422, "");
        EXPECT_TRUE(problem["errors"][0]["pointer"].get<std::string>().starts_with("/options"));
    }
    refused(post("/v1/jobs", R"({"scenario": {}, "more": 1})"), 422, "options");
}

// RFC 6901, section 3: "~" is written as "~0" and "/" as "~1", wherever the key stands.
TEST_F(JobsApi, EscapesTheKeysInItsPointers) {
    const auto pointer_of = [&](const char* target, const std::string& body) {
        return refused(post(target, body), 422, "")["errors"][0]["pointer"].get<std::string>();
    };
    const std::string tiny = tiny_scenario().dump();
    for (const char* target : {"/v1/jobs", "/v1/validate"}) {
        EXPECT_EQ(pointer_of(target, R"({"scenario":{},"a/b":1})"), "/a~1b");
        EXPECT_EQ(pointer_of(target, R"({"scenario":)" + tiny + R"(,"options":{"m~n":1}})"), "/options/m~0n");
        nlohmann::json scenario = tiny_scenario();
        scenario["rays"]["a/b"] = 1;
        EXPECT_EQ(pointer_of(target, scenario.dump()), "/rays/a~1b");
        scenario = tiny_scenario();
        scenario["techniques"][0]["a/b~c"] = 1;
        EXPECT_EQ(pointer_of(target, scenario.dump()), "/techniques/0/a~1b~0c");
        scenario["techniques"][0] = {{"type", "*"}, {"a/b", 1}};
        EXPECT_EQ(pointer_of(target, scenario.dump()), "/techniques/0/a~1b");
        scenario = tiny_scenario();
        scenario["sweeps"] = {{"/lights/7/name", {1, 2}}};
        EXPECT_EQ(pointer_of(target, scenario.dump()), "/sweeps/~1lights~17~1name");
    }
    EXPECT_EQ(pointer_of("/v1/compare", R"({"baseline":{},"current":{},"a/b":1})"), "/a~1b");
}

TEST_F(JobsApi, PointsAtWhatIsWrongInAScenario) {
    nlohmann::json scenario = tiny_scenario();
    scenario["rays"]["resolution"] = "large";
    EXPECT_EQ(refused(post("/v1/jobs", scenario.dump()), 422, "")["errors"][0]["pointer"], "/rays/resolution");
    scenario = tiny_scenario();
    scenario["techniques"][1]["tolerance"] = 0.1;
    EXPECT_EQ(refused(post("/v1/jobs", scenario.dump()), 422, "")["errors"][0]["pointer"], "/techniques/1/tolerance");
    EXPECT_EQ(refused(post("/v1/jobs", "[]"), 422, "")["errors"][0]["pointer"], "");
    EXPECT_EQ(refused(post("/v1/jobs", "{}"), 422, "")["errors"].size(), 3u) << "each key that is missing";
    const nlohmann::json wrapped = {{"scenario", scenario}};
    EXPECT_EQ(refused(post("/v1/jobs", wrapped.dump()), 422, "")["errors"][0]["pointer"], "/techniques/1/tolerance");
    EXPECT_EQ(jobs_->count(JobState::queued), 0u);
}

TEST_F(JobsApi, ReportsAllFaultsAtOnce) {
    nlohmann::json scenario = tiny_scenario();
    scenario["rays"]["resolution"] = "large";
    scenario["lights"][0]["color"] = 1;
    scenario["scene"]["objects"][0]["radius"] = -1;
    scenario["techniques"][0]["tolerance"] = 2;
    for (const char* place : {"/v1/jobs", "/v1/validate"}) {
        const nlohmann::json problem = refused(post(place, scenario.dump()), 422, "the first of 4 faults");
        std::set<std::string> pointers;
        for (const nlohmann::json& error : problem["errors"]) pointers.insert(error["pointer"]);
        EXPECT_EQ(pointers, (std::set<std::string>{"/rays/resolution", "/lights/0/color", "/scene/objects/0/radius",
                                                   "/techniques/0/tolerance"}));
    }
    for (int i = 0; i < 100; ++i) scenario["lights"].push_back(i);
    EXPECT_EQ(refused(post("/v1/validate", scenario.dump()), 422, "")["errors"].size(), 32u);
}

TEST_F(JobsApi, RefusesBodiesThatAreNotJson) {
    refused(post("/v1/jobs", "{"), 400, "body:1:2");
    refused(post("/v1/jobs", R"({"a": 1, "a": 2})"), 400, "twice");
    refused(post("/v1/jobs", std::string(1000, '[')), 400, "nested");
    refused(post("/v1/jobs", "\"\xff\""), 400, "body");
}

TEST_F(JobsApi, ReadsOnlyFilesOfTheDataFolders) {
    std::ofstream(folder_ / "secret.obj") << "v 0 0 0\n";
    std::filesystem::create_symlink(folder_ / "secret.obj", folder_ / "data/link.obj");
    nlohmann::json scenario = tiny_scenario();
    for (const std::string& name :
         {(folder_ / "secret.obj").string(), std::string("../secret.obj"), std::string("link.obj"),
          std::string("x/../../secret.obj"), std::string("missing.obj"), std::string("/etc/passwd")}) {
        scenario["scene"]["objects"] = json::array({{{"type", "mesh"}, {"file", name}}});
        const nlohmann::json problem = refused(post("/v1/jobs", scenario.dump()), 422, "");
        EXPECT_EQ(problem["errors"][0]["pointer"], "/scene/objects/0/file") << name;
        if (name[0] != '/') {
            EXPECT_EQ(problem.dump().find(folder_.string()), std::string::npos) << problem;
        }
    }
}

TEST_F(JobsApi, HidesTheFoldersOfBrokenFiles) {
    std::ofstream(folder_ / "data/broken.ply") << "ply\nformat ascii 1.0\nelement vertex 3\n";
    nlohmann::json scenario = tiny_scenario();
    scenario["scene"]["objects"] = json::array({{{"type", "mesh"}, {"file", "broken.ply"}}});
    const nlohmann::json problem = refused(post("/v1/jobs", scenario.dump()), 422, "broken.ply");
    EXPECT_EQ(problem["errors"][0]["pointer"], "/scene/objects/0/file");
    EXPECT_EQ(problem.dump().find(folder_.string()), std::string::npos) << problem;
}

// By the rule of hidden_folders.h, however the folder is given to the server.
TEST_F(JobsApi, HidesADataFolderBehindALink) {
    std::ofstream(folder_ / "data/broken.ply") << "ply\nformat ascii 1.0\nelement vertex 3\n";
    std::filesystem::create_directory_symlink("data", folder_ / "link");
    nlohmann::json scenario = tiny_scenario();
    scenario["scene"]["objects"] = json::array({{{"type", "mesh"}, {"file", "broken.ply"}}});
    for (const std::filesystem::path& data : {folder_ / "link", folder_ / "data/../link", folder_ / "data/"}) {
        ServiceOptions options = standard_options();
        options.data = {data};
        start(options);
        const std::string problem = refused(post("/v1/validate", scenario.dump()), 422, "broken.ply").dump();
        EXPECT_EQ(problem.find(folder_.filename().string()), std::string::npos) << problem;
    }
}

TEST_F(JobsApi, RefusesWhatCostsTooMuchAndGivesTheEstimate) {
    ServiceOptions options = standard_options();
    options.limits.resolution = 7;
    start(options);
    nlohmann::json problem = refused(post("/v1/jobs", tiny_scenario().dump()), 422, "8 pixels a side");
    EXPECT_EQ(problem["errors"][0]["pointer"], "/rays/resolution");
    EXPECT_EQ(problem["estimate"]["resolution"], 8);
    options = standard_options();
    options.limits.samples_per_pixel = 15;
    start(options);
    refused(post("/v1/jobs", tiny_scenario().dump()), 422, "16 rays a pixel");
    options = standard_options();
    options.limits.bytes = 1000;
    start(options);
    problem = refused(post("/v1/jobs", tiny_scenario().dump()), 422, "memory");
    EXPECT_GT(problem["estimate"]["bytes"], 1000);
    options = standard_options();
    options.limits.seconds = 1e-9;
    start(options);
    problem = refused(post("/v1/validate", tiny_scenario().dump()), 422, "run for about");
    EXPECT_GT(problem["estimate"]["seconds"], 1e-9);
    EXPECT_EQ(jobs_->count(JobState::queued), 0u);
}

// Else each new helper would measure the machine again, and the same scenario would be refused now and taken then.
TEST_F(JobsApi, EveryHelperEstimatesWithThePaceOfTheServer) {
    nlohmann::json scenario = tiny_scenario();
    scenario["receivers"] = {
        {"type", "camera"}, {"position", {0, 0, 9}}, {"target", {0, 0, 0}}, {"resolution", {64, 64}}};
    const auto estimate_at = [&](double pace) {
        ServiceOptions options = standard_options();
        options.pace = pace;
        start(options);
        return json(post("/v1/validate", scenario.dump()), 200)["estimate"];
    };
    const nlohmann::json one = estimate_at(1.25), two = estimate_at(2.5);
    EXPECT_EQ(two["picture_seconds"], 2.0 * one["picture_seconds"].get<double>());
    EXPECT_NE(answer(request("GET", "/metrics")).body.find("shadowbench_pace 2.5\n"), std::string::npos);
    EXPECT_EQ(estimate_at(1.25), one) << "by another helper";
}

// Else a job whose pictures take hours would be accepted, since its map is small.
TEST_F(JobsApi, CountsPicturesAgainstTheLimitOfSeconds) {
    nlohmann::json scenario = tiny_scenario();
    scenario["receivers"] = {
        {"type", "camera"}, {"position", {0, 0, 9}}, {"target", {0, 0, 0}}, {"resolution", {2048, 2048}}};
    const nlohmann::json estimate = json(post("/v1/validate", scenario.dump()), 200)["estimate"];
    const double run = estimate["seconds"], pictures = estimate["picture_seconds"];
    EXPECT_GT(pictures, run);
    ServiceOptions options = standard_options();
    options.limits.seconds = run + 0.3 * pictures;
    start(options);
    refused(post("/v1/jobs", scenario.dump()), 422, "of it for pictures");
    json(post("/v1/jobs", nlohmann::json{{"scenario", scenario}, {"options", {{"pictures", false}}}}.dump()), 202);
}

TEST_F(JobsApi, HonoursAnIdempotencyKey) {
    const std::vector<Field> key = {{"idempotency-key", "once"}};
    const nlohmann::json first = json(post("/v1/jobs", tiny_scenario().dump(), key), 202);
    EXPECT_EQ(json(post("/v1/jobs", tiny_scenario().dump(), key), 202)["id"], first["id"]);
    nlohmann::json other = tiny_scenario();
    other["rays"]["seed"] = 6;
    refused(post("/v1/jobs", other.dump(), key), 409, "Idempotency-Key");
    refused(post("/v1/jobs", other.dump(), {{"idempotency-key", std::string(256, 'x')}}), 400, "255");
    refused(post("/v1/jobs", other.dump(), {{"idempotency-key", ""}}), 400, "255");
    EXPECT_EQ(jobs_->count(JobState::queued), 1u);
}

TEST_F(JobsApi, SaysWhenTheQueueIsFull) {
    JobLimits limits;
    limits.queue = 1;
    start(standard_options(), limits);
    submit();
    const ApiResponse response = answer(post("/v1/jobs", tiny_scenario().dump()));
    EXPECT_EQ(response.status, 429);
    EXPECT_TRUE(response.header("Retry-After"));
}

TEST_F(JobsApi, TakesNothingWhileItStops) {
    jobs_->stop();
    const ApiResponse response = answer(post("/v1/jobs", tiny_scenario().dump()));
    EXPECT_EQ(response.status, 503);
    EXPECT_TRUE(response.header("Retry-After"));
    EXPECT_EQ(answer(request("GET", "/readyz")).status, 503);
    EXPECT_EQ(answer(request("GET", "/healthz")).status, 200);
}

TEST_F(JobsApi, IsNotReadyWhileItsStorageFails) {
    EXPECT_NE(answer(request("GET", "/metrics")).body.find("shadowbench_storage_failing 0"), std::string::npos);
    fake::fail_storage(*jobs_, true);
    const ApiResponse response = answer(request("GET", "/readyz"));
    EXPECT_EQ(response.status, 503);
    EXPECT_NE(response.body.find("storage"), std::string::npos) << response.body;
    EXPECT_TRUE(response.header("Retry-After"));
    EXPECT_EQ(answer(request("GET", "/healthz")).status, 200);
    EXPECT_NE(answer(request("GET", "/metrics")).body.find("shadowbench_storage_failing 1"), std::string::npos);
    fake::fail_storage(*jobs_, false);
    EXPECT_EQ(answer(request("GET", "/readyz")).status, 200);
}

TEST_F(JobsApi, RetriesWhatFailedOrWasCancelled) {
    JobLimits limits;
    limits.queue = 1;
    start(standard_options(), limits);
    const std::string id = submit(), retry = "/v1/jobs/" + id + "/retry";
    refused(post("/v1/jobs/j-9/retry", ""), 404, "no such job");
    refused(post(retry, ""), 409, "failed or was cancelled");
    fake::update(*jobs_, id, [](JobInfo& job) {
        job.state = JobState::failed;
        job.attempts = 3;
        job.fault = JobFault{70, "", "a fault"};
    });
    const std::string other = submit();
    EXPECT_TRUE(answer(post(retry, "")).header("Retry-After"));
    refused(post(retry, ""), 429, "queue");
    fake::run(*jobs_, other);
    const nlohmann::json job = json(post(retry, ""), 202);
    EXPECT_EQ(job["id"], id);
    EXPECT_EQ(job["state"], "queued");
    EXPECT_EQ(job["attempts"], 0);
    EXPECT_TRUE(job["error"].is_null());
    EXPECT_EQ(answer(request("GET", retry)).status, 405);
    EXPECT_EQ(answer(post(retry, "{}")).status, 400) << "it takes no body";
    jobs_->stop();
    refused(post(retry, ""), 503, "stopping");
}

TEST_F(JobsApi, SaysWhatIsWrongWithItsDisk) {
    fake::set_storage(*jobs_, {false, false, std::uint64_t{100} << 20, std::uint64_t{512} << 20});
    const nlohmann::json low = refused(request("GET", "/readyz"), 503, "100 MiB free and needs 512");
    EXPECT_NE(low["detail"].get<std::string>().find("jobs wait"), std::string::npos);
    EXPECT_EQ(low["storage"], (nlohmann::json{{"free_bytes", 100 << 20}, {"min_free_bytes", 512 << 20}}));
    const std::string metrics = answer(request("GET", "/metrics")).body;
    EXPECT_NE(metrics.find("shadowbench_storage_free_bytes 104857600\n"), std::string::npos) << metrics;
    EXPECT_NE(metrics.find("shadowbench_storage_min_free_bytes 536870912\n"), std::string::npos) << metrics;
    EXPECT_NE(metrics.find("shadowbench_storage_failing 1\n"), std::string::npos) << "as /readyz says";
    EXPECT_EQ(answer(request("GET", "/v1/jobs")).status, 200);
    fake::set_storage(*jobs_, {false, false, std::uint64_t{512} << 20, std::uint64_t{512} << 20});
    EXPECT_EQ(json(request("GET", "/readyz"), 200)["storage"]["free_bytes"], 512 << 20) << "also while it is ready";
    EXPECT_NE(answer(request("GET", "/metrics")).body.find("shadowbench_storage_failing 0\n"), std::string::npos);
    fake::set_storage(*jobs_, {false, true, std::nullopt, std::uint64_t{512} << 20});
    const nlohmann::json gone = refused(request("GET", "/readyz"), 503, "removed");
    EXPECT_EQ(gone.dump().find(folder_.string()), std::string::npos);
    EXPECT_TRUE(gone["storage"]["free_bytes"].is_null());
    EXPECT_NE(answer(request("GET", "/metrics")).body.find("shadowbench_storage_failing 1\n"), std::string::npos);
}

TEST_F(JobsApi, ExaminesTheSameScenarioOnce) {
    for (int i = 0; i < 5; ++i) submit();
    EXPECT_EQ(helpers_, 1);
}

TEST_F(JobsApi, ListsJobsByPagesAndStates) {
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i) ids.push_back(submit());
    fake::run(*jobs_, ids[0]);
    nlohmann::json page = json(request("GET", "/v1/jobs?limit=2"), 200);
    ASSERT_EQ(page["jobs"].size(), 2u);
    EXPECT_EQ(page["jobs"][0]["id"], ids[4]) << "newest first";
    page = json(request("GET", "/v1/jobs?limit=2&cursor=" + page["next"].get<std::string>()), 200);
    EXPECT_EQ(page["jobs"][0]["id"], ids[2]);
    page = json(request("GET", "/v1/jobs?limit=2&cursor=" + page["next"].get<std::string>()), 200);
    EXPECT_EQ(page["jobs"].size(), 1u);
    EXPECT_TRUE(page["next"].is_null());
    EXPECT_EQ(json(request("GET", "/v1/jobs?state=running"), 200)["jobs"].size(), 1u);
    EXPECT_EQ(json(request("GET", "/v1/jobs?state=failed"), 200)["jobs"].size(), 0u);
    refused(request("GET", "/v1/jobs?state=lost"), 400, "state");
    for (const char* limit : {"0", "201", "-1", "two", "1x", ""})
        refused(request("GET", std::string("/v1/jobs?limit=") + limit), 400, "limit");
    refused(request("GET", "/v1/jobs?cursor=nowhere"), 400, "cursor");
}

TEST_F(JobsApi, ShowsAJobInEveryState) {
    const std::string id = submit();
    const ApiRequest get = request("GET", "/v1/jobs/" + id);
    EXPECT_EQ(json(get, 200)["state"], "queued");
    fake::run(*jobs_, id);
    fake::progress(*jobs_, id, {"build", "1/2 sun", 3, 16, 0.42});
    nlohmann::json job = json(get, 200);
    EXPECT_EQ(job["state"], "running");
    EXPECT_EQ(
        job["progress"],
        (nlohmann::json{{"stage", "build"}, {"place", "1/2 sun"}, {"done", 3}, {"total", 16}, {"fraction", 0.42}}));
    fake::succeed(*jobs_, id, {{"result.json", "{}"}, {"images/a.png", "x"}});
    job = json(get, 200);
    EXPECT_EQ(job["state"], "succeeded");
    EXPECT_EQ(job["promises_kept"], true);
    EXPECT_EQ(job["artifacts"], (nlohmann::json{"images/a.png", "result.json"}));
    EXPECT_EQ(job["links"]["result"], "/v1/jobs/" + id + "/result");
    fake::update(*jobs_, id, [](JobInfo& info) {
        info.state = JobState::failed;
        info.fault = JobFault{65, "/lights/0", "no"};
    });
    EXPECT_EQ(json(get, 200)["error"], (nlohmann::json{{"code", 65}, {"where", "/lights/0"}, {"message", "no"}}));
    refused(request("GET", "/v1/jobs/j-0000000000000099"), 404, "no such job");
}

TEST_F(JobsApi, CancelsAndRemoves) {
    const std::string id = submit();
    fake::run(*jobs_, id);
    refused(request("DELETE", "/v1/jobs/" + id), 409, "running");
    EXPECT_EQ(json(post("/v1/jobs/" + id + "/cancel", ""), 202)["state"], "cancelled");
    refused(post("/v1/jobs/" + id + "/cancel", ""), 409, "ended");
    EXPECT_EQ(answer(request("DELETE", "/v1/jobs/" + id)).status, 204);
    refused(request("DELETE", "/v1/jobs/" + id), 404, "no such job");
    refused(post("/v1/jobs/" + id + "/cancel", ""), 404, "no such job");
}

TEST_F(JobsApi, ValidatesWithoutQueueing) {
    nlohmann::json facts = json(post("/v1/validate", tiny_scenario().dump()), 200);
    EXPECT_EQ(facts["valid"], true);
    EXPECT_EQ(facts["name"], "tiny");
    EXPECT_EQ(facts["techniques"], 2);
    EXPECT_EQ(facts["notes"].size(), 0u);
    EXPECT_EQ(jobs_->count(JobState::queued), 0u);
    nlohmann::json scenario = tiny_scenario();
    scenario["lights"][0] = {
        {"type", "spot"}, {"name", "away"}, {"position", {0, 5, 0}}, {"target", {0, 9, 0}}, {"angle", 20}};
    facts = json(post("/v1/validate", scenario.dump()), 200);
    ASSERT_EQ(facts["notes"].size(), 1u) << facts;
    EXPECT_NE(facts["notes"][0].get<std::string>().find("away"), std::string::npos);
    refused(post("/v1/validate", "{}"), 422, "");
}

TEST_F(JobsApi, TakeLabelsAndAPriorityAndGiveThemBack) {
    const auto with = [](const nlohmann::json& options) {
        return post("/v1/jobs", nlohmann::json{{"scenario", tiny_scenario()}, {"options", options}}.dump());
    };
    ApiRequest request_of_ann = with({{"labels", {"night", "b"}}, {"priority", -3}});
    request_of_ann.client = "ann";
    const nlohmann::json job = json(request_of_ann, 202);
    EXPECT_EQ(job["labels"], (nlohmann::json{"night", "b"}));
    EXPECT_EQ(job["priority"], -3);
    EXPECT_EQ(job["owner"], "ann");
    EXPECT_EQ(job["pinned"], false);
    submit();
    for (const char* query : {"label=night", "owner=ann", "label=b&owner=ann&text=tiny"})
        EXPECT_EQ(json(request("GET", std::string("/v1/jobs?") + query), 200)["jobs"].size(), 1u) << query;
    EXPECT_EQ(json(request("GET", "/v1/jobs?text=none"), 200)["jobs"].size(), 0u);
    for (const nlohmann::json& labels :
         {nlohmann::json("a"), nlohmann::json{1}, nlohmann::json{""}, nlohmann::json{"a\nb"},
          nlohmann::json{std::string(65, 'x')}, nlohmann::json(std::vector<std::string>(17, "a"))})
        EXPECT_EQ(refused(with({{"labels", labels}}), 422, "texts")["errors"][0]["pointer"], "/options/labels");
    for (const nlohmann::json& priority :
         {nlohmann::json(101), nlohmann::json(UINT64_MAX), nlohmann::json(1.5), nlohmann::json("1")})
        EXPECT_EQ(refused(with({{"priority", priority}}), 422, "whole number")["errors"][0]["pointer"],
                  "/options/priority");
}

TEST_F(JobsApi, ArePinnedAndLetGo) {
    const std::string path = "/v1/jobs/" + submit();
    EXPECT_EQ(json(request("POST", path + "/pin"), 200)["pinned"], true);
    EXPECT_EQ(json(request("GET", path), 200)["pinned"], true);
    EXPECT_EQ(json(request("POST", path + "/unpin"), 200)["pinned"], false);
    EXPECT_EQ(answer(request("POST", "/v1/jobs/none/pin")).status, 404);
}

TEST_F(JobsApi, OfATokenAtItsLimitsAreRefusedUntilLater) {
    JobLimits limits;
    limits.owners["ann"].queued = 0;
    limits.owners["bo"].bytes = 0;
    start(standard_options(), limits);
    for (const char* owner : {"ann", "bo"}) {
        ApiRequest mine = post("/v1/jobs", tiny_scenario().dump());
        mine.client = owner;
        const ApiResponse refusal = answer(mine);
        EXPECT_EQ(refusal.status, 429) << owner;
        EXPECT_TRUE(refusal.header("Retry-After"));
    }
    submit();
}

}  // namespace
}  // namespace shadowbench::service

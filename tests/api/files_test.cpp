#include <filesystem>
#include <fstream>

#include "api/fixture.h"
#include "service/api/accept.h"

namespace shadowbench::service {
namespace {

struct FilesApi : ApiTest {
    FilesApi() {
        id = submit();
        fake::succeed(*jobs_, id,
                      {{"result.json", R"({"schema_version": 1, "name": "<tiny>", "scenario": {}, "variants": []})"},
                       {"result.csv", "a,b\n1,2\n"},
                       {"images/reference.png", "0123456789"},
                       {"images/empty.exr", ""}});
    }
    std::string at(const std::string& rest) const { return "/v1/jobs/" + id + rest; }
    ApiResponse get(const std::string& rest, std::vector<Field> headers = {}) {
        return answer(request("GET", at(rest), std::move(headers)));
    }
    std::string id;
};

TEST_F(FilesApi, GivesResultsAndArtifacts) {
    ApiResponse response = get("/result");
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.type, "application/json");
    EXPECT_NE(body_of(response).find("<tiny>"), std::string::npos);
    response = get("/result.csv");
    EXPECT_EQ(response.type, "text/csv; charset=utf-8");
    response = get("/artifacts/images/reference.png");
    EXPECT_EQ(response.type, "image/png");
    EXPECT_EQ(body_of(response), "0123456789");
    EXPECT_EQ(body_of(get("/artifacts/images/empty.exr")), "");
    EXPECT_EQ(get("/artifacts/images/none.png").status, 404);
    EXPECT_EQ(get("/artifacts/images").status, 404) << "a folder";
    EXPECT_EQ(nlohmann::json::parse(body_of(get("/scenario"))), tiny_scenario());
}

TEST_F(FilesApi, SaysWhyThereIsNoResultYet) {
    const std::string other = submit();
    refused(request("GET", "/v1/jobs/" + other + "/result"), 409, "queued");
    refused(request("GET", "/v1/jobs/" + other + "/report"), 409, "queued");
    refused(request("GET", "/v1/jobs/j-9/result"), 404, "no such job");
    refused(request("GET", "/v1/jobs/j-9/artifacts/result.json"), 404, "no such job");
}

TEST_F(FilesApi, HaveAStrongETag) {
    const ApiResponse first = get("/artifacts/images/reference.png");
    ASSERT_TRUE(first.header("ETag"));
    const std::string etag = *first.header("ETag");
    EXPECT_TRUE(etag.starts_with('"') && etag.ends_with('"')) << etag;
    for (const std::string& known : {etag, "\"other\", " + etag, "W/" + etag, std::string("*")}) {
        const ApiResponse again = get("/artifacts/images/reference.png", {{"if-none-match", known}});
        EXPECT_EQ(again.status, 304) << known;
        EXPECT_EQ(*again.header("ETag"), etag);
        EXPECT_FALSE(again.file);
    }
    EXPECT_EQ(get("/artifacts/images/reference.png", {{"if-none-match", "\"other\""}}).status, 200);
    EXPECT_NE(*get("/result").header("ETag"), etag);
}

TEST_F(FilesApi, GiveOneRange) {
    const auto part = [&](const std::string& range, const std::string& bytes, const std::string& place) {
        const ApiResponse response = get("/artifacts/images/reference.png", {{"range", range}});
        EXPECT_EQ(response.status, 206) << range;
        EXPECT_EQ(body_of(response), bytes) << range;
        EXPECT_EQ(*response.header("Content-Range"), place) << range;
    };
    part("bytes=0-3", "0123", "bytes 0-3/10");
    part("bytes=8-", "89", "bytes 8-9/10");
    part("bytes=8-99", "89", "bytes 8-9/10");
    part("bytes=-3", "789", "bytes 7-9/10");
    part("bytes=-99", "0123456789", "bytes 0-9/10");
    part("bytes=8-99999999999999999999999", "89", "bytes 8-9/10");
    part("bytes=-99999999999999999999999", "0123456789", "bytes 0-9/10");
    for (const char* range : {"bytes=10-", "bytes=5-4", "bytes=-0", "bytes=a-b", "bytes=", "bytes=-", "bytes=1-2x",
                              "bytes=99999999999999999999-", "bytes=99999999999999999999-99999999999999999999"}) {
        const ApiResponse response = get("/artifacts/images/reference.png", {{"range", range}});
        EXPECT_EQ(response.status, 416) << range;
        EXPECT_EQ(*response.header("Content-Range"), "bytes */10") << range;
    }
    // Several ranges and other units are ignored. HEAD has no ranges.
    for (const char* range : {"bytes=0-1,3-4", "bytes=0-1, 0-1, 0-1", "bytes=20-,0-1", "lines=1-2", "bytes2=1-2"}) {
        const ApiResponse whole = get("/artifacts/images/reference.png", {{"range", range}});
        EXPECT_EQ(whole.status, 200) << range;
        EXPECT_EQ(body_of(whole), "0123456789") << range;
    }
    const ApiResponse head = answer(request("HEAD", at("/artifacts/images/reference.png"), {{"range", "bytes=0-1"}}));
    EXPECT_EQ(head.status, 200);
    EXPECT_FALSE(head.header("Content-Range"));
    EXPECT_EQ(get("/artifacts/images/empty.exr", {{"range", "bytes=0-"}}).status, 416);
    const std::string etag = *get("/artifacts/images/reference.png").header("ETag");
    EXPECT_EQ(get("/artifacts/images/reference.png", {{"range", "bytes=0-1"}, {"if-range", etag}}).status, 206);
    EXPECT_EQ(get("/artifacts/images/reference.png", {{"range", "bytes=0-1"}, {"if-range", "\"old\""}}).status, 200);
}

TEST_F(FilesApi, DoNotFollowLinks) {
    std::ofstream(folder_ / "secret.txt") << "secret";
    const auto folder = fake::folder(*jobs_, id);
    std::filesystem::create_symlink(folder_ / "secret.txt", folder / "images/link.png");
    std::filesystem::create_symlink(folder / "result.json", folder / "images/inner.png");
    std::filesystem::create_directory_symlink(folder_, folder / "images/up");
    EXPECT_EQ(get("/artifacts/images/link.png").status, 404);
    EXPECT_EQ(get("/artifacts/images/inner.png").status, 404) << "even to its own files";
    EXPECT_EQ(get("/artifacts/images/up/secret.txt").status, 404);
}

// The front refuses such paths; the API has to stand without it.
TEST_F(FilesApi, DoNotLeadOutOfTheirFolder) {
    std::ofstream(folder_ / "secret.txt") << "secret";
    for (const std::vector<std::string>& way :
         std::vector<std::vector<std::string>>{{"..", "..", "secret.txt"},
                                               {"images", "..", "..", "..", "secret.txt"},
                                               {"", (folder_ / "secret.txt").string()},
                                               {(folder_ / "secret.txt").string()},
                                               {"../../secret.txt"}}) {
        ApiRequest get = request("GET", at("/artifacts"));
        get.path.insert(get.path.end(), way.begin(), way.end());
        EXPECT_EQ(answer(get).status, 404) << way[0];
    }
}

TEST_F(FilesApi, ReportsAreDocumentsWithoutRightsHere) {
    const ApiResponse response = get("/report");
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.type, "text/html; charset=utf-8");
    EXPECT_EQ(response.body.find("<tiny>"), std::string::npos) << "escaped";
    const std::string policy = *response.header("Content-Security-Policy");
    EXPECT_TRUE(policy.starts_with("sandbox allow-scripts;")) << policy;
    EXPECT_EQ(policy.find("allow-same-origin"), std::string::npos);
}

TEST_F(FilesApi, ReportsOfBrokenPicturesDoNotSayWhereTheyLie) {
    const std::filesystem::path images = jobs_->artifact(id, "result.json")->parent_path() / "images";
    std::filesystem::create_directories(images);
    std::ofstream(images / "images.json") << "{";
    const nlohmann::json problem = refused(request("GET", at("/report")), 500, "pictures");
    EXPECT_EQ(problem.dump().find(folder_.string()), std::string::npos) << problem;
}

TEST_F(FilesApi, ComparesOnlyWhatIsThere) {
    const std::string result = body_of(get("/result"));
    refused(post("/v1/compare", "{}"), 422, "job");
    EXPECT_EQ(refused(post("/v1/compare", R"({"base": {}})"), 422, "Unknown key \"base\"")["errors"][0]["pointer"], "/base");
    EXPECT_EQ(refused(post("/v1/compare", R"({"baseline": {"job": "j-9"}, "current": {"result": {}}})"), 422,
                      "no such job")["errors"][0]["pointer"],
              "/baseline");
    EXPECT_EQ(refused(post("/v1/compare", R"({"baseline": {"result": {}}, "current": {"job": 3}})"), 422,
                      "")["errors"][0]["pointer"],
              "/current");
    refused(post("/v1/compare", "[]"), 422, "object");
    refused(post("/v1/compare", "["), 400, "");
}

// A small result as `run` writes it, from the corpus of the fuzz targets.
TEST_F(FilesApi, CompareJudgesEveryMeasure) {
    std::ifstream file(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests/fuzz/corpus/result/tiny.json");
    nlohmann::json result = nlohmann::json::parse(file);
    const std::string other = submit();
    fake::succeed(*jobs_, other, {{"result.json", result.dump()}});
    const auto compared = [&](const nlohmann::json& current) {
        return json(post("/v1/compare",
                         nlohmann::json{{"baseline", {{"job", other}}}, {"current", {{"result", current}}}}.dump()),
                    200);
    };
    const std::string same = compared(result).dump();
    EXPECT_EQ(same.find("\"larger\""), std::string::npos) << same;
    result["variants"][0]["lights"][0]["cells"][0]["bytes"] = 1'000'000;
    EXPECT_NE(compared(result).dump().find("\"larger\""), std::string::npos);
    result["variants"] = 3;
    const nlohmann::json body = {{"baseline", {{"job", other}}}, {"current", {{"result", result}}}};
    refused(post("/v1/compare", body.dump()), 422, "");
}

TEST(Accept, KnowsWhetherGzipIsTaken) {
    const auto takes = [](const char* value) {
        ApiRequest request;
        request.headers = {{"accept-encoding", value}};
        return accepts_gzip(request);
    };
    EXPECT_FALSE(accepts_gzip({}));
    EXPECT_TRUE(takes("br, GZIP;q=0.5"));
    EXPECT_FALSE(takes("gzip;q=0"));
    EXPECT_FALSE(takes("identity"));
}

TEST(Accept, TakesTheMostSpecificRange) {
    const auto takes = [](const char* accept, const char* type) {
        ApiRequest request;
        request.headers = {{"accept", accept}};
        return accepts(request, type);
    };
    EXPECT_TRUE(accepts({}, "text/html"));
    EXPECT_TRUE(takes("*/*", "text/html"));
    EXPECT_TRUE(takes("text/*;q=0.1", "text/html"));
    EXPECT_TRUE(takes("image/png, Text/HTML; level=1", "text/html"));
    EXPECT_FALSE(takes("application/json", "text/html"));
    EXPECT_FALSE(takes("text/html;q=0, */*", "text/html"));
    EXPECT_FALSE(takes("*/*;q=0", "text/html"));
    EXPECT_TRUE(takes("*/*;q=0, text/html", "text/html"));
}

}  // namespace
}  // namespace shadowbench::service

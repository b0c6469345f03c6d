#include "http/fixture.h"

#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

struct GoodHelper : Helper {
    std::string ask(const std::string&, double) override {
        return R"({"name": "tiny", "seed": 1, "hash": "h", "variants": 1, "lights": 1, "techniques": 1, "notes": [],
                   "estimate": {"seconds": 1, "bytes": 1, "resolution": 1, "samples_per_pixel": 1}})";
    }
};

}  // namespace

HttpTest::HttpTest() {
    service_options_.start_helper = [](const std::vector<std::string>&) { return std::make_unique<GoodHelper>(); };
    service_options_.limits.body = 10'000;
    service_options_.event_streams = 4;
    http_options_.workers = 4;
    restart();
}

HttpTest::~HttpTest() {
    stop();
    service_.reset();
    jobs_.reset();
}

void HttpTest::restart() {
    stop();
    server_.reset();
    service_.reset();
    jobs_ = std::make_unique<Jobs>(folder_, "", std::vector<std::string>{}, JobLimits{});
    service_ = std::make_unique<Service>(*jobs_, service_options_);
    server_ = std::make_unique<HttpServer>(*service_, service_options_.event_streams, http_options_);
    thread_ = std::thread([this] { server_->run(); });
}

void HttpTest::stop() {
    if (!thread_.joinable()) return;
    jobs_->stop();
    server_->stop();
    thread_.join();
}

void HttpTest::refused(const std::string& bytes, int status, const std::string& says) {
    const RawAnswer answer = ask(bytes);
    const std::string start = bytes.substr(0, 80);
    EXPECT_EQ(answer.status, status) << start << "\n" << answer.body;
    EXPECT_TRUE(answer.has("Content-Type: application/problem+json")) << start << "\n" << answer.head;
    const nlohmann::json problem = nlohmann::json::parse(answer.body, nullptr, false);
    ASSERT_TRUE(problem.is_object()) << start << "\n" << answer.body;
    EXPECT_EQ(problem["status"], status);
    EXPECT_NE(problem["detail"].get<std::string>().find(says), std::string::npos) << answer.body;
    EXPECT_EQ(ask(get("/healthz")).status, 200) << "the server lives after " << start;
}

std::string HttpTest::ended_job() {
    const RawAnswer answer = ask(post("/v1/jobs", scenario));
    EXPECT_EQ(answer.status, 202) << answer.body;
    const std::string id = nlohmann::json::parse(answer.body).at("id");
    std::string large;
    for (int i = 0; i < 200'000; ++i) large += std::to_string(i) + ",";
    fake::succeed(*jobs_, id,
                  {{"result.json", "{\"name\": \"tiny\"}"},
                   {"result.csv", "a,b\n"},
                   {"images/reference.png", "0123456789"},
                   {"images/large.exr", large},
                   {"images/empty.exr", ""}});
    return id;
}

}  // namespace shadowbench::service

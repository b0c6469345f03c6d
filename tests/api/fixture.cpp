#include "api/fixture.h"

#include <fstream>
#include <sstream>

#include <unistd.h>

#include "api/openapi_check.h"
#include "base/error.h"
#include "service/api/file_answer.h"
#include "service/api/helper_side.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

// The child's side, called as a function: it begins anew with every line.
class LocalHelper final : public Helper {
public:
    LocalHelper(std::vector<std::string> arguments, std::vector<fs::path> data)
        : arguments_(std::move(arguments)), data_(std::move(data)) {}

    std::string ask(const std::string& line, double) override {
        std::ostringstream out;
        if (arguments_[0] == "examine") {
            std::istringstream in(line);
            examine_lines(data_, std::stod(value("--pace=")), in, out);
        } else {
            const std::size_t end = line.find('\n');
            if (end != std::string::npos) scenario_ = line.substr(0, end);
            std::istringstream in(scenario_ + "\n" + line.substr(end == std::string::npos ? 0 : end + 1) + "\n");
            curve_lines(data_, value("--light="), std::stoul(value("--variant=")), in, out);
        }
        std::string text = out.str();
        return text.substr(0, text.find('\n'));
    }

private:
    std::string value(const std::string& option) const {
        for (const std::string& argument : arguments_)
            if (argument.starts_with(option)) return argument.substr(option.size());
        return "";
    }
    std::vector<std::string> arguments_;
    std::vector<fs::path> data_;
    std::string scenario_;
};

}  // namespace

nlohmann::json tiny_scenario() {
    return nlohmann::json::parse(R"({
        "name": "tiny",
        "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
        "lights": [{"type": "directional", "name": "sun", "direction": [0, -1, 0]}],
        "rays": {"resolution": 8, "samples_per_pixel": 4, "seed": 5},
        "receivers": {"type": "probes", "count": 200},
        "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
        "timing": {"repetitions": 1, "lookups": 64},
        "techniques": [{"type": "deep"}, {"type": "uncompressed"}]
    })");
}

ApiRequest request(const std::string& method, const std::string& target, std::vector<Field> headers) {
    ApiRequest made;
    made.method = method;
    std::istringstream path(target.substr(1, target.find('?') - 1));
    for (std::string segment; std::getline(path, segment, '/');) made.path.push_back(segment);
    if (target.substr(0, target.find('?')).ends_with('/')) made.path.push_back("");
    std::istringstream query(target.find('?') == std::string::npos ? "" : target.substr(target.find('?') + 1));
    for (std::string pair; std::getline(query, pair, '&');)
        made.query.push_back({pair.substr(0, pair.find('=')), pair.substr(pair.find('=') + 1)});
    made.headers = std::move(headers);
    return made;
}

ApiRequest post(const std::string& target, const std::string& body, std::vector<Field> headers) {
    ApiRequest made = request("POST", target, std::move(headers));
    made.body = body;
    made.has_body = !body.empty();
    if (made.has_body && !made.header("content-type")) made.headers.push_back({"content-type", "application/json"});
    return made;
}

ApiTest::ApiTest() {
    fs::create_directories(folder_ / "data");
    start(standard_options());
}

ApiTest::~ApiTest() {
    service_.reset();
    jobs_.reset();
}

ServiceOptions ApiTest::standard_options() const {
    ServiceOptions options;
    options.data = {folder_ / "data"};
    options.scenarios = {fs::path(SHADOWBENCH_SOURCE_DIR) / "scenarios"};
    return options;
}

void ApiTest::start(const ServiceOptions& given, const JobLimits& limits) {
    ServiceOptions options = given;
    if (!options.start_helper)
        options.start_helper = [this, data = given.data](const std::vector<std::string>& arguments) {
            ++helpers_;
            return std::make_unique<LocalHelper>(arguments, data);
        };
    service_.reset();
    jobs_ = std::make_unique<Jobs>(folder_ / "state", "", std::vector<std::string>{}, limits);
    service_ = std::make_unique<Service>(*jobs_, options);
}

std::string ApiTest::body_of(const ApiResponse& response) const {
    return response.file ? read_all(*response.file) : response.body;
}

ApiResponse ApiTest::answer(const ApiRequest& request) {
    ApiResponse response = service_->handle(request);
    check_documented(request, response, body_of(response));
    return response;
}

nlohmann::json ApiTest::json(const ApiRequest& request, int status) {
    const ApiResponse response = answer(request);
    const std::string body = body_of(response);
    EXPECT_EQ(response.status, status) << body;
    EXPECT_EQ(response.type, status < 400 ? "application/json" : "application/problem+json");
    return nlohmann::json::parse(body, nullptr, false);
}

nlohmann::json ApiTest::refused(const ApiRequest& request, int status, const std::string& says) {
    nlohmann::json problem = json(request, status);
    EXPECT_EQ(problem["status"], status);
    EXPECT_EQ(problem["type"], "about:blank");
    EXPECT_NE(problem["detail"].get<std::string>().find(says), std::string::npos) << problem;
    return problem;
}

std::string ApiTest::submit() {
    return json(post("/v1/jobs", tiny_scenario().dump()), 202).value("id", "");
}

}  // namespace shadowbench::service

// A Service over jobs that the test moves on, with its helpers in this process.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fake_jobs/fake_jobs.h"
#include "service/api/service.h"
#include "temporary_folder.h"

namespace shadowbench::service {

// A small scenario that is whole.
nlohmann::json tiny_scenario();

// "GET", "/v1/jobs?limit=2".
ApiRequest request(const std::string& method, const std::string& target, std::vector<Field> headers = {});
ApiRequest post(const std::string& target, const std::string& body, std::vector<Field> headers = {});

// What would be answered over the line, checked against openapi.json: the status is documented, and JSON has the
// documented form.
class ApiTest : public testing::Test {
protected:
    ApiTest();
    ~ApiTest() override;

    // Makes the service anew.
    void start(const ServiceOptions& options, const JobLimits& limits = {});
    ServiceOptions standard_options() const;

    ApiResponse answer(const ApiRequest& request);
    nlohmann::json json(const ApiRequest& request, int status);
    // A problem of this status whose detail says this; its JSON.
    nlohmann::json refused(const ApiRequest& request, int status, const std::string& says);

    // A job of the tiny scenario; its id.
    std::string submit();
    std::string body_of(const ApiResponse& response) const;

    const TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
    std::unique_ptr<Jobs> jobs_;
    std::unique_ptr<Service> service_;
    int helpers_ = 0;  // started so far
};

}  // namespace shadowbench::service

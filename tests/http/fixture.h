// A server on any free port, over jobs that the test moves on.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "fake_jobs/fake_jobs.h"
#include "http/raw.h"
#include "service/api/service.h"
#include "service/http/server.h"
#include "temporary_folder.h"

namespace shadowbench::service {

class HttpTest : public testing::Test {
protected:
    HttpTest();
    ~HttpTest() override;

    // Stops the server that runs, and starts one with what stands below.
    void restart();
    void stop();

    RawAnswer ask(const std::string& bytes) { return Raw(port()).ask(bytes); }
    int port() const { return server_->port(); }
    // A problem of this status.
    void refused(const std::string& bytes, int status, const std::string& says = "");
    // A job that has ended, with some files; its id.
    std::string ended_job();

    ServiceOptions service_options_;  // with a helper that finds every scenario good
    HttpOptions http_options_;
    const TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
    std::unique_ptr<Jobs> jobs_;
    std::unique_ptr<Service> service_;
    std::unique_ptr<HttpServer> server_;
    std::thread thread_;
};

inline const std::string scenario = R"({"name": "tiny"})";

}  // namespace shadowbench::service

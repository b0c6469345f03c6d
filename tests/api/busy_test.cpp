// Requests that wait for slow helpers leave threads for those that need none.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "api/fixture.h"
#include "service/api/problem.h"

namespace shadowbench::service {
namespace {

// Answers once it may.
class Slow final : public Helper {
public:
    explicit Slow(std::shared_future<void> may) : may_(std::move(may)) {}
    std::string ask(const std::string&, double) override {
        may_.wait();
        return R"({"error": {"code": 65, "where": "/x", "message": "it is refused in the end"}})";
    }

private:
    std::shared_future<void> may_;
};

struct BusyApi : ApiTest {
    BusyApi() {
        ServiceOptions options = standard_options();
        options.waiting = 2;
        options.helper_seconds = 600.0;
        options.start_helper = [may = may_.get_future().share()](const std::vector<std::string>&) {
            return std::make_unique<Slow>(may);
        };
        start(options);
    }

    // Sends so many requests at a time, until `refused` of them were answered; then lets the helpers go on.
    template <class Request>
    void send(int count, int refused, const Request& make) {
        std::vector<std::thread> threads;
        for (int i = 0; i < count; ++i)
            threads.emplace_back([&, i] {
                const ApiResponse response = service_->handle(make(i));
                if (response.status == 503) {
                    EXPECT_TRUE(response.header("Retry-After"));
                    EXPECT_NE(response.body.find("too many requests of this kind"), std::string::npos) << response.body;
                    ++turned_away_;
                } else {
                    ++answered_;
                }
            });
        while (turned_away_ < refused) std::this_thread::yield();
        EXPECT_EQ(answered_, 0);
        EXPECT_EQ(answer(request("GET", "/healthz")).status, 200);
        may_.set_value();
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(turned_away_, refused);
        EXPECT_EQ(answered_, count - refused);
    }

    std::promise<void> may_;
    std::atomic<int> turned_away_ = 0, answered_ = 0;
};

TEST_F(BusyApi, TwoExaminationsRunAndTwoWait) {
    send(9, 5, [](int i) {
        nlohmann::json scenario = tiny_scenario();
        scenario["purpose"] = std::to_string(i);
        return post("/v1/validate", scenario.dump());
    });
}

}  // namespace
}  // namespace shadowbench::service

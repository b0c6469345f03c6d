#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "api/fixture.h"
#include "base/error.h"
#include "service/api/curve_cache.h"
#include "service/api/examine.h"
#include "service/api/helper.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

constexpr std::size_t enough = std::size_t{8} << 30;

template <class Action>
ErrorCode code_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::internal;
}

TEST(HelperProcess, AnswersLineForLine) {
    const auto cat = start_process("/bin/cat", {}, enough);
    EXPECT_EQ(cat->ask("one", 60), "one");
    EXPECT_EQ(cat->ask("two", 60), "two");
    const std::string large(3'000'000, 'x');
    EXPECT_EQ(cat->ask(large, 60), large) << "more than a pipe holds";
}

TEST(HelperProcess, ThatTakesTooLongIsGivenUp) {
    const auto sleeper = start_process("/bin/sleep", {"1000"}, enough);
    EXPECT_EQ(code_of([&] { sleeper->ask("x", 0.05); }), ErrorCode::bad_input);
}

TEST(HelperProcess, ThatEndsIsSaidToHave) {
    const auto dead = start_process("/bin/false", {}, enough);
    EXPECT_EQ(code_of([&] { dead->ask("x", 60); }), ErrorCode::bad_input);
    EXPECT_EQ(code_of([] { start_process("/no/such/program", {}, enough); }), ErrorCode::internal);
}

TEST(HelperProcess, OfThisProgramExaminesAScenario) {
    const auto helper = start_process(SHADOWBENCH_PROGRAM, {"examine"}, enough);
    const nlohmann::json facts = take_answer(helper->ask(tiny_scenario().dump(), 120));
    EXPECT_EQ(facts["name"], "tiny");
    EXPECT_EQ(code_of([&] { take_answer(helper->ask("{", 120)); }), ErrorCode::bad_input) << "and goes on";
    EXPECT_EQ(take_answer(helper->ask(tiny_scenario().dump(), 120)), facts);
    const auto other = start_process(SHADOWBENCH_PROGRAM, {"examine", "--pace=1"}, enough);
    EXPECT_EQ(take_answer(other->ask(tiny_scenario().dump(), 120)), facts) << "it measures nothing itself";
}

TEST(HelperProcess, OfThisProgramGivesCurves) {
    int started = 0;
    CurveCache cache(
        [&](const std::vector<std::string>& arguments) {
            ++started;
            return start_process(SHADOWBENCH_PROGRAM, arguments, enough);
        },
        {"curves"}, 120, 8);
    const auto scenario = [] { return tiny_scenario().dump(); };
    const nlohmann::json curves = take_answer(cache.curves({"j-1", "", 0, 4, 4}, scenario));
    EXPECT_EQ(curves["light"], "sun") << "the first";
    EXPECT_EQ(curves["exact"]["v"].back(), 0.25) << "in and out of a sphere that lets half through";
    EXPECT_EQ(take_answer(cache.curves({"j-1", "", 0, 3, 4}, scenario))["x"], 3);
    EXPECT_EQ(started, 1) << "the process stays: a pixel costs no start";
    EXPECT_EQ(take_answer(cache.curves({"j-1", "sun", 0, 4, 4}, scenario)), curves);
    EXPECT_EQ(code_of([&] { cache.curves({"j-1", "sun", 0, 8, 8}, scenario); }), ErrorCode::usage);
}

TEST(Lru, ForgetsWhatWasNotAskedForLongest) {
    Lru<int> lru(2);
    lru.put("a", 1);
    lru.put("b", 2);
    EXPECT_EQ(*lru.find("a"), 1);
    lru.put("c", 3);
    EXPECT_EQ(lru.find("b"), nullptr);
    EXPECT_EQ(*lru.find("a"), 1);
    lru.put("a", 4);
    EXPECT_EQ(*lru.find("a"), 4);
    EXPECT_EQ(lru.size(), 2u);
}

TEST(Slots, AreSoManyAtATime) {
    Slots slots(2, 8);
    std::atomic<int> at_work = 0, most = 0, done = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([&] {
            const Slots::Slot slot = slots.take(60);
            const int now = ++at_work;
            for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
            }
            std::this_thread::yield();
            --at_work;
            ++done;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(done, 8);
    EXPECT_LE(most, 2);
    const Slots::Slot one = slots.take(60), two = slots.take(60);
    EXPECT_THROW(slots.take(0.01), Busy);
}

// Else requests that wait for slow helpers would hold every thread of the server.
TEST(Slots, OnlySoManyWait) {
    Slots slots(1, 1);
    std::unique_ptr<Slots::Slot> held(new Slots::Slot(slots.take(60)));
    std::atomic<int> turned_away = 0, had_a_turn = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i)
        threads.emplace_back([&] {
            try {
                const Slots::Slot slot = slots.take(600);
                ++had_a_turn;
            } catch (const Busy&) {
                ++turned_away;
            }
        });
    while (turned_away < 2) std::this_thread::yield();  // whoever comes first waits
    EXPECT_EQ(had_a_turn, 0);
    held.reset();
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(turned_away, 2);
    EXPECT_EQ(had_a_turn, 1);
}

struct CurvesApi : ApiTest {
    std::string at(const std::string& id, const std::string& query) const {
        return "/v1/jobs/" + id + "/curves?" + query;
    }
};

TEST_F(CurvesApi, GivesTheFunctionsOfAPixel) {
    const std::string id = submit();
    const nlohmann::json curves = json(request("GET", at(id, "light=sun&x=4&y=4")), 200);
    EXPECT_EQ(curves["light"], "sun");
    EXPECT_EQ(curves["rays"], 4);
    ASSERT_EQ(curves["curves"].size(), 2u);
    EXPECT_EQ(curves["curves"][1]["technique"], "uncompressed");
    EXPECT_LE(curves["curves"][1]["error_max"], 1e-6);
    EXPECT_EQ(json(request("GET", at(id, "x=4&y=4")), 200), curves) << "the first light";
}

TEST_F(CurvesApi, KeepsAnswersAndHelpers) {
    const std::string id = submit();
    const int before = helpers_;
    for (int i = 0; i < 3; ++i)
        for (const char* x : {"1", "2", "3"}) json(request("GET", at(id, std::string("light=sun&y=2&x=") + x)), 200);
    EXPECT_EQ(helpers_, before + 1);
    json(request("GET", at(id, "light=0&x=1&y=2")), 200);
    EXPECT_EQ(helpers_, before + 2);
}

TEST_F(CurvesApi, SaysWhatIsWrongWithAQuestion) {
    const std::string id = submit();
    refused(request("GET", at("j-9", "x=1&y=1")), 404, "no such job");
    for (const char* query : {"", "x=1", "y=1", "x=one&y=1", "x=1&y=1.5", "x=1&y=1&variant=a"})
        refused(request("GET", at(id, query)), 400, "");
    refused(request("GET", at(id, "x=8&y=0")), 400, "(7, 7)");
    refused(request("GET", at(id, "light=moon&x=0&y=0")), 400, "light=moon: there is no such light");
    refused(request("GET", at(id, "x=0&y=0&variant=3")), 400, "variant=3: the scenario has 1 variant");
    json(request("GET", at(id, "x=0&y=0")), 200);
}

TEST_F(CurvesApi, StartsNoHelperForALightThatIsNotThere) {
    const std::string id = submit();
    const int before = helpers_;
    for (const char* query : {"light=moon&x=0&y=0", "light=1&x=0&y=0", "variant=1&x=0&y=0"})
        refused(request("GET", at(id, query)), 400, "");
    EXPECT_EQ(helpers_, before);
}

// A question that cannot be answered pushes no helper out that answers others.
TEST_F(CurvesApi, KeepsHelpersThatAnsweredAlone) {
    const std::string id = submit(), other = submit();
    const int before = helpers_;
    json(request("GET", at(id, "light=sun&x=0&y=0")), 200);
    json(request("GET", at(id, "light=0&x=0&y=0")), 200);
    EXPECT_EQ(helpers_, before + 2);
    for (int i = 0; i < 2; ++i) refused(request("GET", at(other, "x=8&y=0")), 400, "(7, 7)");
    EXPECT_EQ(helpers_, before + 4) << "and is not kept itself";
    json(request("GET", at(id, "light=sun&x=1&y=0")), 200);
    json(request("GET", at(id, "light=0&x=1&y=0")), 200);
    EXPECT_EQ(helpers_, before + 4);
}

// A helper that dies is started anew for the next question.
TEST_F(CurvesApi, OutlivesAHelperThatDies) {
    int started = 0;
    struct Dying : Helper {
        std::string ask(const std::string&, double) override { throw Error(ErrorCode::bad_input, "", "it ended"); }
    };
    CurveCache cache(
        [&](const std::vector<std::string>&) {
            ++started;
            return std::make_unique<Dying>();
        },
        {"curves"}, 1.0, 8);
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(code_of([&] {
                      cache.curves({"j-1", "sun", 0, 1, 1}, [] { return std::string("{}"); });
                  }),
                  ErrorCode::bad_input);
    EXPECT_EQ(started, 3);
}

// Answers with its number, until it is told to die, to complain, or was killed while it waited.
struct Numbered : Helper {
    Numbered(int the_number, const bool& is_killed) : number(the_number), killed(is_killed) {}
    std::string ask(const std::string& line, double) override {
        if (line == "die" || (killed && number == 1)) throw Error(ErrorCode::bad_input, "", "it ended");
        if (line == "complain") return R"({"error": {"code": 65, "where": "/x", "message": "no"}})";
        return nlohmann::json{{"number", number}}.dump();
    }
    int number;
    const bool& killed;
};

struct Examinations : testing::Test {
    int number_of(const std::string& scenario) {
        return std::get<nlohmann::json>(examiner.examine(scenario)).at("number").get<int>();
    }
    int started = 0;
    bool killed = false;
    Examiner examiner{[this](const std::vector<std::string>&) { return std::make_unique<Numbered>(++started, killed); },
                      {"examine"},
                      1.0,
                      8};
};

// Without this each new scenario would wait for the start of a process.
TEST_F(Examinations, KeepTheirProcess) {
    EXPECT_EQ(started, 1) << "it gets ready before the first question";
    for (const char* scenario : {"a", "b", "c"}) EXPECT_EQ(number_of(scenario), 1);
    EXPECT_EQ(started, 1);
}

// Nor would each scenario around files.
TEST_F(Examinations, AndScenariosAroundFilesShareTheirProcess) {
    for (const char* request : {"{}", "[]"}) EXPECT_EQ(examiner.arrange(request), R"({"number":1})");
    EXPECT_EQ(number_of("a"), 1);
    EXPECT_EQ(started, 1);
}

TEST_F(Examinations, StartAProcessAfterAFault) {
    for (const char* fault : {"die", "complain"})
        EXPECT_EQ(code_of([&] { number_of(fault); }), ErrorCode::bad_input) << "a new process says so too";
    EXPECT_EQ(started, 3) << "the second fault finds none that waits";
    EXPECT_EQ(number_of("a"), 4);
}

TEST_F(Examinations, DoNotBlameAScenarioForAProcessThatDiedBefore) {
    EXPECT_EQ(number_of("a"), 1);
    killed = true;
    EXPECT_EQ(number_of("b"), 2);
}

TEST_F(Examinations, RenewTheirProcessAfterManyAnswers) {
    for (int i = 0; i < 199; ++i) EXPECT_EQ(number_of(std::to_string(i)), 1);
    EXPECT_EQ(number_of("199"), 1);
    EXPECT_EQ(number_of("200"), 2);
}

TEST_F(Examinations, GiveAnAnswerThoughNoNewProcessStarts) {
    int starts = 0;
    Examiner one{[&](const std::vector<std::string>&) {
                     if (++starts > 1) throw Error(ErrorCode::io, "helper process", "too many processes");
                     return std::make_unique<Numbered>(starts, killed);
                 },
                 {"examine"},
                 1.0,
                 8};
    for (int i = 0; i < 200; ++i) EXPECT_NO_THROW(one.examine(std::to_string(i))) << i;
    EXPECT_EQ(code_of([&] { one.examine("200"); }), ErrorCode::io);
}

}  // namespace
}  // namespace shadowbench::service

// The program itself as what runs a job.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "jobs/job_host.h"

namespace shadowbench::service {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class JobProgram : public JobHost {
protected:
    void SetUp() override {
        data = {folder.path().string()};
        jobs = std::make_unique<Jobs>(state(), SHADOWBENCH_PROGRAM, data, limits);
    }
    static nlohmann::json scenario() { return nlohmann::json::parse(tiny_scenario); }
};

TEST_F(JobProgram, MeasuresAndDrawsAScenario) {
    const JobInfo job = run(scenario().dump());
    ASSERT_EQ(job.state, JobState::succeeded) << (job.fault ? job.fault->message : "");
    EXPECT_EQ(job.promises_kept, true);
    const auto result = nlohmann::json::parse(text_of(job.id, "result.json"));
    EXPECT_EQ(result.at("name"), "tiny");
    const auto images = nlohmann::json::parse(text_of(job.id, "images/images.json"));
    const auto files = jobs->artifacts(job.id);
    EXPECT_THAT(files, ::testing::IsSupersetOf({"result.csv", "images/reference.shaded.png",
                                                "images/reference.shaded.exr", "images/deep.heat.png"}));
    EXPECT_THAT(files, Not(::testing::Contains("scenario.json")));
    for (const auto& technique : images.at("techniques"))
        for (const auto& file : technique.at("files"))
            EXPECT_TRUE(jobs->artifact(job.id, "images/" + file.get<std::string>())) << file;
}

TEST_F(JobProgram, LeavesThePicturesOutWhereTheyAreNotWanted) {
    JobRequest request = request_of(scenario().dump());
    request.pictures = false;
    const JobInfo job = wait_for_end(jobs->submit(request).job.id);
    EXPECT_EQ(jobs->artifacts(job.id), (std::vector<std::string>{"result.csv", "result.json", "table.txt"}));
}

TEST_F(JobProgram, FindsARecommendation) {
    JobRequest request = request_of(scenario().dump());
    request.pictures = false;
    request.recommend = R"({"error":0.5,"only":["variance"],"budget":5})";
    const JobInfo job = wait_for_end(jobs->submit(request).job.id);
    ASSERT_EQ(job.state, JobState::succeeded) << (job.fault ? job.fault->message : "");
    EXPECT_EQ(job.promises_kept, true);
    EXPECT_EQ(jobs->artifacts(job.id), (std::vector<std::string>{"result.csv", "result.json", "table.txt"}));
    EXPECT_THAT(text_of(job.id, "table.txt"), HasSubstr(R"("type":"variance")"));
}

TEST_F(JobProgram, TellsWhichPartOfTheScenarioIsWrong) {
    auto wrong = scenario();
    wrong["rays"]["resolution"] = 0;
    const JobInfo job = run(wrong.dump());
    ASSERT_TRUE(job.fault);
    EXPECT_EQ(job.fault->code, 65);
    EXPECT_EQ(job.fault->where, "/rays/resolution");
}

TEST_F(JobProgram, LooksForDataOnlyWhereItIsToldAndDoesNotTellWhere) {
    auto wrong = scenario();
    wrong["scene"]["objects"][0] = {{"type", "mesh"}, {"file", "gone.obj"}};
    const JobInfo job = run(wrong.dump());
    ASSERT_TRUE(job.fault);
    EXPECT_EQ(job.fault->code, 66);
    EXPECT_THAT(job.fault->message, HasSubstr("gone.obj"));
    EXPECT_THAT(job.fault->message, HasSubstr("data folder"));
    EXPECT_THAT(job.fault->message, Not(HasSubstr(folder.path().string())));
}

TEST_F(JobProgram, IsEndedOverItsTime) {
    limits.seconds = 0.3;
    jobs.reset();
    SetUp();
    auto slow = scenario();
    slow["timing"]["repetitions"] = 1000;
    slow["timing"]["lookups"] = 1000000;
    const JobInfo job = run(slow.dump());
    ASSERT_TRUE(job.fault);
    EXPECT_THAT(job.fault->message, HasSubstr("longer than 0.3 s"));
}

}  // namespace
}  // namespace shadowbench::service

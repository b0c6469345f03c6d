// Jobs whose program is a shell script that does what the scenario says: the scenario of such a job is shell text, run
// in the job's folder.
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/read_text.h"
#include "jobs/made_result.h"
#include "service/jobs/jobs.h"
#include "temporary_folder.h"

namespace shadowbench::service {

inline void write_executable(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
    ::chmod(file.c_str(), 0755);
}

inline JobRequest request_of(const std::string& script) {
    JobRequest request;
    request.scenario = script;
    request.name = "fake";
    request.hash = std::to_string(std::hash<std::string>()(script));
    request.seed = 1;
    request.reuse = false;
    return request;
}

inline const std::string fake_result = text_of(made_result("fake"));
inline const std::string success = "echo '" + fake_result + "' >result.json\n";

inline bool has_ended(const JobInfo& job) {
    return job.state != JobState::queued && job.state != JobState::running;
}

// A scenario that the program itself runs in a moment, pictures included.
inline constexpr const char* tiny_scenario = R"({
    "name": "tiny",
    "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
    "lights": [{"type": "directional", "direction": [0, -1, 0]}],
    "rays": {"resolution": 8, "samples_per_pixel": 4},
    "receivers": {"type": "camera", "position": [0, 1, 5], "target": [0, 0, 0], "resolution": [16, 12]},
    "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
    "timing": {"repetitions": 1, "lookups": 64},
    "techniques": [{"type": "deep"}, {"type": "uncompressed"}]})";

class JobHost : public ::testing::Test {
protected:
    void SetUp() override {
        write_executable(program, "#!/bin/sh\ncd \"$2\" || exit 74\n. ./scenario.json\n");
        limits.grace = 0.0;
    }

    Jobs& start() { return start(program.string()); }
    Jobs& start(const std::string& own_program) {
        jobs.reset();
        jobs = std::make_unique<Jobs>(state(), own_program, data, limits, [this](const LogEvent& event) {
            const std::scoped_lock lock(said_mutex);
            if (event.kind != "job")
                said_lines += event.message + "\n";
            else
                became_lines += line_of(event);
        });
        return *jobs;
    }
    // All that servers of this test have said, but for what became of jobs.
    std::string said() const {
        const std::scoped_lock lock(said_mutex);
        return said_lines;
    }
    // What became of jobs, and why: "queued", "failed: the reason".
    std::string became() const {
        const std::scoped_lock lock(said_mutex);
        return became_lines;
    }
    static std::string line_of(const LogEvent& event) {
        for (const LogField& field : event.fields)
            if (field.name == "reason") return event.message + ": " + std::get<std::string>(field.value) + "\n";
        return event.message + "\n";
    }
    std::filesystem::path state() const { return folder.path() / "state"; }

    std::string submit(const std::string& script) const {
        const Submitted submitted = jobs->submit(request_of(script));
        EXPECT_EQ(submitted.outcome, Submitted::Outcome::created);
        return submitted.job.id;
    }
    // Waits until a job is as it should be.
    template <class Condition>
    JobInfo wait_until(const std::string& id, const Condition& condition) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        std::uint64_t revision = 0;
        for (;;) {
            const std::optional<JobInfo> job = jobs->wait(id, revision, 1.0);
            if (job && condition(*job)) return *job;
            if (!job || std::chrono::steady_clock::now() > end) {
                ADD_FAILURE() << (job ? to_string(job->state) : "gone");
                return job.value_or(JobInfo());
            }
            revision = job->revision;
        }
    }
    JobInfo wait_for_end(const std::string& id) const { return wait_until(id, has_ended); }
    JobInfo wait_for_run(const std::string& id) const {
        return wait_until(id, [](const JobInfo& job) { return job.progress.has_value(); });
    }
    JobInfo run(const std::string& script) const { return wait_for_end(submit(script)); }

    std::string text_of(const std::string& id, const std::string& name) const {
        const auto file = jobs->artifact(id, name);
        return file ? base::read_text(*file) : "no such file";
    }
    bool work_is_empty() const { return std::filesystem::is_empty(state() / "work"); }

    const TemporaryFolder folder;
    const std::filesystem::path program = folder.path() / "fake";
    std::vector<std::string> data;
    JobLimits limits;
    mutable std::mutex said_mutex;
    std::string said_lines, became_lines;
    std::unique_ptr<Jobs> jobs;  // the first to go
};

// Says that it runs, and then runs until it is ended.
inline const std::string endless = "echo '{\"stage\":\"build\",\"done\":1,\"total\":2,\"fraction\":0.5}'; sleep 1000\n";

}  // namespace shadowbench::service

// A sweep of many quick cells, the program as a process of its own, and what the parts have left in their folder.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>
#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "base/shell_word.h"
#include "results/report.h"
#include "temporary_folder.h"

namespace shadowbench {

namespace fs = std::filesystem;

// The exit code of a command line of a shell.
inline int shell(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class Swept : public ::testing::Test {
protected:
    // Each seed of the rays is a cell.
    explicit Swept(int cells) {
        nlohmann::json scenario = nlohmann::json::parse(R"({
            "name": "swept",
            "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
            "lights": [{"type": "directional", "direction": [0, -1, 0]}],
            "rays": {"resolution": 8, "samples_per_pixel": 4},
            "receivers": {"type": "probes", "count": 200},
            "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
            "timing": {"repetitions": 1, "lookups": 64},
            "techniques": [{"type": "deep"}, {"type": "ray_traced"}]
        })");
        for (int seed = 1; seed <= cells; ++seed) scenario["sweeps"]["/rays/seed"].push_back(seed);
        std::ofstream(path("swept.json")) << scenario.dump();
    }

    std::string path(const std::string& name) const { return temporary_.path(name); }
    std::string text(const std::string& name) const { return base::read_text(path(name)); }

    // The command line that runs the program in the temporary folder.
    std::string program(const std::string& arguments, const std::string& log) const {
        return "cd " + base::shell_word(temporary_.path()) + " && exec " + SHADOWBENCH_PROGRAM + " " + arguments +
               " >" + log + " 2>&1 </dev/null";
    }

    std::size_t cells() const {
        std::size_t count = 0;
        std::error_code failed;
        for (const auto& entry : fs::directory_iterator(path("sweep/cells"), failed))
            count += entry.path().filename().string().front() != '.' ? 1 : 0;  // a dot: what a killed task left
        return count;
    }

    // The processes that measure a part of the sweep, such as "0/4", or all parts.
    std::vector<pid_t> tasks(const std::string& part = "", const std::string& folder = "sweep") const {
        const std::string out = std::string("--out") + '\0' + path(folder) + '\0',
                          shard = std::string("--shard") + '\0';
        std::vector<pid_t> found;
        for (const auto& entry : fs::directory_iterator("/proc")) {
            const std::string name = entry.path().filename().string();
            if (name.find_first_not_of("0123456789") != std::string::npos) continue;
            std::ifstream file(entry.path() / "cmdline");
            const std::string words{std::istreambuf_iterator<char>(file), {}};
            const bool measures = words.starts_with(SHADOWBENCH_PROGRAM) && words.find(out) != std::string::npos;
            if (measures && words.find(shard + part) != std::string::npos) found.push_back(std::stoi(name));
        }
        return found;
    }

    // How often the logs of all parts have each line that begins so.
    std::map<std::string, int> lines(const std::string& start) const {
        std::map<std::string, int> counts;
        for (const auto& entry : fs::directory_iterator(path("sweep/batch"))) {
            if (!entry.path().filename().string().starts_with("part-")) continue;
            std::ifstream log(entry.path());
            for (std::string line; std::getline(log, line);)
                if (line.starts_with(start)) ++counts[line];
        }
        return counts;
    }

    void expect_result_of_one_machine() const {
        ASSERT_EQ(shell(program("run swept.json --out whole", "whole.log")), 0) << text("whole.log");
        nlohmann::ordered_json whole = nlohmann::ordered_json::parse(text("whole/result.json")),
                               parts = nlohmann::ordered_json::parse(text("sweep/result/result.json"));
        results::strip_times(whole);
        results::strip_times(parts);
        EXPECT_EQ(parts, whole);
    }

private:
    const TemporaryFolder temporary_;
};

}  // namespace shadowbench

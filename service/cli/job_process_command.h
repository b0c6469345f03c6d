// The command that a server runs for each job, in a child process.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "service/cli/commands.h"

namespace shadowbench::service {

struct JobProcessArguments {
    std::string folder;
    std::vector<std::string> data;
    LibraryArguments libraries;
    double memory_limit = 16.0;  // GiB
    bool pictures = true;
};

// Runs the folder's scenario.json: writes result.json, result.csv and table.txt there and, where the scene has objects,
// images/ as render does. An error that prevents only the pictures, such as an empty view, goes to images/error.json;
// the result is complete without them. If the folder has a recommend.json (a recommend::Request), it finds the answer
// to that instead: see recommend_job.h. Progress, and an error before it is thrown, are lines of JSON on `out`: see
// service/jobs/progress_line.h. Returns whether every technique kept its promises, or whether a setting reaches the
// error.
bool job_process_command(const JobProcessArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service

// What a server's job runs as, in a process of its own.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

struct JobProcessArguments {
    std::string folder;
    std::vector<std::string> data;
    double memory_limit = 16.0;  // GiB
    bool pictures = true;
};

// Runs the folder's scenario.json: writes result.json and result.csv there and, where the scene has objects, images/ as
// render does. What only the pictures lack, as something to see, stands in images/error.json: the result is whole
// without them. Progress, and a fault before it is thrown, are lines of JSON on `out`: see
// service/jobs/progress_line.h. Whether every technique kept its promises.
bool job_process_command(const JobProcessArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service

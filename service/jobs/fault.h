// Why a job failed, in words for its client: nothing of the machine, as paths of its folders.
#pragma once

#include <string>
#include <vector>

#include "service/jobs/child.h"
#include "service/jobs/jobs.h"

namespace shadowbench::service {

// A folder, and what a client may read in its place.
struct HiddenFolder {
    std::string path, name;
};
// The state folder, the folders of data, as they are written, whole, and without links; longest first.
std::vector<HiddenFolder> hidden_folders(const std::string& state, const std::vector<std::string>& data);

// "/srv/data/hair/ball.tfx:12" -> "hair/ball.tfx:12"; the folder alone becomes its name.
std::string hide(std::string text, const std::vector<HiddenFolder>& folders);

// Of every absolute path in a text only its last part.
std::string shorten_paths(const std::string& text);

// Of a process that ended without a result and without a line that says why.
JobFault fault_of_end(const ChildReport& report, const JobLimits& limits);

}  // namespace shadowbench::service

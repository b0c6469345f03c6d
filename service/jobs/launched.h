// Runs a job through a launcher, such as "srun --exclusive -N1 -n1", which starts it on another machine.
//
// There, a guard runs the job's process, watches its memory and its time, and ends it as soon as the guard's standard
// input is closed, when the server wants that, or brings no sign of life for a while, when the launcher or the server
// is gone. So nothing depends on the signals that a launcher passes on, but it must pass on the standard input. The
// guard writes the lines of the job, and its own, of which the last says how the job ended; without that line, the job
// is lost, with its machine or by the launcher.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "service/jobs/child.h"

namespace shadowbench::service {

// `launcher`: words of a POSIX shell, to which those of the guard are added. `guard`: the file of this program, as the
// other machine sees it. The rest is as for run_child(), with the report that run_child() would have given there. The
// time in which the launcher waits for a machine does not count.
ChildReport run_launched(const std::string& launcher, const std::string& guard, const std::string& program,
                         const std::vector<std::string>& arguments, const ChildLimits& limits,
                         const std::function<void(std::string_view line)>& on_line,
                         const std::function<bool()>& should_end);

// The guard: runs the program, and writes its lines, and the last of its standard error to `err`. `silence`: the
// seconds without a sign of life after which it ends the program.
inline constexpr double longest_silence_of_server = 60.0;
void guard_job(const std::string& program, const std::vector<std::string>& arguments, const ChildLimits& limits,
               double silence, std::ostream& out, std::ostream& err);

}  // namespace shadowbench::service

// The lines of JSON that a job's process writes to its standard output:
//   {"stage":"capture","place":"1/3 key","done":3,"total":16,"fraction":0.04}
//   {"error":{"code":65,"where":"/lights/0","message":"..."}}
//   {"storage":{"message":"...","bytes":1048576}}
// The last reports that the job's folder could not be written or read, which is not a fault of the job, and the number
// of bytes that the job has yet to write there, as far as it is known.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "bench/progress.h"
#include "service/jobs/jobs.h"

namespace shadowbench::service {

// Each gives a line without its newline.
std::string progress_line(const bench::Progress& progress, double fraction);
std::string error_line(const base::Error& error);
struct StorageFault {
    std::string message;
    std::uint64_t bytes = 0;
};
std::string storage_line(const StorageFault& fault);

// Reads a line of an untrusted process: nothing for any other line. Texts become printable; the fraction is in [0, 1],
// and 0 where the line has none.
std::variant<std::monostate, JobProgress, JobFault, StorageFault> read_line(std::string_view line);

}  // namespace shadowbench::service

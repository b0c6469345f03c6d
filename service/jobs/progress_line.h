// What a job's process says on its standard output, a line of JSON each:
//   {"stage":"capture","place":"1/3 key","done":3,"total":16,"fraction":0.04}
//   {"error":{"code":65,"where":"/lights/0","message":"..."}}
//   {"storage":{"message":"...","bytes":1048576}}
// The last says that the job's own folder could not be written or read, which is no fault of the job, and how many
// bytes it has yet to write there, as far as that is known.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "bench/progress.h"
#include "service/jobs/jobs.h"

namespace shadowbench::service {

// Without the end of the line.
std::string progress_line(const bench::Progress& progress, double fraction);
std::string error_line(const base::Error& error);
struct StorageFault {
    std::string message;
    std::uint64_t bytes = 0;
};
std::string storage_line(const StorageFault& fault);

// Nothing for a line that is none of them: the process may have gone wrong, and print what it likes. Texts come out
// printable; the fraction is in [0, 1], and 0 where the line has none.
std::variant<std::monostate, JobProgress, JobFault, StorageFault> read_line(std::string_view line);

}  // namespace shadowbench::service

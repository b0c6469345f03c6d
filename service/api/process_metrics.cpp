// The metrics of the process and of its build.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include <prometheus/metric_family.h>

#include "results/program.h"
#include "service/api/metric_families.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

// The fields of /proc/self/stat from the third on, which follows the name of the program in parentheses.
std::vector<std::string> read_stat() {
    std::ifstream file("/proc/self/stat");
    std::string text;
    std::getline(file, text);
    const std::size_t name_end = text.rfind(')');
    std::istringstream rest(name_end == std::string::npos ? "" : text.substr(name_end + 1));
    std::vector<std::string> fields;
    for (std::string field; rest >> field;) fields.push_back(field);
    return fields;
}

// When the machine started, in seconds since 1970; 0 where it does not say.
double boot_time() {
    std::ifstream file("/proc/stat");
    double seconds = 0.0;
    for (std::string word; file >> word;)
        if (word == "btime" && file >> seconds) return seconds;
    return 0.0;
}

}  // namespace

std::vector<prometheus::MetricFamily> process_families() {
    std::vector<prometheus::MetricFamily> families;
    const std::vector<std::string> stat = read_stat();
    constexpr std::size_t user = 11, system = 12, threads = 17, start = 19, virtual_bytes = 20, resident_pages = 21;
    if (stat.size() > resident_pages) {
        const double tick = static_cast<double>(::sysconf(_SC_CLK_TCK));
        const auto number = [&](std::size_t field) { return std::stod(stat[field]); };
        families.push_back(
            counter_family("process_cpu_seconds_total",
                           "Seconds of processor time of the server; its jobs are processes of their own.",
                           (number(user) + number(system)) / tick));
        families.push_back(gauge_family("process_resident_memory_bytes", "Resident memory.",
                                        number(resident_pages) * static_cast<double>(::sysconf(_SC_PAGESIZE))));
        families.push_back(gauge_family("process_virtual_memory_bytes", "Virtual memory.", number(virtual_bytes)));
        families.push_back(gauge_family("process_start_time_seconds", "Start of the process, in seconds since 1970.",
                                        boot_time() + number(start) / tick));
        families.push_back(gauge_family("process_threads", "Threads.", number(threads)));
    }
    std::error_code failed;
    std::size_t open = 0;
    for (fs::directory_iterator entry("/proc/self/fd", failed), end; !failed && entry != end; entry.increment(failed))
        ++open;
    families.push_back(gauge_family("process_open_fds", "Open file descriptors.", static_cast<double>(open)));
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0)
        families.push_back(
            gauge_family("process_max_fds", "Most open file descriptors.", static_cast<double>(limit.rlim_cur)));
    const results::Program build = results::this_program();
    prometheus::MetricFamily info = gauge_family("shadowbench_build_info", "1; its labels name the build.", 1.0);
    info.metric[0].label = {{"version", build.version}, {"commit", build.commit}};
    families.push_back(std::move(info));
    return families;
}

}  // namespace shadowbench::service

#include "bench/disturbance.h"

#include <charconv>
#include <fstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace shadowbench::bench {

std::uint64_t involuntary_switches() {
    rusage usage{};
#ifdef RUSAGE_THREAD
    getrusage(RUSAGE_THREAD, &usage);
#else
    getrusage(RUSAGE_SELF, &usage);
#endif
    return static_cast<std::uint64_t>(usage.ru_nivcsw);
}

void count_pass(std::uint64_t switches, results::TimedPasses& passes) {
    ++passes.passes;
    passes.interrupted += switches > 0;
    passes.switches += switches;
}

std::optional<std::uint64_t> read_steal(std::string_view stat) {
    constexpr int steal = 8;
    const std::string_view start = "cpu ";
    if (stat.substr(0, start.size()) != start) return {};
    const char* at = stat.data() + start.size();
    const char* const end = stat.data() + stat.size();
    std::uint64_t value = 0;
    for (int i = 0; i < steal; ++i) {
        while (at != end && *at == ' ') ++at;
        const auto [next, fault] = std::from_chars(at, end, value);
        if (fault != std::errc()) return {};
        at = next;
    }
    return value;
}

std::optional<double> steal_seconds() {
    std::ifstream file("/proc/stat");
    std::string line;
    if (!std::getline(file, line)) return {};
    const std::optional<std::uint64_t> ticks = read_steal(line);
    const long ticks_a_second = sysconf(_SC_CLK_TCK);
    if (!ticks || ticks_a_second <= 0) return {};
    return static_cast<double>(*ticks) / static_cast<double>(ticks_a_second);
}

}  // namespace shadowbench::bench

#include "results/machine.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <thread>

#include "base/utc.h"

namespace shadowbench::results {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_word = 200;

// What a result can hold of any bytes.
std::string plain(std::string text) {
    text.resize(std::min(text.size(), longest_word));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

std::string first_line(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return plain(line);
}

// The value of the first line "key<spaces>: value" of a file.
std::string value_in(const fs::path& file, const std::string& key) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t colon = line.find(':');
        if (line.rfind(key, 0) != 0 || colon == std::string::npos) continue;
        if (line.find_first_not_of(" \t", key.size()) != colon) continue;
        const std::size_t start = line.find_first_not_of(" \t", colon + 1);
        return start == std::string::npos ? "" : plain(line.substr(start));
    }
    return "";
}

// Calls `use` with each entry of a folder that is named so, with a number behind it.
void for_each_numbered(const fs::path& folder, const std::string& name, const auto& use) {
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
        const std::string own = entry->path().filename().string();
        if (own.size() > name.size() && own.rfind(name, 0) == 0 &&
            own.find_first_not_of("0123456789", name.size()) == std::string::npos)
            use(entry->path());
    }
}

std::string governors(const fs::path& cpus) {
    std::set<std::string> names;
    for_each_numbered(cpus, "cpu", [&](const fs::path& cpu) {
        if (std::string name = first_line(cpu / "cpufreq/scaling_governor"); !name.empty()) names.insert(name);
    });
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value ? plain(value) : "";
}

std::string container_of(const fs::path& root) {
    std::error_code failed;
    if (std::string name = first_line(root / "run/systemd/container"); !name.empty()) return name;
    if (fs::exists(root / ".dockerenv", failed)) return "docker";
    if (fs::exists(root / "run/.containerenv", failed)) return "podman";
    if (fs::exists(root / ".singularity.d", failed)) return "apptainer";
    return environment("container");
}

std::uint64_t kibibytes(const std::string& text) {
    return std::strtoull(text.c_str(), nullptr, 10) * 1024;
}

}  // namespace

Machine this_machine(const fs::path& root) {
    Machine machine;
    const fs::path proc = root / "proc", system = root / "sys/devices/system";
    machine.logical_cores = static_cast<int>(std::thread::hardware_concurrency());
    machine.cpu = value_in(proc / "cpuinfo", "model name");
    machine.microcode = value_in(proc / "cpuinfo", "microcode");
    const std::string kind = first_line(proc / "sys/kernel/ostype"),
                      release = first_line(proc / "sys/kernel/osrelease");
    machine.kernel = kind + (kind.empty() || release.empty() ? "" : " ") + release;
    machine.governor = governors(system / "cpu");
    machine.smt = first_line(system / "cpu/smt/control");
    machine.memory = kibibytes(value_in(proc / "meminfo", "MemTotal"));
    for_each_numbered(system / "node", "node", [&](const fs::path&) { ++machine.numa_nodes; });
    machine.container = container_of(root);
    return machine;
}

void add_state(RunTimes& times, const fs::path& root) {
    const std::string load = first_line(root / "proc/loadavg");
    char* end = nullptr;
    const double value = std::strtod(load.c_str(), &end);
    if (end != load.c_str() && value >= 0.0 && value < 1e9) times.load = value;
    const std::string array = environment("SLURM_ARRAY_JOB_ID"), task = environment("SLURM_ARRAY_TASK_ID");
    times.slurm_job = array.empty() || task.empty() ? environment("SLURM_JOB_ID") : array + "_" + task;
    if (!times.slurm_job.empty()) times.slurm_node = environment("SLURMD_NODENAME");
}

RunTimes times_at_start() {
    RunTimes times;
    times.started = base::now_utc();
    add_state(times);
    return times;
}

}  // namespace shadowbench::results

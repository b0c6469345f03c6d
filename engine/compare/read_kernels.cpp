#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compare/read_result.h"

namespace shadowbench::compare {
namespace {

using nlohmann::json;

bool has(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

// Whether a number of a run is a counter. All are, except Google Benchmark's own.
bool is_counter(const std::string& name) {
    for (const char* own : {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads",
                            "iterations", "real_time", "cpu_time"})
        if (name == own) return false;
    return !has(name, "per_second");
}

bool is_ratio(const std::string& name) {
    return has(name, "floor") && has(name, "ratio");
}

double time_of(const results::Field& field) {
    const double value = field.number();
    if (value < 0.0) results::refuse(field.where, "must not be negative");
    return value;
}

// Sizes and errors do not change between repetitions; where they do, the worst counts.
void add_exact(Cell& cell, const std::string& name, Kind kind, double value) {
    const auto found =
        std::find_if(cell.exact.begin(), cell.exact.end(), [&](const Exact& exact) { return exact.name == name; });
    if (found == cell.exact.end())
        cell.exact.push_back({name, kind, value});
    else
        found->value = std::max(found->value, value);
}

// Processor time, which other programs do not change. Real time if the name asks for it (by the suffixes of Google
// Benchmark), or if there are several threads, whose processor times are added up.
const char* judged_time(const results::Field& run) {
    const std::string& name = run.at(run.has("run_name") ? "run_name" : "name").text();
    const bool real = has(name, "/real_time") || has(name, "/manual_time") || !run.has("cpu_time") ||
                      (run.has("threads") && run.at("threads").number() > 1.0);
    return real ? "real_time" : "cpu_time";
}

// A file of counts, such as a baseline, has no times.
void add_time(Cell& cell, const results::Field& run) {
    const char* const time = judged_time(run);
    if (!run.has(time)) return;
    const std::string& unit = run.at("time_unit").text();
    if (cell.timed.empty()) cell.timed.push_back({"time", unit, {{}}});
    if (cell.timed[0].unit != unit)
        results::refuse(run.where + "/time_unit", "repetitions of one kernel have different units");
    cell.timed[0].processes[0].raw.push_back(time_of(run.at(time)));
}

void add_run(Cell& cell, const results::Field& run) {
    if (run.has("error_occurred") && run.value.at("error_occurred") == json(true)) {
        cell.failed = true;
        cell.failure = run.has("error_message") ? run.at("error_message").text() : "the kernel failed";
        return;
    }
    add_time(cell, run);
    for (const auto& [name, value] : run.object().items()) {
        if (!value.is_number() || !is_counter(name)) continue;
        if (is_ratio(name) && !cell.timed.empty())
            cell.timed[0].processes[0].ratio.push_back(time_of(run.at(name.c_str())));
        else if (name == "instructions") {
            add_exact(cell, name, Kind::instructions, time_of(run.at(name.c_str())));
            cell.rerun.counted = true;
        } else if (has(name, "error"))
            add_exact(cell, name, Kind::error, time_of(run.at(name.c_str())));
        else if (has(name, "byte") || has(name, "node"))
            add_exact(cell, name, Kind::size, time_of(run.at(name.c_str())));
    }
}

std::string context(const results::Field& from, const char* key) {
    return from.has(key) && from.value.at(key).is_string() ? from.at(key).text() : "";
}

}  // namespace

Suite read_kernels(const results::Field& kernels) {
    Suite suite;
    suite.results = 1;
    suite.name = "kernels";
    const results::Field about = kernels.at("context"), runs = kernels.at("benchmarks");
    about.object();
    const std::string cpu = context(about, "cpu");
    suite.machine =
        fmt::format("{}, {:g} cores", cpu.empty() ? context(about, "host_name") : cpu, time_of(about.at("num_cpus")));
    suite.program = suite.commit = context(about, "commit");
    suite.started = context(about, "date");
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < runs.array().size(); ++i) {
        const results::Field run = runs.item(i);
        if (run.has("run_type") && run.at("run_type").text() == "aggregate") continue;
        const std::string& name = run.at(run.has("run_name") ? "run_name" : "name").text();
        const auto [place, is_new] = places.emplace(name, suite.cells.size());
        if (is_new) {
            Cell cell;
            cell.name = name;
            cell.rerun.kernel = true;
            cell.rerun.program = context(about, "executable");
            if (cell.rerun.program.empty()) cell.rerun.program = "kernels";
            cell.rerun.source = name;
            suite.cells.push_back(std::move(cell));
        }
        add_run(suite.cells[place->second], run);
    }
    // Ratios are dropped unless every repetition has one.
    for (Cell& cell : suite.cells)
        for (Timed& timed : cell.timed)
            if (timed.processes[0].ratio.size() != timed.processes[0].raw.size()) timed.processes[0].ratio.clear();
    return suite;
}

}  // namespace shadowbench::compare

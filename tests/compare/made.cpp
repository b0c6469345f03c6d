#include "compare/made.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::compare {
namespace {

using nlohmann::json;

json sample(const std::vector<double>& raw) {
    return {{"median", raw[0]}, {"interval95", {raw[0], raw[0]}}, {"raw", raw}};
}

json lookup(double ns, double floor) {
    return {{"ns", sample({ns, ns, ns})},
            {"floor_ns", sample({floor, floor, floor})},
            {"ratio_to_floor", sample({ns / floor, ns / floor, ns / floor})}};
}

json made_cell(const std::string& technique, const std::string& label, int index, double bytes, double rms, double ns) {
    const json errors{{"max", 4 * rms}, {"rms", rms}, {"mean", 0.5 * rms}, {"p99", 3 * rms}};
    json curve = errors, answers = errors;
    curve.update({{"mean_l1", rms}, {"cells", 64}, {"worst_cell", {3, 4}}, {"reference_error", 0.0}});
    answers["signed_mean"] = -0.1 * rms;
    return {{"technique", technique},
            {"version", 3},
            {"parameters", {{"tolerance", 0.02}}},
            {"label", label},
            {"where", "/techniques/" + std::to_string(index)},
            {"status", "ok"},
            {"reason", ""},
            {"verdict", "kept"},
            {"bytes", bytes},
            {"working_bytes", 2 * bytes},
            {"nodes", {{"cells", 64}, {"total", 128}, {"mean", 2.0}, {"max", 5}, {"histogram", {0, 1}}}},
            {"outside_promise", false},
            {"promised_curve_error", nullptr},
            {"curve_error", curve},
            {"lookup_error", answers},
            {"times",
             {{"build_ms", sample({3.0, 3.1, 3.2})},
              {"build_ns_per_segment", 25.0},
              {"lookups_a_pass", 4096},
              {"on_time_error_front", "perhaps"},
              {"lookup_image_order", lookup(ns, 1.0)},
              {"lookup_random_order", lookup(1.5 * ns, 1.2)}}}};
}

json made_light(const json& cells) {
    return {{"light", "key"},
            {"map",
             {{"width", 8},
              {"height", 8},
              {"samples_x", 1},
              {"samples_y", 1},
              {"pattern", "jittered"},
              {"seed", 1},
              {"channels", 1},
              {"media", false},
              {"z_min", -1.0},
              {"z_max", 1.0}}},
            {"rays", 64},
            {"segments", 100},
            {"ray_bytes", 1600},
            {"rays_kept", true},
            {"translucent", true},
            {"receivers", 500},
            {"receivers_outside_map", 0},
            {"capture",
             {{"embree_check",
               {{"rays", 64},
                {"other_crossings", 0},
                {"other_transmittance", 0},
                {"times", {{"capture_rays_per_second", 8e6}, {"embree_rays_per_second", 2e6}, {"ratio", 4.0}}}}},
              {"times", {{"seconds", 0.1}, {"setup_seconds", 0.0}, {"rays_per_second", 640.0}}}}},
            {"reference",
             {{"judged", 64},
              {"samples_per_pixel", 256},
              {"standard_error", {{"rms", 0.001}, {"max", 0.002}}},
              {"noise_tolerance", 0.5},
              {"spread_over_seeds", nullptr}}},
            {"cells", cells}};
}

}  // namespace

json made_result() {
    const json techniques = {{{"type", "deep"}, {"tolerance", 0.02}}, {{"type", "uncompressed"}}};
    return {{"schema_version", 1},
            {"name", "made"},
            {"scenario_hash", "00112233aabbccdd"},
            {"scenario", {{"name", "made"}, {"techniques", techniques}}},
            {"only", json::array()},
            {"program", {{"version", "0.1.0"}, {"commit", "abc"}, {"compiler", "GNU"}, {"build_type", "Release"}}},
            {"machine", {{"cpu", "AMD EPYC"}, {"logical_cores", 2}}},
            {"times", {{"started", "2026-11-25T02:00:00Z"}, {"seconds", 9.0}, {"threads", 2}}},
            {"variants",
             {{{"settings", json::object()},
               {"lights",
                json::array({made_light(json::array({made_cell("deep", "tolerance=0.02", 0, 1000.0, 0.05, 6.0),
                                                     made_cell("uncompressed", "", 1, 4000.0, 0.04, 60.0)}))})}}}}};
}

json& cell_of(json& result, std::size_t index) {
    return result["variants"][0]["lights"][0]["cells"][index];
}

json made_kernels() {
    json benchmarks = json::array();
    for (const char* name : {"compress/smoke/64", "sweep(x)/8"})
        for (int r = 0; r < 3; ++r)
            benchmarks.push_back({{"name", name},
                                  {"run_name", name},
                                  {"run_type", "iteration"},
                                  {"repetitions", 3},
                                  {"repetition_index", r},
                                  {"threads", 1},
                                  {"iterations", 100},
                                  {"real_time", 50.0 + r},
                                  {"cpu_time", 50.0 + r},
                                  {"time_unit", "us"},
                                  {"bytes", 512.0},
                                  {"nodes", 32.0},
                                  {"error_max", 0.01},
                                  {"ratio_to_floor", 2.0},
                                  {"ns_a_vertex", 1.5},
                                  {"bytes_per_second", 1e9 + r}});
    json mean = benchmarks[0];
    mean["run_type"] = "aggregate";
    mean["bytes"] = 1e9;
    benchmarks.push_back(mean);
    return {
        {"context",
         {{"date", "2026-11-25T02:00:00+00:00"}, {"host_name", "h"}, {"num_cpus", 2}, {"executable", "build/kernels"}}},
        {"benchmarks", benchmarks}};
}

Measured side(const std::vector<json>& documents, const std::string& interleaved) {
    Measured measured;
    for (const json& document : documents) EXPECT_TRUE(add(measured, document, "file.json"));
    measured.interleaved = interleaved;
    return measured;
}

const Line& line(const Comparison& comparison, const std::string& cell, const std::string& measure) {
    static const Line none;
    for (const Line& line : comparison.lines)
        if (line.cell.rfind(cell, 0) == 0 && line.measure == measure) return line;
    ADD_FAILURE() << "no line " << cell << " " << measure;
    return none;
}

double Noise::normal() {
    return std::sqrt(-2.0 * std::log(1.0 - random_.uniform())) * std::cos(6.283185307179586 * random_.uniform());
}

void Noise::next() {
    constexpr double kept = 0.9;
    machine_ = started_ ? kept * machine_ + std::sqrt(1.0 - kept * kept) * slow_ * normal() : slow_ * normal();
    own_ = luck_ * normal();
    started_ = true;
}

double Noise::plain() {
    const double outlier = random_.uniform() < 0.05 ? random_.uniform(0.2, 1.0) : 0.0;
    return std::exp(machine_ + own_ + 0.02 * normal() + outlier);
}

double Noise::over_floor() {
    const double outlier = random_.uniform() < 0.05 ? random_.uniform(-0.5, 0.5) : 0.0;
    return std::exp(0.2 * machine_ + own_ + 0.02 * normal() + outlier);
}

void make_times(json& result, Noise& noise, std::size_t slowed, double factor) {
    constexpr int repetitions = 7;
    noise.next();
    json& cells = result["variants"][0]["lights"][0]["cells"];
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double more = i == slowed ? factor : 1.0;
        json& times = cells[i]["times"];
        std::vector<double> build;
        for (int r = 0; r < repetitions; ++r) build.push_back(3.0 * more * noise.plain());
        times["build_ms"]["raw"] = build;
        for (const char* order : {"lookup_image_order", "lookup_random_order"}) {
            std::vector<double> ns, ratio;
            for (int r = 0; r < repetitions; ++r) {
                ns.push_back(6.0 * more * noise.plain());
                ratio.push_back(6.0 * more * noise.over_floor());
            }
            times[order]["ns"]["raw"] = ns;
            times[order]["ratio_to_floor"]["raw"] = ratio;
        }
    }
}

}  // namespace shadowbench::compare

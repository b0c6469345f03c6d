#include <cmath>

#include <nlohmann/json.hpp>

#include "results/report.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

using json = nlohmann::ordered_json;

json number(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json(const Sample& sample) {
    return {
        {"median", sample.median}, {"interval95", {sample.interval.low, sample.interval.high}}, {"raw", sample.raw}};
}

json to_json(const std::optional<Sample>& sample) {
    return sample ? to_json(*sample) : json(nullptr);
}

json to_json(const LookupTimes& times) {
    return {{"ns", to_json(times.ns)}, {"floor_ns", to_json(times.floor)}, {"ratio_to_floor", to_json(times.ratio)}};
}

json to_json(const std::optional<bool>& truth) {
    return truth ? json(*truth) : json(nullptr);
}

json to_json(const std::optional<CellTimes>& times, const LightResult& light) {
    if (!times) return nullptr;
    return {{"build_ms", to_json(times->build_ms)},
            {"build_ns_per_segment", times->ns_per_segment},
            {"lookups_a_pass", times->lookups},
            {"lookup_image_order", to_json(times->image_order)},
            {"lookup_random_order", to_json(times->random_order)},
            {"settled",
             {{"build", to_json(is_settled(times->build_ms, light))},
              {"lookup_image_order", to_json(is_settled(times->image_order.ns, light))},
              {"lookup_random_order", to_json(is_settled(times->random_order.ns, light))}}},
            {"on_time_error_front", to_string(times->on_front)}};
}

json to_json(const metrics::ErrorNorms& norms) {
    return {{"max", number(norms.max)},
            {"rms", number(norms.rms)},
            {"mean", number(norms.mean)},
            {"p99", number(norms.p99)}};
}

json to_json(const std::optional<CurveErrors>& errors) {
    if (!errors) return nullptr;
    json out = to_json(errors->norms);
    out["mean_l1"] = number(errors->mean_l1);
    out["cells"] = errors->cells;
    out["worst_cell"] = {errors->worst_x, errors->worst_y};
    out["reference_error"] = errors->reference_error;
    out["rise"] = number(errors->rise);
    out["lowest"] = number(errors->lowest);
    return out;
}

json to_json(const std::optional<LookupErrors>& errors) {
    if (!errors) return nullptr;
    json out = to_json(errors->norms);
    out["signed_mean"] = errors->signed_mean;
    out["rms_interval95"] = nullptr;
    if (const auto& interval = errors->interval) {
        out["rms_interval95"] = {number(interval->low), number(interval->high)};
        out["rms_interval_covers"] = interval->covers_rays ? "truth and rays" : "truth";
    }
    out["truth_sd"] = number(errors->truth_sd);
    return out;
}

json to_json(const std::vector<SeedErrors>& seeds) {
    json out = json::array();
    for (const SeedErrors& seed : seeds) out.push_back({{"lookup_error", to_json(seed.lookup)}, {"bytes", seed.bytes}});
    return out;
}

json to_json(const NodeCounts& nodes) {
    json out = {{"cells", nodes.cells},
                {"total", nodes.total},
                {"mean", nodes.mean()},
                {"max", nodes.max},
                {"histogram", nodes.histogram}};
    if (nodes.over_fewest) out["over_fewest"] = to_json(*nodes.over_fewest);
    return out;
}

json to_json(const Cell& cell, const LightResult& light) {
    json out = {{"technique", cell.technique}, {"version", cell.version}};
    if (const auto& library = cell.library)
        out["library"] = {{"file", library->file}, {"hash", library->hash}, {"isolated", library->isolated}};
    const json rest = {{"parameters", json::parse(cell.parameters_json)},
                       {"label", cell.parameters},
                       {"defaults", cell.defaults},
                       {"where", cell.where},
                       {"status", cell.status == CellStatus::ok ? "ok" : "failed"},
                       {"reason", cell.reason},
                       {"verdict", to_string(cell.verdict)},
                       {"verdict_why", cell.verdict_why},
                       {"outside_promise", cell.outside_promise},
                       {"promised_curve_error", number(cell.error_bound)},
                       {"bytes", cell.bytes},
                       {"working_bytes", cell.working_bytes},
                       {"nodes", to_json(cell.nodes)},
                       {"curve_error", to_json(cell.curve)},
                       {"lookup_error", to_json(cell.lookup)},
                       {"over_seeds", to_json(cell.over_seeds)},
                       {"on_bytes_error_front", to_string(cell.on_bytes_front)},
                       {"times", to_json(cell.times, light)}};
    out.update(rest);
    return out;
}

json to_json(const MapDescription& layout) {
    return {{"width", layout.width},
            {"height", layout.height},
            {"samples_per_pixel", layout.samples()},
            {"samples_x", layout.samples_x},
            {"samples_y", layout.samples_y},
            {"pattern", layout.jittered ? "jittered" : "regular"},
            {"seed", layout.seed},
            {"channels", layout.channels},
            {"media", layout.media},
            {"z_min", layout.z_min},
            {"z_max", layout.z_max}};
}

json to_json(const std::optional<Agreement>& agreement) {
    if (!agreement) return nullptr;
    return {{"agrees", agrees(*agreement)},
            {"rays", agreement->rays},
            {"other_crossings", agreement->other_crossings},
            {"other_transmittance", agreement->other_transmittance},
            {"times",
             {{"capture_rays_per_second", agreement->times.capture_rays_per_second},
              {"embree_rays_per_second", agreement->times.tracer_rays_per_second},
              {"ratio", agreement->times.ratio}}}};
}

json to_json(const ReferenceReport& reference) {
    return {
        {"judged", reference.judged},
        {"samples_per_pixel", reference.samples_per_pixel},
        {"standard_error",
         {{"rms", reference.error_rms}, {"max", reference.error_max}, {"degrees", reference.degrees}}},
        {"noise_tolerance", reference.noise_tolerance},
        {"spread_over_seeds",
         reference.spread_rms ? json{{"rms", *reference.spread_rms}, {"max", *reference.spread_max}} : json(nullptr)}};
}

json to_json(const TimedPasses& passes) {
    return {{"passes", passes.passes}, {"interrupted", passes.interrupted}, {"involuntary_switches", passes.switches}};
}

json to_json(const TimingReport& timing, const Settling& found) {
    return {{"goal", timing.goal},
            {"seconds", timing.seconds},
            {"builds", to_json(timing.builds)},
            {"lookups", to_json(timing.lookups)},
            {"steal_seconds", timing.steal_seconds ? json(*timing.steal_seconds) : json(nullptr)},
            {"settled", found.known() ? json(found.settled()) : json(nullptr)}};
}

json to_json(const LightResult& light) {
    json cells = json::array();
    for (const Cell& cell : light.cells) cells.push_back(to_json(cell, light));
    json out = {{"light", light.name},
                {"map", to_json(light.layout)},
                {"rays", light.rays},
                {"segments", light.segments},
                {"ray_bytes", light.ray_bytes},
                {"rays_kept", light.kept},
                {"sees_nothing", sees_nothing(light)},
                {"translucent", light.translucent},
                {"receivers", light.receivers},
                {"receivers_outside_map", light.dropped},
                {"capture",
                 {{"embree_check", to_json(light.agreement)},
                  {"times",
                   {{"seconds", light.times.seconds},
                    {"setup_seconds", light.times.setup_seconds},
                    {"rays_per_second", light.times.rays_per_second}}}}},
                {"reference", to_json(light.reference)},
                {"cells", std::move(cells)}};
    if (light.timing) out["times"] = to_json(*light.timing, settling(light));
    return out;
}

// Keys that the machine does not say are left out.
json to_json(const Machine& machine) {
    json out = {{"cpu", machine.cpu}, {"logical_cores", machine.logical_cores}};
    const auto add = [&](const char* key, const std::string& value) {
        if (!value.empty()) out[key] = value;
    };
    add("microcode", machine.microcode);
    add("kernel", machine.kernel);
    add("governor", machine.governor);
    add("smt", machine.smt);
    if (machine.memory != 0) out["memory"] = machine.memory;
    if (machine.numa_nodes != 0) out["numa_nodes"] = machine.numa_nodes;
    add("container", machine.container);
    return out;
}

// Whether the times are settled, and for which lights they are not.
json to_json(const RunTimes& times, const Result& result) {
    json unsettled = json::array();
    for (std::size_t v = 0; v < result.variants.size(); ++v)
        for (const LightResult& light : result.variants[v].lights)
            if (std::string why = unsettled_text(settling(light)); !why.empty())
                unsettled.push_back({{"variant", v}, {"light", light.name}, {"why", std::move(why)}});
    json out = {{"started", times.started},
                {"seconds", times.seconds},
                {"threads", times.threads},
                {"settled", to_json(settled(result))},
                {"unsettled", std::move(unsettled)}};
    add_state_to(out, times);
    return out;
}

json to_json(const VariantResult& variant) {
    json settings = json::object(), lights = json::array();
    for (const document::Setting& setting : variant.settings) settings[setting.pointer] = json::parse(setting.value);
    for (const LightResult& light : variant.lights) lights.push_back(to_json(light));
    return {{"settings", std::move(settings)}, {"lights", std::move(lights)}};
}

}  // namespace

nlohmann::ordered_json to_json(const FewestNodes& over) {
    return {{"ratio", over.ratio()}, {"interval95", {over.interval.low, over.interval.high}},
            {"cells", over.cells},   {"left_out", over.left_out},
            {"nodes", over.nodes},   {"fewest", over.fewest}};
}

void add_state_to(nlohmann::ordered_json& out, const RunTimes& times) {
    if (times.load) out["load"] = *times.load;
    if (!times.slurm_job.empty()) out["slurm_job"] = times.slurm_job;
    if (!times.slurm_node.empty()) out["slurm_node"] = times.slurm_node;
}

nlohmann::ordered_json to_json(const Result& result) {
    json variants = json::array();
    for (const VariantResult& variant : result.variants) variants.push_back(to_json(variant));
    json out = {{"schema_version", result_schema_version}, {"name", result.name}, {"purpose", result.purpose}};
    if (!result.notes.empty()) out["notes"] = result.notes;
    if (!result.files.empty()) out["files"] = result.files;
    out["scenario_hash"] = result.hash;
    out["scenario"] = json::parse(result.document);
    out["only"] = result.only;
    out["program"] = {{"version", result.program.version},
                      {"commit", result.program.commit},
                      {"compiler", result.program.compiler},
                      {"build_type", result.program.build_type}};
    out["machine"] = to_json(result.machine);
    out["times"] = to_json(result.times, result);
    out["variants"] = std::move(variants);
    return out;
}

void strip_times(nlohmann::ordered_json& result) {
    if (result.is_object()) result.erase("times");
    if (result.is_structured())
        for (auto& part : result) strip_times(part);
}

}  // namespace shadowbench::results

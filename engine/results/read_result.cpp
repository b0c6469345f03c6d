// Reads result.json: the counterpart of report_json.cpp.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/fields.h"
#include "results/report.h"

namespace shadowbench::results {
namespace {

int read_int(const Field& field) {
    const std::uint64_t count = field.count();
    if (count > 0x7fffffff) refuse(field.where, "must be below 2^31");
    return static_cast<int>(count);
}

// Null stands for a value that is not finite.
double error_value(const Field& field) {
    return field.is_null() ? field.number_or_infinity() : field.at_least_zero();
}

// False if the key is missing, as in results of earlier programs and in portable baselines.
bool flag_or_false(const Field& from, const char* key) {
    return from.has(key) && from.at(key).truth();
}

// Earlier programs wrote true or false, by the measured values without intervals: true is read as perhaps.
metrics::OnFront read_front(const Field& field) {
    using metrics::OnFront;
    if (field.value.is_boolean()) return field.truth() ? OnFront::perhaps : OnFront::no;
    for (const OnFront on : {OnFront::no, OnFront::perhaps, OnFront::certainly})
        if (field.text() == to_string(on)) return on;
    refuse(field.where, "must be no, perhaps or certainly");
}

Sample read_sample(const Field& field) {
    Sample sample;
    sample.median = field.at("median").at_least_zero();
    const Field interval = field.at("interval95"), raw = field.at("raw");
    if (interval.array().size() != 2) refuse(interval.where, "must hold two numbers");
    sample.interval = {interval.item(0).at_least_zero(), interval.item(1).at_least_zero()};
    for (std::size_t i = 0; i < raw.array().size(); ++i) sample.raw.push_back(raw.item(i).at_least_zero());
    if (sample.raw.empty()) refuse(raw.where, "must hold at least one time");
    return sample;
}

std::optional<Sample> read_optional_sample(const Field& field) {
    if (field.is_null()) return {};
    return read_sample(field);
}

LookupTimes read_lookup_times(const Field& field) {
    return {read_sample(field.at("ns")), read_optional_sample(field.at("floor_ns")),
            read_optional_sample(field.at("ratio_to_floor"))};
}

std::optional<CellTimes> read_cell_times(const Field& field) {
    if (field.is_null()) return {};
    CellTimes times;
    times.build_ms = read_sample(field.at("build_ms"));
    times.ns_per_segment = field.at("build_ns_per_segment").at_least_zero();
    times.lookups = field.at("lookups_a_pass").count();
    times.image_order = read_lookup_times(field.at("lookup_image_order"));
    times.random_order = read_lookup_times(field.at("lookup_random_order"));
    times.on_front = read_front(field.at("on_time_error_front"));
    return times;
}

metrics::ErrorNorms read_norms(const Field& field) {
    return {error_value(field.at("max")), error_value(field.at("rms")), error_value(field.at("mean")),
            error_value(field.at("p99"))};
}

std::optional<CurveErrors> read_curve_errors(const Field& field) {
    if (field.is_null()) return {};
    CurveErrors errors;
    errors.norms = read_norms(field);
    errors.mean_l1 = error_value(field.at("mean_l1"));
    errors.cells = field.at("cells").count();
    const Field worst = field.at("worst_cell");
    if (worst.array().size() != 2) refuse(worst.where, "must hold two numbers");
    errors.worst_x = read_int(worst.item(0));
    errors.worst_y = read_int(worst.item(1));
    errors.reference_error = field.at("reference_error").at_least_zero();
    if (field.has("rise")) errors.rise = field.at("rise").number_or_infinity();
    if (field.has("lowest")) errors.lowest = field.at("lowest").number_or_infinity();
    return errors;
}

std::optional<LookupErrors> read_lookup_errors(const Field& field) {
    if (field.is_null()) return {};
    LookupErrors errors;
    errors.norms = read_norms(field);
    errors.signed_mean = field.at("signed_mean").number();
    if (field.has("truth_sd")) errors.truth_sd = error_value(field.at("truth_sd"));
    if (!field.has("rms_interval95") || field.at("rms_interval95").is_null()) return errors;
    const Field interval = field.at("rms_interval95"), covers = field.at("rms_interval_covers");
    if (interval.array().size() != 2) refuse(interval.where, "must hold two numbers");
    if (covers.text() != "truth" && covers.text() != "truth and rays")
        refuse(covers.where, "must be \"truth\" or \"truth and rays\"");
    errors.interval = {error_value(interval.item(0)), error_value(interval.item(1)), covers.text() != "truth"};
    return errors;
}

std::vector<SeedErrors> read_seeds(const Field& field) {
    std::vector<SeedErrors> seeds;
    for (std::size_t i = 0; i < field.array().size(); ++i)
        seeds.push_back({read_norms(field.item(i).at("lookup_error")), field.item(i).at("bytes").count()});
    return seeds;
}

FewestNodes read_fewest(const Field& field) {
    FewestNodes over;
    over.cells = field.at("cells").count();
    over.left_out = field.at("left_out").count();
    over.nodes = field.at("nodes").count();
    over.fewest = field.at("fewest").count();
    if (over.fewest == 0) refuse(field.at("fewest").where, "must be above 0");
    const Field interval = field.at("interval95");
    if (interval.array().size() != 2) refuse(interval.where, "must hold two numbers");
    over.interval = {interval.item(0).number(), interval.item(1).number()};
    return over;
}

NodeCounts read_nodes(const Field& field) {
    NodeCounts nodes;
    nodes.cells = field.at("cells").count();
    nodes.total = field.at("total").count();
    nodes.max = static_cast<std::uint32_t>(read_int(field.at("max")));
    if (field.has("over_fewest")) nodes.over_fewest = read_fewest(field.at("over_fewest"));
    if (!field.has("histogram")) return nodes;
    const Field histogram = field.at("histogram");
    for (std::size_t i = 0; i < histogram.array().size(); ++i) nodes.histogram.push_back(histogram.item(i).count());
    return nodes;
}

Verdict read_verdict(const Field& field) {
    for (const Verdict verdict : {Verdict::kept, Verdict::degraded, Verdict::failed})
        if (field.text() == to_string(verdict)) return verdict;
    refuse(field.where, "must be kept, degraded or failed");
}

Cell read_cell(const Field& field) {
    Cell cell;
    cell.technique = field.at("technique").text();
    cell.version = read_int(field.at("version"));
    if (field.has("library")) {
        const Field library = field.at("library");
        cell.library = {library.at("file").text(), library.at("hash").text(), library.at("isolated").truth()};
    }
    cell.parameters_json = field.at("parameters").object().dump();
    cell.parameters = field.at("label").text();
    cell.defaults = flag_or_false(field, "defaults");
    cell.where = field.at("where").text();
    cell.status = field.at("status").text() == "ok" ? CellStatus::ok : CellStatus::failed;
    cell.reason = field.at("reason").text();
    cell.verdict = read_verdict(field.at("verdict"));
    if (field.has("verdict_why")) cell.verdict_why = field.at("verdict_why").text();
    cell.outside_promise = field.at("outside_promise").truth();
    cell.error_bound = field.at("promised_curve_error").number_or_infinity();
    cell.bytes = field.at("bytes").count();
    cell.working_bytes = field.at("working_bytes").count();
    cell.nodes = read_nodes(field.at("nodes"));
    cell.curve = read_curve_errors(field.at("curve_error"));
    cell.lookup = read_lookup_errors(field.at("lookup_error"));
    if (field.has("over_seeds")) cell.over_seeds = read_seeds(field.at("over_seeds"));
    if (field.has("on_bytes_error_front")) cell.on_bytes_front = read_front(field.at("on_bytes_error_front"));
    cell.times = read_cell_times(field.at("times"));
    return cell;
}

MapDescription read_map(const Field& field) {
    MapDescription map;
    map.width = read_int(field.at("width"));
    map.height = read_int(field.at("height"));
    map.samples_x = read_int(field.at("samples_x"));
    map.samples_y = read_int(field.at("samples_y"));
    map.jittered = field.at("pattern").text() == "jittered";
    map.seed = field.at("seed").count();
    map.channels = read_int(field.at("channels"));
    map.media = field.at("media").truth();
    map.z_min = static_cast<float>(field.at("z_min").number());
    map.z_max = static_cast<float>(field.at("z_max").number());
    return map;
}

std::optional<Agreement> read_agreement(const Field& field) {
    if (field.is_null()) return {};
    Agreement agreement;
    agreement.rays = field.at("rays").count();
    agreement.other_crossings = field.at("other_crossings").count();
    agreement.other_transmittance = field.at("other_transmittance").count();
    const Field times = field.at("times");
    agreement.times.capture_rays_per_second = times.at("capture_rays_per_second").at_least_zero();
    agreement.times.tracer_rays_per_second = times.at("embree_rays_per_second").at_least_zero();
    agreement.times.ratio = times.at("ratio").at_least_zero();
    return agreement;
}

void read_capture(const Field& field, LightResult& light) {
    light.agreement = read_agreement(field.at("embree_check"));
    const Field times = field.at("times");
    light.times = {times.at("seconds").at_least_zero(), times.at("setup_seconds").at_least_zero(),
                   times.at("rays_per_second").at_least_zero()};
}

ReferenceReport read_reference(const Field& field) {
    ReferenceReport report;
    report.judged = field.at("judged").count();
    report.samples_per_pixel = read_int(field.at("samples_per_pixel"));
    report.error_rms = error_value(field.at("standard_error").at("rms"));
    report.error_max = error_value(field.at("standard_error").at("max"));
    // Results without it state an upper bound.
    if (const Field error = field.at("standard_error"); error.has("degrees"))
        report.degrees = read_int(error.at("degrees"));
    report.noise_tolerance = field.at("noise_tolerance").at_least_zero();
    if (const Field spread = field.at("spread_over_seeds"); !spread.is_null()) {
        report.spread_rms = error_value(spread.at("rms"));
        report.spread_max = error_value(spread.at("max"));
    }
    return report;
}

TimedPasses read_passes(const Field& field) {
    return {field.at("passes").count(), field.at("interrupted").count(), field.at("involuntary_switches").count()};
}

TimingReport read_timing(const Field& field) {
    TimingReport timing;
    timing.goal = field.at("goal").at_least_zero();
    timing.seconds = field.at("seconds").at_least_zero();
    timing.builds = read_passes(field.at("builds"));
    timing.lookups = read_passes(field.at("lookups"));
    if (const Field steal = field.at("steal_seconds"); !steal.is_null()) timing.steal_seconds = steal.at_least_zero();
    return timing;
}

LightResult read_light(const Field& field, bool deep_image) {
    LightResult light;
    light.deep_image = deep_image;
    light.name = field.at("light").text();
    light.layout = read_map(field.at("map"));
    light.rays = field.at("rays").count();
    light.segments = field.at("segments").count();
    light.ray_bytes = field.at("ray_bytes").count();
    light.kept = field.at("rays_kept").truth();
    light.translucent = field.at("translucent").truth();
    light.receivers = field.at("receivers").count();
    light.dropped = field.at("receivers_outside_map").count();
    if (field.has("capture")) read_capture(field.at("capture"), light);  // missing from portable baselines
    light.reference = read_reference(field.at("reference"));
    if (field.has("times")) light.timing = read_timing(field.at("times"));  // missing from earlier programs' results
    const Field cells = field.at("cells");
    for (std::size_t i = 0; i < cells.array().size(); ++i) light.cells.push_back(read_cell(cells.item(i)));
    return light;
}

VariantResult read_variant(const Field& field, bool deep_image) {
    VariantResult variant;
    for (const auto& [pointer, value] : field.at("settings").object().items())
        variant.settings.push_back({pointer, value.dump()});
    const Field lights = field.at("lights");
    for (std::size_t i = 0; i < lights.array().size(); ++i)
        variant.lights.push_back(read_light(lights.item(i), deep_image));
    return variant;
}

void check_version(const Field& version) {
    if (!version.value.is_number_integer() || version.value != result_schema_version)
        refuse(version.where, fmt::format("schema version {} is not known; this program reads version {}",
                                          version.value.is_number() ? version.value.dump() : "of another type",
                                          result_schema_version));
}

std::string text_in(const Field& field, const char* key) {
    return field.has(key) ? field.at(key).text() : "";
}

// Results of earlier versions have the first two alone.
Machine read_machine(const Field& field) {
    Machine machine;
    machine.cpu = field.at("cpu").text();
    machine.logical_cores = read_int(field.at("logical_cores"));
    machine.microcode = text_in(field, "microcode");
    machine.kernel = text_in(field, "kernel");
    machine.governor = text_in(field, "governor");
    machine.smt = text_in(field, "smt");
    if (field.has("memory")) machine.memory = field.at("memory").count();
    if (field.has("numa_nodes")) machine.numa_nodes = read_int(field.at("numa_nodes"));
    machine.container = text_in(field, "container");
    return machine;
}

}  // namespace

Result from_json(const nlohmann::json& document, const std::string& origin) {
    const Field whole = top(document, origin);
    check_version(whole.at("schema_version"));
    Result result;
    result.name = whole.at("name").text();
    if (whole.has("purpose")) result.purpose = whole.at("purpose").text();
    const auto read_lines = [&](const char* key, std::vector<std::string>& lines) {
        if (!whole.has(key)) return;
        for (std::size_t i = 0; i < whole.at(key).array().size(); ++i) lines.push_back(whole.at(key).item(i).text());
    };
    read_lines("notes", result.notes);
    read_lines("files", result.files);
    result.hash = whole.at("scenario_hash").text();
    const nlohmann::json& scenario = whole.at("scenario").object();
    result.document = scenario.dump();
    const Field only = whole.at("only"), program = whole.at("program"), machine = whole.at("machine"),
                times = whole.at("times"), variants = whole.at("variants");
    for (std::size_t i = 0; i < only.array().size(); ++i) result.only.push_back(only.item(i).text());
    result.program = {program.at("version").text(), program.at("commit").text(), program.at("compiler").text(),
                      program.at("build_type").text()};
    result.machine = read_machine(machine);
    result.times.started = times.at("started").text();
    if (times.has("seconds")) result.times.seconds = times.at("seconds").at_least_zero();
    if (times.has("threads")) result.times.threads = read_int(times.at("threads"));
    if (times.has("load")) result.times.load = times.at("load").at_least_zero();
    result.times.slurm_job = text_in(times, "slurm_job");
    result.times.slurm_node = text_in(times, "slurm_node");
    const bool deep_image = scenario.contains("/scene/deep_image"_json_pointer);
    for (std::size_t i = 0; i < variants.array().size(); ++i)
        result.variants.push_back(read_variant(variants.item(i), deep_image));
    return result;
}

}  // namespace shadowbench::results

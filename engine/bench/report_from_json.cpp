// Mirrors report_json.cpp.
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/report.h"

namespace shadowbench::bench {
namespace {

using json = nlohmann::ordered_json;
using base::Error;
using base::ErrorCode;

// A part of the result and where it stands.
class Part {
public:
    Part(const json& value, std::string where) : value_(value), where_(std::move(where)) {}

    Part operator[](const char* key) const {
        const auto found = value_.is_object() ? value_.find(key) : value_.end();
        if (found == value_.end()) throw Error(ErrorCode::bad_input, where_ + "/" + key, "is missing in this result");
        return {*found, where_ + "/" + key};
    }
    template <class Visit>
    void for_each(const Visit& visit) const {
        if (!value_.is_array()) refuse("an array");
        for (std::size_t i = 0; i < value_.size(); ++i) visit(Part(value_[i], fmt::format("{}/{}", where_, i)));
    }
    template <class T>
    T get() const {
        try {
            return value_.get<T>();
        } catch (const json::exception&) {
            refuse("of another type");
        }
    }
    template <class T>
    void read(const char* key, T& to) const {
        to = (*this)[key].get<T>();
    }
    bool null() const { return value_.is_null(); }
    const json& value() const { return value_; }
    // What does not exist as a JSON number was written as null.
    double number() const { return null() ? std::numeric_limits<double>::infinity() : get<double>(); }
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(ErrorCode::bad_input, where_.empty() ? "/" : where_, "not what a result has here: " + what);
    }

private:
    const json& value_;
    std::string where_;
};

Sample read_sample(const Part& part) {
    Sample sample;
    part.read("median", sample.median);
    const auto interval = part["interval95"].get<std::vector<double>>();
    if (interval.size() != 2) part["interval95"].refuse("two numbers");
    sample.interval = {interval[0], interval[1]};
    part.read("raw", sample.raw);
    return sample;
}

std::optional<Sample> read_optional_sample(const Part& part) {
    if (part.null()) return {};
    return read_sample(part);
}

LookupTimes read_lookup_times(const Part& part) {
    return {read_sample(part["ns"]), read_optional_sample(part["floor_ns"]),
            read_optional_sample(part["ratio_to_floor"])};
}

std::optional<CellTimes> read_cell_times(const Part& part) {
    if (part.null()) return {};
    CellTimes times;
    times.build_ms = read_sample(part["build_ms"]);
    part.read("build_ns_per_segment", times.ns_per_segment);
    part.read("lookups_a_pass", times.lookups);
    times.image_order = read_lookup_times(part["lookup_image_order"]);
    times.random_order = read_lookup_times(part["lookup_random_order"]);
    part.read("on_time_error_front", times.on_front);
    return times;
}

metrics::ErrorNorms read_norms(const Part& part) {
    return {part["max"].number(), part["rms"].number(), part["mean"].number(), part["p99"].number()};
}

std::optional<CurveErrors> read_curve_errors(const Part& part) {
    if (part.null()) return {};
    CurveErrors errors;
    errors.norms = read_norms(part);
    errors.mean_l1 = part["mean_l1"].number();
    part.read("cells", errors.cells);
    const auto worst = part["worst_cell"].get<std::vector<int>>();
    if (worst.size() != 2) part["worst_cell"].refuse("two numbers");
    errors.worst_x = worst[0];
    errors.worst_y = worst[1];
    part.read("reference_error", errors.reference_error);
    return errors;
}

std::optional<LookupErrors> read_lookup_errors(const Part& part) {
    if (part.null()) return {};
    return LookupErrors{read_norms(part), part["signed_mean"].number()};
}

// Of the row that made the cell, if it is still there.
techniques::Promises promises_of(const Cell& cell, const json& parameters) {
    for (const techniques::Technique& row : techniques::all())
        if (cell.technique == row.id) {
            try {
                return techniques::promises(row, techniques::read_parameters(row.parameters, parameters, ""));
            } catch (const Error&) {  // parameters of another version
                return row.promises;
            }
        }
    return {};
}

Cell read_cell(const Part& part) {
    Cell cell;
    part.read("technique", cell.technique);
    part.read("version", cell.version);
    if (!part["parameters"].value().is_object()) part["parameters"].refuse("an object");
    cell.parameters_json = part["parameters"].value().dump();
    cell.promises = promises_of(cell, part["parameters"].value());
    part.read("label", cell.parameters);
    part.read("where", cell.where);
    cell.status = part["status"].get<std::string>() == "ok" ? CellStatus::ok : CellStatus::failed;
    part.read("reason", cell.reason);
    part.read("outside_promise", cell.outside_promise);
    cell.error_bound = part["promised_curve_error"].number();
    part.read("bytes", cell.bytes);
    part.read("working_bytes", cell.working_bytes);
    const Part nodes = part["nodes"];
    nodes.read("cells", cell.nodes.cells);
    nodes.read("total", cell.nodes.total);
    nodes.read("max", cell.nodes.max);
    nodes.read("histogram", cell.nodes.histogram);
    cell.curve = read_curve_errors(part["curve_error"]);
    cell.lookup = read_lookup_errors(part["lookup_error"]);
    part.read("on_bytes_error_front", cell.on_bytes_front);
    cell.times = read_cell_times(part["times"]);
    return cell;
}

rays::MapLayout read_layout(const Part& part) {
    rays::MapLayout layout;
    part.read("width", layout.width);
    part.read("height", layout.height);
    part.read("samples_x", layout.samples_x);
    part.read("samples_y", layout.samples_y);
    layout.jittered = part["pattern"].get<std::string>() == "jittered";
    part.read("seed", layout.seed);
    part.read("channels", layout.channels);
    part.read("media", layout.media);
    part.read("z_min", layout.z_min);
    part.read("z_max", layout.z_max);
    return layout;
}

std::optional<Agreement> read_agreement(const Part& part) {
    if (part.null()) return {};
    Agreement agreement;
    part.read("rays", agreement.rays);
    part.read("other_crossings", agreement.other_crossings);
    part.read("other_transmittance", agreement.other_transmittance);
    const Part times = part["times"];
    times.read("capture_rays_per_second", agreement.times.capture_rays_per_second);
    times.read("embree_rays_per_second", agreement.times.tracer_rays_per_second);
    times.read("ratio", agreement.times.ratio);
    return agreement;
}

ReferenceReport read_reference(const Part& part) {
    ReferenceReport report;
    part.read("judged", report.judged);
    part.read("samples_per_pixel", report.samples_per_pixel);
    report.error_rms = part["standard_error"]["rms"].number();
    report.error_max = part["standard_error"]["max"].number();
    part.read("noise_tolerance", report.noise_tolerance);
    if (const Part spread = part["spread_over_seeds"]; !spread.null()) {
        report.spread_rms = spread["rms"].number();
        report.spread_max = spread["max"].number();
    }
    return report;
}

LightResult read_light(const Part& part, bool deep_image) {
    LightResult light;
    light.deep_image = deep_image;
    part.read("light", light.name);
    light.layout = read_layout(part["map"]);
    part.read("rays", light.rays);
    part.read("segments", light.segments);
    part.read("ray_bytes", light.ray_bytes);
    part.read("rays_kept", light.kept);
    part.read("translucent", light.translucent);
    part.read("receivers", light.receivers);
    part.read("receivers_outside_map", light.dropped);
    light.agreement = read_agreement(part["capture"]["embree_check"]);
    const Part times = part["capture"]["times"];
    times.read("seconds", light.times.seconds);
    times.read("setup_seconds", light.times.setup_seconds);
    times.read("rays_per_second", light.times.rays_per_second);
    light.reference = read_reference(part["reference"]);
    part["cells"].for_each([&](const Part& cell) { light.cells.push_back(read_cell(cell)); });
    return light;
}

VariantResult read_variant(const Part& part, bool deep_image) {
    VariantResult variant;
    if (!part["settings"].value().is_object()) part["settings"].refuse("an object");
    for (const auto& [pointer, value] : part["settings"].value().items())
        variant.settings.push_back({pointer, value.dump()});
    part["lights"].for_each([&](const Part& light) { variant.lights.push_back(read_light(light, deep_image)); });
    return variant;
}

}  // namespace

Result from_json(const nlohmann::ordered_json& document) {
    const Part part(document, "");
    if (part["schema_version"].get<int>() != result_schema_version)
        part["schema_version"].refuse(fmt::format("version {} is read here", result_schema_version));
    Result result;
    part.read("name", result.name);
    part.read("purpose", result.purpose);
    part.read("scenario_hash", result.hash);
    const json& scenario = part["scenario"].value();
    result.document = scenario.dump();
    part.read("only", result.only);
    part["machine"].read("cpu", result.machine.cpu);
    part["machine"].read("logical_cores", result.machine.logical_cores);
    const Part times = part["times"];
    times.read("started", result.times.started);
    times.read("seconds", result.times.seconds);
    times.read("threads", result.times.threads);
    const bool deep_image = scenario.contains("/scene/deep_image"_json_pointer);
    part["variants"].for_each(
        [&](const Part& variant) { result.variants.push_back(read_variant(variant, deep_image)); });
    return result;
}

}  // namespace shadowbench::bench

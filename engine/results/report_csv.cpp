#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "results/merge_cells.h"
#include "results/report.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

struct Row {
    const Result& result;
    const VariantResult& variant;
    const LightResult& light;
    const Settling& floors;  // of the light
    const Cell& cell;
    const std::string& machine;  // that measured the light
};

std::string settings_text(const VariantResult& variant) {
    std::string text;
    for (const document::Setting& setting : variant.settings)
        text += (text.empty() ? "" : " ") + setting.pointer + "=" + setting.value;
    return text;
}

std::string from_times(const Row& row, double (*read)(const CellTimes&)) {
    return row.cell.times ? csv_number(read(*row.cell.times)) : std::string();
}

std::string from_curve(const Row& row, double (*read)(const CurveErrors&)) {
    return row.cell.curve ? csv_number(read(*row.cell.curve)) : std::string();
}

std::string from_lookup(const Row& row, double (*read)(const LookupErrors&)) {
    return row.cell.lookup ? csv_number(read(*row.cell.lookup)) : std::string();
}

std::string settled_text(const Row& row, const Sample& (*read)(const CellTimes&)) {
    if (!row.cell.times) return "";
    const std::optional<bool> settled = is_settled(read(*row.cell.times), row.light);
    return !settled ? "" : *settled ? "1" : "0";
}

struct Column {
    const char* name;
    std::string (*value)(const Row&);
};

constexpr double none = std::numeric_limits<double>::quiet_NaN();

const Column columns[] = {
    {"scenario", [](const Row& r) { return r.result.name; }},
    {"scenario_hash", [](const Row& r) { return r.result.hash; }},
    {"settings", [](const Row& r) { return settings_text(r.variant); }},
    {"light", [](const Row& r) { return r.light.name; }},
    {"machine", [](const Row& r) { return r.machine; }},
    {"width", [](const Row& r) { return fmt::format("{}", r.light.layout.width); }},
    {"height", [](const Row& r) { return fmt::format("{}", r.light.layout.height); }},
    {"samples_per_pixel", [](const Row& r) { return fmt::format("{}", r.light.layout.samples()); }},
    {"rays", [](const Row& r) { return fmt::format("{}", r.light.rays); }},
    {"segments", [](const Row& r) { return fmt::format("{}", r.light.segments); }},
    {"technique", [](const Row& r) { return r.cell.technique; }},
    {"version", [](const Row& r) { return fmt::format("{}", r.cell.version); }},
    {"parameters", [](const Row& r) { return r.cell.parameters; }},
    {"status", [](const Row& r) { return std::string(r.cell.status == CellStatus::ok ? "ok" : "failed"); }},
    {"reason", [](const Row& r) { return r.cell.reason; }},
    {"outside_promise", [](const Row& r) { return std::string(r.cell.outside_promise ? "1" : "0"); }},
    {"build_ms", [](const Row& r) { return from_times(r, [](const CellTimes& t) { return t.build_ms.median; }); }},
    {"build_ns_per_segment",
     [](const Row& r) { return from_times(r, [](const CellTimes& t) { return t.ns_per_segment; }); }},
    {"lookup_image_ns",
     [](const Row& r) { return from_times(r, [](const CellTimes& t) { return t.image_order.ns.median; }); }},
    {"lookup_image_ratio",
     [](const Row& r) {
         return from_times(r,
                           [](const CellTimes& t) { return t.image_order.ratio ? t.image_order.ratio->median : none; });
     }},
    {"lookup_random_ns",
     [](const Row& r) { return from_times(r, [](const CellTimes& t) { return t.random_order.ns.median; }); }},
    {"lookup_random_ratio",
     [](const Row& r) {
         return from_times(
             r, [](const CellTimes& t) { return t.random_order.ratio ? t.random_order.ratio->median : none; });
     }},
    {"bytes", [](const Row& r) { return fmt::format("{}", r.cell.bytes); }},
    {"working_bytes", [](const Row& r) { return fmt::format("{}", r.cell.working_bytes); }},
    {"nodes_total", [](const Row& r) { return fmt::format("{}", r.cell.nodes.total); }},
    {"nodes_mean", [](const Row& r) { return csv_number(r.cell.nodes.mean()); }},
    {"nodes_max", [](const Row& r) { return fmt::format("{}", r.cell.nodes.max); }},
    {"curve_error_max", [](const Row& r) { return from_curve(r, [](const CurveErrors& e) { return e.norms.max; }); }},
    {"curve_error_rms", [](const Row& r) { return from_curve(r, [](const CurveErrors& e) { return e.norms.rms; }); }},
    {"curve_error_mean", [](const Row& r) { return from_curve(r, [](const CurveErrors& e) { return e.norms.mean; }); }},
    {"curve_error_p99", [](const Row& r) { return from_curve(r, [](const CurveErrors& e) { return e.norms.p99; }); }},
    {"lookup_error_max",
     [](const Row& r) { return from_lookup(r, [](const LookupErrors& e) { return e.norms.max; }); }},
    {"lookup_error_rms",
     [](const Row& r) { return from_lookup(r, [](const LookupErrors& e) { return e.norms.rms; }); }},
    {"lookup_error_mean",
     [](const Row& r) { return from_lookup(r, [](const LookupErrors& e) { return e.norms.mean; }); }},
    {"lookup_error_p99",
     [](const Row& r) { return from_lookup(r, [](const LookupErrors& e) { return e.norms.p99; }); }},
    {"lookup_error_signed_mean",
     [](const Row& r) { return from_lookup(r, [](const LookupErrors& e) { return e.signed_mean; }); }},
    {"lookup_error_rms_low",
     [](const Row& r) {
         return from_lookup(r, [](const LookupErrors& e) { return e.interval ? e.interval->low : none; });
     }},
    {"lookup_error_rms_high",
     [](const Row& r) {
         return from_lookup(r, [](const LookupErrors& e) { return e.interval ? e.interval->high : none; });
     }},
    {"lookup_error_rms_interval_covers",
     [](const Row& r) {
         if (!r.cell.lookup || !r.cell.lookup->interval) return std::string();
         return std::string(r.cell.lookup->interval->covers_rays ? "truth and rays" : "truth");
     }},
    {"on_time_error_front",
     [](const Row& r) { return std::string(to_string(r.cell.times ? r.cell.times->on_front : metrics::OnFront::no)); }},
    {"on_bytes_error_front", [](const Row& r) { return std::string(to_string(r.cell.on_bytes_front)); }},
    {"verdict", [](const Row& r) { return std::string(to_string(r.cell.verdict)); }},
    {"verdict_why", [](const Row& r) { return r.cell.verdict_why; }},
    {"settled", [](const Row& r) { return std::string(!r.floors.known()    ? ""
                                                      : r.floors.settled() ? "1"
                                                                           : "0"); }},
    {"build_settled",
     [](const Row& r) { return settled_text(r, [](const CellTimes& t) -> const Sample& { return t.build_ms; }); }},
    {"lookup_image_settled",
     [](const Row& r) {
         return settled_text(r, [](const CellTimes& t) -> const Sample& { return t.image_order.ns; });
     }},
    {"lookup_random_settled",
     [](const Row& r) {
         return settled_text(r, [](const CellTimes& t) -> const Sample& { return t.random_order.ns; });
     }},
};

// RFC 4180: a field with a comma, a quote or a line break is put in quotes, and its own quotes are doubled.
std::string quoted(const std::string& field) {
    if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
    std::string text = "\"";
    for (const char c : field) {
        if (c == '"') text += '"';
        text += c;
    }
    return text + '"';
}

// `machine_of` gives the machine of a light, by its number in the whole result.
template <class MachineOf>
std::string csv_text(const Result& result, const MachineOf& machine_of) {
    std::string text;
    for (const Column& column : columns) text += (text.empty() ? "" : ",") + std::string(column.name);
    text += "\n";
    std::size_t lights = 0;
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights) {
            const Settling floors = settling(light);
            const std::string machine = machine_of(lights++);
            for (const Cell& cell : light.cells) {
                std::string line;
                for (const Column& column : columns)
                    line += (&column == columns ? "" : ",") +
                            quoted(column.value({result, variant, light, floors, cell, machine}));
                text += line + "\n";
            }
        }
    return text;
}

}  // namespace

std::string to_csv(const Result& result) {
    return csv_text(result, [&](std::size_t) { return machine_text(result.machine); });
}

std::string to_csv(const Merged& merged) {
    return csv_text(merged.result, [&](std::size_t light) { return merged.origins.at(light).machine; });
}

}  // namespace shadowbench::results

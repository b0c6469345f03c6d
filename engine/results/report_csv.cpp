#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/merge_cells.h"
#include "results/report.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

// One value that a cell has.
struct Measure {
    const char* name;
    const char* unit;
    double value;
    std::optional<metrics::Interval> interval = {};
    const char* covers = "";          // what the interval covers
    std::optional<bool> narrow = {};  // of a time: whether its interval is as narrow as timing.goal
};

struct Row {
    const Result& result;
    const VariantResult& variant;
    const LightResult& light;
    const Settling& floors;  // of the light
    const Cell& cell;
    const std::string& machine;  // that measured the light
    const Measure* measure;      // null: a cell without any
};

std::string settings_text(const VariantResult& variant) {
    std::string text;
    for (const document::Setting& setting : variant.settings)
        text += (text.empty() ? "" : " ") + setting.pointer + "=" + setting.value;
    return text;
}

std::string truth_text(const std::optional<bool>& truth) {
    return !truth ? "" : *truth ? "1" : "0";
}

struct Column {
    const char* name;
    std::string (*value)(const Row&);
};

// results/README.md says what each is.
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
    {"library", [](const Row& r) { return r.cell.library ? r.cell.library->hash : std::string(); }},
    {"parameters", [](const Row& r) { return r.cell.parameters; }},
    {"status", [](const Row& r) { return std::string(r.cell.status == CellStatus::ok ? "ok" : "failed"); }},
    {"reason", [](const Row& r) { return r.cell.reason; }},
    {"outside_promise", [](const Row& r) { return truth_text(r.cell.outside_promise); }},
    {"verdict", [](const Row& r) { return std::string(to_string(r.cell.verdict)); }},
    {"verdict_why", [](const Row& r) { return r.cell.verdict_why; }},
    {"on_time_error_front",
     [](const Row& r) { return std::string(to_string(r.cell.times ? r.cell.times->on_front : metrics::OnFront::no)); }},
    {"on_bytes_error_front", [](const Row& r) { return std::string(to_string(r.cell.on_bytes_front)); }},
    {"quiet",
     [](const Row& r) { return truth_text(r.floors.known() ? std::optional(r.floors.settled()) : std::nullopt); }},
    {"measure", [](const Row& r) { return std::string(r.measure ? r.measure->name : ""); }},
    {"unit", [](const Row& r) { return std::string(r.measure ? r.measure->unit : ""); }},
    {"value", [](const Row& r) { return r.measure ? csv_number(r.measure->value) : std::string(); }},
    {"low",
     [](const Row& r) {
         return r.measure && r.measure->interval ? csv_number(r.measure->interval->low) : std::string();
     }},
    {"high",
     [](const Row& r) {
         return r.measure && r.measure->interval ? csv_number(r.measure->interval->high) : std::string();
     }},
    {"interval_covers", [](const Row& r) { return std::string(r.measure ? r.measure->covers : ""); }},
    {"narrow", [](const Row& r) { return r.measure ? truth_text(r.measure->narrow) : std::string(); }},
};

// The measures of one cell.
class Measures {
public:
    Measures(const Cell& cell, const LightResult& light) : light_(light) {
        if (cell.times) add_times(*cell.times);
        if (cell.status == CellStatus::ok) add_sizes(cell);
        if (cell.curve) {
            add_norms({"curve_error_max", "curve_error_rms", "curve_error_mean", "curve_error_p99"}, cell.curve->norms);
            add({"curve_error_l1", "visibility x length", cell.curve->mean_l1});
        }
        if (cell.lookup) add_lookup(*cell.lookup);
    }
    const std::vector<Measure>& list() const { return list_; }

private:
    void add(const Measure& measure) {
        if (std::isfinite(measure.value)) list_.push_back(measure);
    }
    void add_sample(const char* name, const char* unit, const Sample& sample, bool is_time) {
        const std::optional<bool> narrow = is_time ? is_settled(sample, light_) : std::nullopt;
        add({name, unit, sample.median, sample.interval, "repetitions", narrow});
    }
    void add_order(const std::array<const char*, 3>& names, const LookupTimes& times) {
        add_sample(names[0], "ns", times.ns, true);
        if (times.floor) add_sample(names[1], "ns", *times.floor, false);
        if (times.ratio) add_sample(names[2], "1", *times.ratio, false);
    }
    void add_times(const CellTimes& times) {
        add_sample("build_ms", "ms", times.build_ms, true);
        add({"build_ns_per_segment", "ns", times.ns_per_segment});
        add_order({"lookup_image_ns", "lookup_image_floor_ns", "lookup_image_ratio"}, times.image_order);
        add_order({"lookup_random_ns", "lookup_random_floor_ns", "lookup_random_ratio"}, times.random_order);
    }
    void add_sizes(const Cell& cell) {
        add({"bytes", "bytes", static_cast<double>(cell.bytes)});
        add({"working_bytes", "bytes", static_cast<double>(cell.working_bytes)});
        add({"nodes_total", "nodes", static_cast<double>(cell.nodes.total)});
        add({"nodes_mean", "nodes", cell.nodes.mean()});
        add({"nodes_max", "nodes", static_cast<double>(cell.nodes.max)});
        if (const auto& over = cell.nodes.over_fewest)
            add({"nodes_over_fewest", "1", over->ratio(), over->interval, "cells"});
    }
    void add_norms(const std::array<const char*, 4>& names, const metrics::ErrorNorms& norms,
                   const Measure& interval_of_rms = {}) {
        add({names[0], "visibility", norms.max});
        add({names[1], "visibility", norms.rms, interval_of_rms.interval, interval_of_rms.covers});
        add({names[2], "visibility", norms.mean});
        add({names[3], "visibility", norms.p99});
    }
    void add_lookup(const LookupErrors& errors) {
        Measure rms{"", "", 0.0};
        if (errors.interval) {
            rms.interval = metrics::Interval{errors.interval->low, errors.interval->high};
            rms.covers = errors.interval->covers_rays ? "truth and rays" : "truth";
        }
        add_norms({"lookup_error_max", "lookup_error_rms", "lookup_error_mean", "lookup_error_p99"}, errors.norms, rms);
        add({"lookup_error_signed_mean", "visibility", errors.signed_mean});
    }

    const LightResult& light_;
    std::vector<Measure> list_;
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

std::string line_of(const Row& row) {
    std::string line;
    for (const Column& column : columns) line += (&column == columns ? "" : ",") + quoted(column.value(row));
    return line + "\n";
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
                const Measures measures(cell, light);
                for (const Measure& measure : measures.list())
                    text += line_of({result, variant, light, floors, cell, machine, &measure});
                if (measures.list().empty()) text += line_of({result, variant, light, floors, cell, machine, nullptr});
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

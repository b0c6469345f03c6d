#include "compare/read_result.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace shadowbench::compare {
namespace {

using nlohmann::json;

constexpr int known_version = 1;
constexpr double infinite = std::numeric_limits<double>::infinity();

void check_version(const Field& version) {
    if (!version.value.is_number_integer() || version.value != known_version)
        refuse(version.where,
               fmt::format("schema version {} is not known; this program reads version {}",
                           version.value.is_number() ? version.value.dump() : "of another type", known_version));
}

double at_least_zero(const Field& field) {
    const double value = field.number();
    if (value < 0.0) refuse(field.where, "must not be negative");
    return value;
}

// Null stands for what is not finite.
double error_value(const Field& field) {
    return field.is_null() ? infinite : at_least_zero(field);
}

void add_errors(Cell& cell, const Field& from, const char* name) {
    const Field errors = from.at(name);
    if (errors.is_null()) return;
    for (const char* norm : {"max", "rms", "mean", "p99"})
        cell.exact.push_back({fmt::format("{}.{}", name, norm), Kind::error, error_value(errors.at(norm))});
}

std::vector<double> samples(const Field& sample) {
    const Field raw = sample.at("raw");
    std::vector<double> values;
    for (std::size_t i = 0; i < raw.array().size(); ++i) values.push_back(at_least_zero(raw.item(i)));
    if (values.empty()) refuse(raw.where, "holds no time");
    return values;
}

void add_times(Cell& cell, const Field& times) {
    if (times.is_null()) return;
    cell.timed.push_back({"build", "ms", {{samples(times.at("build_ms")), {}}}});
    for (const char* order : {"image", "random"}) {
        const Field lookup = times.at(fmt::format("lookup_{}_order", order).c_str());
        Process process{samples(lookup.at("ns")), {}};
        if (const Field ratio = lookup.at("ratio_to_floor"); !ratio.is_null()) process.ratio = samples(ratio);
        cell.timed.push_back({fmt::format("lookup_{}", order), "ns", {std::move(process)}});
    }
}

std::string value_text(const json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string settings_text(const Field& settings) {
    std::string text;
    for (const auto& [pointer, value] : settings.object().items()) {
        std::string name = pointer.substr(pointer.rfind('/', 0) == 0 ? 1 : 0);
        std::replace(name.begin(), name.end(), '/', '.');
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value_text(value));
    }
    return text;
}

// The technique as the scenario has it, with what sweeps set; null where the file does not tell.
json technique_of(const json& scenario, const Field& cell) {
    const std::string& where = cell.at("where").text();
    const json& parameters = cell.at("parameters").object();
    json technique;
    try {
        technique = scenario.at(json::json_pointer(where));
        if (!technique.is_object()) return nullptr;
        if (const auto sweeps = scenario.find("sweeps"); sweeps != scenario.end() && sweeps->is_object())
            for (const auto& [pointer, values] : sweeps->items())
                if (pointer.rfind(where + "/", 0) == 0) {
                    const std::string name = pointer.substr(where.size() + 1);
                    technique[name] = parameters.at(name);
                }
    } catch (const json::exception&) {
        return nullptr;
    }
    return technique;
}

void add_speed(Suite& suite, const Field& check) {
    if (check.is_null() || !suite.speed.empty()) return;  // the first light's
    const double rate = at_least_zero(check.at("times").at("embree_rays_per_second"));
    if (rate > 0.0) suite.speed.push_back(rate);
}

// Names of the technique's parameters that the scenario's sweeps set, in the order of the sweeps.
std::vector<std::string> swept_of(const json& scenario, const std::string& where, const json& parameters) {
    std::vector<std::string> names;
    const auto sweeps = scenario.find("sweeps");
    if (sweeps == scenario.end() || !sweeps->is_object()) return names;
    for (const auto& [pointer, values] : sweeps->items())
        if (pointer.rfind(where + "/", 0) == 0)
            if (std::string name = pointer.substr(where.size() + 1); name != "type" && parameters.contains(name))
                names.push_back(std::move(name));
    return names;
}

// A label names what sweeps set first, then what differs from the defaults. Labels of older results left out a swept
// value that is the default, and had the others in their places: brought into the form of today, so that a cell has the
// same name whichever program wrote it.
std::string name_of(const std::string& technique, const std::string& label, const std::vector<std::string>& swept,
                    const json& parameters) {
    std::string name = technique, rest;
    const auto is_swept = [&](const std::string& word) {
        return std::any_of(swept.begin(), swept.end(), [&](const std::string& s) { return word.starts_with(s + "="); });
    };
    for (const std::string& one : swept) {
        const json& value = parameters.at(one);
        name += fmt::format(" {}={}", one,
                            value.is_number() ? fmt::format("{:g}", value.get<double>()) : value_text(value));
    }
    for (std::size_t first = 0; first < label.size();) {
        const std::size_t space = std::min(label.find(' ', first), label.size());
        if (const std::string word = label.substr(first, space - first); !is_swept(word)) rest += " " + word;
        first = space + 1;
    }
    return name + rest;
}

Cell read_cell(const Field& from, const json& scenario, const Field& settings, const std::string& source) {
    Cell cell;
    const std::string& technique = from.at("technique").text();
    const std::string& label = from.at("label").text();
    const json& parameters = from.at("parameters").object();
    const std::vector<std::string> swept = swept_of(scenario, from.at("where").text(), parameters);
    cell.name = name_of(technique, label, swept, parameters);
    cell.version = fmt::format("{:g}", from.at("version").number());
    cell.failed = from.at("status").text() != "ok";
    cell.degraded = from.at("verdict").text() == "degraded";
    cell.failure = from.at("reason").text();
    const Field nodes = from.at("nodes");
    cell.exact = {{"bytes", Kind::size, at_least_zero(from.at("bytes"))},
                  {"working_bytes", Kind::size, at_least_zero(from.at("working_bytes"))},
                  {"nodes.total", Kind::size, at_least_zero(nodes.at("total"))},
                  {"nodes.max", Kind::size, at_least_zero(nodes.at("max"))}};
    add_errors(cell, from, "curve_error");
    add_errors(cell, from, "lookup_error");
    add_times(cell, from.at("times"));

    cell.rerun.source = source;
    cell.rerun.only = technique;
    const json alone = technique_of(scenario, from);
    if (alone.is_null()) return cell;
    cell.rerun.technique = alone.dump();
    json sweeps = json::object();
    for (const auto& [pointer, value] : settings.object().items()) sweeps[pointer] = json::array({value});
    if (scenario.contains("sweeps")) cell.rerun.sweeps = sweeps.dump();
    return cell;
}

}  // namespace

Suite read_result(const Field& result, const std::string& origin) {
    check_version(result.at("schema_version"));
    Suite suite;
    suite.results = 1;
    suite.name = result.at("name").text();
    suite.hash = result.at("scenario_hash").text();
    const Field machine = result.at("machine"), program = result.at("program"), only = result.at("only");
    suite.machine = fmt::format("{}, {:g} cores", machine.at("cpu").text(), at_least_zero(machine.at("logical_cores")));
    suite.commit = program.at("commit").text();
    suite.program = fmt::format("{} ({}, {}, {})", program.at("version").text(), program.at("commit").text(),
                                program.at("compiler").text(), program.at("build_type").text());
    for (std::size_t i = 0; i < only.array().size(); ++i) suite.only += (i ? " " : "") + only.item(i).text();
    suite.started = result.at("times").at("started").text();

    const json& scenario = result.at("scenario").object();
    const std::string source = origin.empty() ? suite.name : origin;
    std::map<std::string, int> seen;
    const Field variants = result.at("variants");
    for (std::size_t v = 0; v < variants.array().size(); ++v) {
        const Field settings = variants.item(v).at("settings"), lights = variants.item(v).at("lights");
        const std::string variant = settings_text(settings);
        for (std::size_t l = 0; l < lights.array().size(); ++l) {
            const Field light = lights.item(l), cells = light.at("cells");
            const std::string group = (variant.empty() ? "" : variant + " / ") + light.at("light").text();
            if (light.has("capture"))  // not in a baseline that holds on any machine
                add_speed(suite, light.at("capture").at("embree_check"));
            if (suite.seed.empty()) suite.seed = fmt::format("{:.17g}", light.at("map").at("seed").number());
            for (std::size_t c = 0; c < cells.array().size(); ++c) {
                Cell cell = read_cell(cells.item(c), scenario, settings, source);
                cell.group = group;
                // Equal techniques of one scenario are told apart by their order.
                const int earlier = seen[group + '\n' + cell.name]++;
                if (earlier > 0) cell.name += fmt::format(" #{}", earlier + 1);
                suite.cells.push_back(std::move(cell));
            }
        }
    }
    return suite;
}

}  // namespace shadowbench::compare

#include "compare/read_result.h"

#include <algorithm>
#include <map>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/table.h"
#include "results/merge_cells.h"
#include "results/report.h"

namespace shadowbench::compare {
namespace {

using nlohmann::json;

void add_errors(Cell& cell, const char* name, const metrics::ErrorNorms& norms) {
    const auto add = [&](const char* norm, double value) {
        cell.exact.push_back({fmt::format("{}.{}", name, norm), Kind::error, value});
    };
    add("max", norms.max);
    add("rms", norms.rms);
    add("mean", norms.mean);
    add("p99", norms.p99);
}

Timed lookup_times(const char* name, const results::LookupTimes& times) {
    return {name, "ns", {{times.ns.raw, times.ratio ? times.ratio->raw : std::vector<double>{}}}};
}

void add_times(Cell& cell, const results::CellTimes& times) {
    cell.timed.push_back({"build", "ms", {{times.build_ms.raw, {}}}});
    cell.timed.push_back(lookup_times("lookup_image", times.image_order));
    cell.timed.push_back(lookup_times("lookup_random", times.random_order));
}

std::string value_text(const std::string& text) {
    const json value = json::parse(text);
    return value.is_string() ? value.get<std::string>() : text;
}

std::string settings_text(const std::vector<document::Setting>& settings) {
    std::string text;
    for (const document::Setting& setting : settings) {
        std::string name = setting.pointer.substr(setting.pointer.rfind('/', 0) == 0 ? 1 : 0);
        std::replace(name.begin(), name.end(), '/', '.');
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value_text(setting.value));
    }
    return text;
}

// The technique as in the scenario, with the swept values; null if the file does not hold it.
json technique_of(const json& scenario, const results::Cell& cell) {
    const json parameters = json::parse(cell.parameters_json);
    json technique;
    try {
        technique = scenario.at(json::json_pointer(cell.where));
        if (!technique.is_object()) return nullptr;
        if (technique.value("type", "") == "*") return json{{"type", cell.technique}};  // its defaults
        if (const auto sweeps = scenario.find("sweeps"); sweeps != scenario.end() && sweeps->is_object())
            for (const auto& [pointer, values] : sweeps->items())
                if (pointer.rfind(cell.where + "/", 0) == 0) {
                    const std::string name = pointer.substr(cell.where.size() + 1);
                    technique[name] = parameters.at(name);
                }
    } catch (const json::exception&) {
        return nullptr;
    }
    return technique;
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

// Names of the parameters that the scenario's technique writes and in which cells of that technique differ.
// `parameters` are those of all cells of its light, in their order.
std::vector<std::string> differing_in(const json& scenario, std::span<const results::Cell> cells, std::size_t at,
                                      std::span<const json> parameters) {
    const results::Cell& cell = cells[at];
    std::vector<std::string> names;
    const json technique = technique_of(scenario, cell);
    if (!technique.is_object()) return names;
    for (const auto& [name, value] : technique.items()) {
        if (name == "type" || !parameters[at].contains(name)) continue;
        bool differs = false;
        for (std::size_t i = 0; i < cells.size() && !differs; ++i)
            differs = cells[i].technique == cell.technique &&
                      (!parameters[i].contains(name) || parameters[i].at(name) != parameters[at].at(name));
        if (differs) names.push_back(name);
    }
    return names;
}

// "nodes=8": a parameter and its value.
std::string word_of(const std::string& name, const json& value) {
    return fmt::format("{}={}", name,
                       value.is_number() ? base::number_text(value.get<double>()) : value_text(value.dump()));
}

// A label names the parameters that sweeps set, those that differ from the defaults, and those that tell the rows of a
// technique apart. Labels of older results left out some that equal the default, wrote fewer digits, and had another
// order. The name holds the swept parameters, then those that tell rows apart, then the others of the label, so that a
// cell has the same name whichever program wrote it.
std::string name_of(const json& scenario, std::span<const results::Cell> cells, std::size_t at,
                    std::span<const json> all_parameters) {
    const results::Cell& cell = cells[at];
    const json& parameters = all_parameters[at];
    std::vector<std::string> named = swept_of(scenario, cell.where, parameters);
    const auto add = [&](const std::string& name) {
        if (std::find(named.begin(), named.end(), name) == named.end()) named.push_back(name);
    };
    for (const std::string& name : differing_in(scenario, cells, at, all_parameters)) add(name);
    const std::string& label = cell.parameters;
    std::string others;
    for (std::size_t first = 0; first < label.size();) {
        const std::size_t space = std::min(label.find(' ', first), label.size());
        const std::string word = label.substr(first, space - first), name = word.substr(0, word.find('='));
        if (parameters.contains(name))
            add(name);
        else
            others += " " + word;
        first = space + 1;
    }
    std::string text = cell.technique;
    for (const std::string& name : named) text += " " + word_of(name, parameters.at(name));
    return text + others;
}

Cell make_cell(const results::Cell& from, const json& scenario, const std::vector<document::Setting>& settings,
               const std::string& source) {
    Cell cell;
    cell.version = fmt::format("{}", from.version);
    cell.failed = from.status == results::CellStatus::failed;
    cell.degraded = from.verdict == results::Verdict::degraded;
    cell.failure = from.reason;
    cell.exact = {{"bytes", Kind::size, static_cast<double>(from.bytes)},
                  {"working_bytes", Kind::size, static_cast<double>(from.working_bytes)},
                  {"nodes.total", Kind::size, static_cast<double>(from.nodes.total)},
                  {"nodes.max", Kind::size, static_cast<double>(from.nodes.max)}};
    if (from.curve) add_errors(cell, "curve_error", from.curve->norms);
    if (from.lookup) add_errors(cell, "lookup_error", from.lookup->norms);
    if (from.times) add_times(cell, *from.times);

    cell.rerun.source = source;
    cell.rerun.only = from.technique;
    const json technique = technique_of(scenario, from);
    if (technique.is_null()) return cell;
    cell.rerun.technique = technique.dump();
    json sweeps = json::object();
    for (const document::Setting& setting : settings)
        sweeps[setting.pointer] = json::array({json::parse(setting.value)});
    if (scenario.contains("sweeps")) cell.rerun.sweeps = sweeps.dump();
    return cell;
}

// Some cell of a light is always on each front, or perhaps on it; otherwise its cells were not marked.
bool has_marks(const results::LightResult& light, metrics::OnFront (*mark)(const results::Cell&)) {
    return std::any_of(light.cells.begin(), light.cells.end(),
                       [&](const results::Cell& cell) { return mark(cell) != metrics::OnFront::no; });
}

metrics::OnFront time_mark(const results::Cell& cell) {
    return cell.times ? cell.times->on_front : metrics::OnFront::no;
}

metrics::OnFront bytes_mark(const results::Cell& cell) {
    return cell.on_bytes_front;
}

void add_light(Suite& suite, const results::LightResult& light, const results::VariantResult& variant,
               const json& scenario, const std::string& source) {
    // Speed and seed are those of the first light.
    if (light.agreement && suite.speed.empty() && light.agreement->times.tracer_rays_per_second > 0.0)
        suite.speed.push_back(light.agreement->times.tracer_rays_per_second);
    if (suite.seed.empty()) suite.seed = fmt::format("{}", light.layout.seed);
    const std::string settings = settings_text(variant.settings);
    const std::string group = (settings.empty() ? "" : settings + " / ") + light.name;
    const bool timed = has_marks(light, time_mark), sized = has_marks(light, bytes_mark);
    std::map<std::string, int> seen;
    std::vector<json> parameters;
    for (const results::Cell& from : light.cells) parameters.push_back(json::parse(from.parameters_json));
    for (std::size_t i = 0; i < light.cells.size(); ++i) {
        Cell cell = make_cell(light.cells[i], scenario, variant.settings, source);
        cell.name = name_of(scenario, light.cells, i, parameters);
        cell.group = group;
        if (timed) cell.on_time_front = time_mark(light.cells[i]);
        if (sized) cell.on_bytes_front = bytes_mark(light.cells[i]);
        // Equal techniques of one scenario are numbered.
        const int earlier = seen[cell.name]++;
        if (earlier > 0) cell.name += fmt::format(" #{}", earlier + 1);
        suite.cells.push_back(std::move(cell));
    }
}

}  // namespace

Suite read_result(const results::Field& result, const std::string& origin) {
    const results::Result read = results::from_json(result.value, origin);
    Suite suite;
    suite.results = 1;
    suite.name = read.name;
    suite.hash = read.hash;
    suite.machine = fmt::format("{}, {} cores", read.machine.cpu, read.machine.logical_cores);
    // Which of them measured a cell differs from result to result, so no other result has the same machine.
    if (const std::size_t machines = results::machines_of(result.value).size(); machines > 1)
        suite.machine = fmt::format("{} machines (cells since {})", machines, read.times.started);
    suite.commit = read.program.commit;
    suite.program = fmt::format("{} ({}, {}, {})", read.program.version, read.program.commit, read.program.compiler,
                                read.program.build_type);
    for (std::size_t i = 0; i < read.only.size(); ++i) suite.only += (i ? " " : "") + read.only[i];
    suite.started = read.times.started;
    const json scenario = json::parse(read.document);
    for (const results::VariantResult& variant : read.variants)
        for (const results::LightResult& light : variant.lights)
            add_light(suite, light, variant, scenario, origin.empty() ? suite.name : origin);
    return suite;
}

}  // namespace shadowbench::compare

#include "results/merge_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/json_pointer.h"
#include "results/portable.h"
#include "results/report.h"

namespace shadowbench::results {
namespace {

CellOrigin origin_of(const SweepCell& cell) {
    return {cell.place, cell.node, to_json(cell.result).at("machine").dump(), machine_text(cell), cell.result.times};
}

bool same_model(const Machine& one, const Machine& other) {
    return one.cpu == other.cpu && one.logical_cores == other.logical_cores;
}

nlohmann::ordered_json to_json(const CellOrigin& origin) {
    nlohmann::ordered_json out = {{"variant", origin.place.variant},
                                  {"light", origin.place.light},
                                  {"node", origin.node},
                                  {"machine", nlohmann::ordered_json::parse(origin.machine_json)},
                                  {"started", origin.times.started},
                                  {"seconds", origin.times.seconds},
                                  {"threads", origin.times.threads}};
    add_state_to(out, origin.times);
    return out;
}

struct Found {
    std::string pointer, one, other;
};

// How far numbers that are not whole may differ.
struct Slack {
    double relative = 0.0, absolute = 0.0;
};

bool agree(double one, double other, const Slack& slack) {
    return std::abs(one - other) <= slack.relative * std::max(std::abs(one), std::abs(other)) + slack.absolute;
}

std::string brief(const nlohmann::ordered_json& value) {
    return value.is_structured() ? fmt::format("{} values", value.size()) : value.dump();
}

// The first value in which two documents differ.
std::optional<Found> first_difference(const nlohmann::ordered_json& one, const nlohmann::ordered_json& other,
                                      const Slack& slack, const std::string& pointer) {
    const auto here = [&] { return Found{pointer, brief(one), brief(other)}; };
    if (one.type() != other.type() || one.size() != other.size()) return here();
    if (one.is_number_float()) {
        if (agree(one.get<double>(), other.get<double>(), slack)) return {};
        return here();
    }
    if (!one.is_structured()) {
        if (one == other) return {};
        return here();
    }
    for (auto item = one.begin(); item != one.end(); ++item) {
        const std::string key = one.is_object() ? item.key() : std::to_string(item - one.begin());
        if (one.is_object() && !other.contains(key)) return here();
        const nlohmann::ordered_json& there =
            one.is_object() ? other.at(key) : other.at(static_cast<std::size_t>(item - one.begin()));
        if (auto found = first_difference(*item, there, slack, base::append_token(pointer, key))) return found;
    }
    return {};
}

// Their figures are compared as numbers; between machines the last digit in words may be rounded otherwise.
void leave_out_words(nlohmann::ordered_json& light) {
    for (auto& row : light.at("cells")) row.erase("verdict_why");
}

// What is compared of a cell.
nlohmann::ordered_json exact_part(const SweepCell& cell, bool portable) {
    nlohmann::ordered_json whole = to_json(cell.result);
    if (portable)
        make_portable_result(whole);
    else
        strip_times(whole);
    nlohmann::ordered_json light = std::move(whole.at("variants").front().at("lights").front());
    if (portable) leave_out_words(light);
    return light;
}

constexpr Slack between_machines{1e-6, 1e-12};

// The first difference of two lights.
std::optional<Disagreement> first_of_lights(const nlohmann::ordered_json& ours, const nlohmann::ordered_json& theirs,
                                            const Slack& slack) {
    const std::optional<Found> found = first_difference(ours, theirs, slack, "");
    if (!found) return {};
    // "/cells/2/bytes" is "bytes" of the third technique.
    const std::string start = "/cells/";
    const std::size_t end = found->pointer.find('/', start.size());
    if (found->pointer.rfind(start, 0) != 0 || end == std::string::npos)
        return Disagreement{found->pointer, found->one, found->other};
    const nlohmann::ordered_json& row = ours.at(nlohmann::ordered_json::json_pointer(found->pointer.substr(0, end)));
    return Disagreement{title(row.at("technique").get<std::string>(), row.at("label").get<std::string>()) + ": " +
                            found->pointer.substr(end),
                        found->one, found->other};
}

void add_missing(const std::vector<std::string>& lines, std::vector<std::string>& to) {
    for (const std::string& line : lines)
        if (std::count(to.begin(), to.end(), line) == 0) to.push_back(line);
}

}  // namespace

Merged merge_cells(std::span<const SweepCell> cells) {
    Merged merged;
    merged.result = cells.front().result;
    Result& result = merged.result;
    result.variants.clear();
    result.notes.clear();
    result.files.clear();
    result.times.seconds = 0.0;
    result.times.load.reset();  // each cell has its own
    result.times.slurm_job = result.times.slurm_node = "";
    bool several = false;
    for (const SweepCell& cell : cells) {
        const VariantResult& variant = cell.result.variants.at(0);
        if (result.variants.size() <= cell.place.variant) result.variants.push_back({variant.settings, {}});
        result.variants.back().lights.push_back(variant.lights.at(0));
        add_missing(cell.result.notes, result.notes);
        add_missing(cell.result.files, result.files);
        result.times.started = std::min(result.times.started, cell.result.times.started);
        result.times.seconds += cell.result.times.seconds;
        result.times.threads = std::max(result.times.threads, cell.result.times.threads);
        merged.origins.push_back(origin_of(cell));
        several = several || !same_model(cells.front().result.machine, cell.result.machine);
    }
    if (several) {
        result.machine = {};
        result.machine.cpu = several_machines;
    }
    return merged;
}

nlohmann::ordered_json to_json(const Merged& merged) {
    nlohmann::ordered_json out = to_json(merged.result);
    nlohmann::ordered_json& cells = out.at("times")["cells"];
    cells = nlohmann::ordered_json::array();
    for (const CellOrigin& origin : merged.origins) cells.push_back(to_json(origin));
    return out;
}

std::string machines_text(const Merged& merged) {
    std::vector<std::pair<std::string, std::size_t>> machines;
    for (const CellOrigin& origin : merged.origins) {
        const auto known = std::find_if(machines.begin(), machines.end(),
                                        [&](const auto& machine) { return machine.first == origin.machine; });
        if (known == machines.end())
            machines.emplace_back(origin.machine, 1);
        else
            ++known->second;
    }
    if (machines.size() < 2) return "";
    std::string text = fmt::format(
        "measured on {} machines. A front is of one light of one variant, and so of one machine; do not compare times "
        "of different machines.\n",
        machines.size());
    for (const auto& [machine, cells] : machines)
        text += fmt::format("  {}: {} cell{}\n", machine, cells, cells == 1 ? "" : "s");
    return text;
}

std::vector<std::string> machines_of(const nlohmann::json& result) {
    std::vector<std::string> machines;
    const auto times = result.is_object() ? result.find("times") : result.end();
    if (times == result.end() || !times->is_object() || !times->contains("cells")) return machines;
    for (const nlohmann::json& cell : times->at("cells")) {
        if (!cell.is_object()) continue;
        const nlohmann::json none;
        const nlohmann::json parts = nlohmann::json::array({cell.value("node", none), cell.value("machine", none)});
        const std::string machine = parts.dump();
        if (std::count(machines.begin(), machines.end(), machine) == 0) machines.push_back(machine);
    }
    return machines;
}

std::optional<Disagreement> disagreement(const SweepCell& one, const SweepCell& other) {
    const bool portable = one.result.machine.cpu != other.result.machine.cpu;
    const nlohmann::ordered_json ours = exact_part(one, portable), theirs = exact_part(other, portable);
    return first_of_lights(ours, theirs, portable ? between_machines : Slack{});
}

std::optional<Disagreement> portable_disagreement(const nlohmann::ordered_json& one,
                                                  const nlohmann::ordered_json& other) {
    nlohmann::ordered_json ours = one, theirs = other;
    make_portable_result(ours);
    make_portable_result(theirs);
    nlohmann::ordered_json &variants = ours.at("variants"), &their_variants = theirs.at("variants");
    const auto count_of = [](const nlohmann::ordered_json& values) { return std::to_string(values.size()); };
    if (variants.size() != their_variants.size())
        return Disagreement{"/variants", count_of(variants), count_of(their_variants)};
    for (std::size_t v = 0; v < variants.size(); ++v) {
        nlohmann::ordered_json &lights = variants[v].at("lights"), &their_lights = their_variants[v].at("lights");
        if (lights.size() != their_lights.size())
            return Disagreement{"/lights", count_of(lights), count_of(their_lights)};
        for (std::size_t l = 0; l < lights.size(); ++l) {
            leave_out_words(lights[l]);
            leave_out_words(their_lights[l]);
            if (auto found = first_of_lights(lights[l], their_lights[l], between_machines)) return found;
        }
    }
    return {};
}

}  // namespace shadowbench::results

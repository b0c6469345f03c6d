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

// What is compared of a cell.
nlohmann::ordered_json exact_part(const SweepCell& cell, bool portable) {
    nlohmann::ordered_json whole = to_json(cell.result);
    if (portable)
        make_portable_result(whole);
    else
        strip_times(whole);
    nlohmann::ordered_json light = std::move(whole.at("variants").front().at("lights").front());
    // Its figures are compared as numbers; between machines their last digit may be rounded otherwise.
    if (portable)
        for (auto& row : light.at("cells")) row.erase("verdict_why");
    return light;
}

}  // namespace

Merged merge_cells(std::span<const SweepCell> cells) {
    Merged merged;
    merged.result = cells.front().result;
    Result& result = merged.result;
    result.variants.clear();
    result.notes.clear();
    result.times.seconds = 0.0;
    result.times.load.reset();  // each cell has its own
    result.times.slurm_job = result.times.slurm_node = "";
    bool several = false;
    for (const SweepCell& cell : cells) {
        const VariantResult& variant = cell.result.variants.at(0);
        if (result.variants.size() <= cell.place.variant) result.variants.push_back({variant.settings, {}});
        result.variants.back().lights.push_back(variant.lights.at(0));
        for (const std::string& note : cell.result.notes)
            if (std::count(result.notes.begin(), result.notes.end(), note) == 0) result.notes.push_back(note);
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
    const std::optional<Found> found = first_difference(ours, theirs, portable ? Slack{1e-6, 1e-12} : Slack{}, "");
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

}  // namespace shadowbench::results

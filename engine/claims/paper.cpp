#include "claims/paper.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/read_text.h"
#include "bench/clock.h"
#include "bench/disturbance.h"
#include "bench/run.h"
#include "claims/intervals.h"
#include "document/document.h"
#include "scene/named_scenarios.h"

namespace shadowbench::claims {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

const Paper papers[] = {
    {"reeves1987", "Reeves, Salesin, Cook: Rendering Antialiased Shadows with Depth Maps (1987)", measure_reeves},
    {"lokovic2000", "Lokovic, Veach: Deep Shadow Maps (2000)", measure_lokovic},
    {"pagot2004", "Pagot, Comba, Oliveira: Multiple-Depth Shadow Maps (2004)", measure_pagot},
    {"volume", "Deep Shadow Maps from Volumetric Data: three depths and the maximum opacity a texel", measure_volume},
    {"salvi2010", "Salvi, Vidimce, Lauritzen, Lefohn: Adaptive Volumetric Shadow Maps (2010)", measure_salvi},
};

std::pair<std::string, json> split(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    json value = json::parse(assignment.substr(equals + 1), nullptr, false);
    if (value.is_discarded()) value = assignment.substr(equals + 1);
    return {assignment.substr(0, equals), std::move(value)};
}

bool has_all(const json& parameters, const std::vector<std::string>& wanted) {
    return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& assignment) {
        const auto [name, value] = split(assignment);
        const auto found = parameters.find(name);
        return found != parameters.end() && *found == value;
    });
}

bool has_settings(const results::VariantResult& variant, const std::vector<std::string>& wanted) {
    return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& assignment) {
        const auto named = split(assignment);
        return std::any_of(variant.settings.begin(), variant.settings.end(), [&](const document::Setting& setting) {
            return setting.pointer == named.first && json::parse(setting.value) == named.second;
        });
    });
}

}  // namespace

json Context::document(const std::string& name, const std::vector<std::string>& set) const {
    const std::filesystem::path file = scene::find_scenario({&scenarios, 1}, name);
    if (file.empty())
        throw Error(ErrorCode::no_such_file, name, "there is no scenario of this name in " + scenarios.string());
    json document = scene::parse_json(base::read_text(file), file.string());
    for (const std::string& assignment : set) document::set_value(document, assignment);
    return document;
}

results::Result Context::run(const std::string& name, const std::vector<std::string>& set,
                             const std::vector<std::string>& smaller, Times times) const {
    json changed = document(name, set);
    if (quick)
        for (const std::string& assignment : smaller) document::set_value(changed, assignment);
    bench::RunOptions options;
    options.data = data;
    options.threads = threads;
    options.times = times == Times::taken;
    note_document(*this, name, changed);
    return bench::run(changed, options, progress);
}

void note_document(const Context& context, const std::string& name, const json& document) {
    std::vector<std::string>& noted = context.report->documents;
    std::string note = fmt::format("{} {}", name, base::hash_text(document.dump()));
    if (std::find(noted.begin(), noted.end(), note) == noted.end()) noted.push_back(std::move(note));
}

const results::LightResult& light_of(const results::Result& result, const std::vector<std::string>& settings) {
    for (const results::VariantResult& variant : result.variants)
        if (has_settings(variant, settings)) return variant.lights.front();
    throw Error(ErrorCode::internal, result.name,
                fmt::format("no variant has the settings {}", fmt::join(settings, ", ")));
}

const results::Cell& cell_of(const results::LightResult& light, const std::string& technique,
                             const std::vector<std::string>& parameters) {
    for (const results::Cell& cell : light.cells) {
        if (cell.technique != technique || !has_all(json::parse(cell.parameters_json), parameters)) continue;
        if (cell.status == results::CellStatus::failed) throw Error(ErrorCode::internal, technique, cell.reason);
        return cell;
    }
    throw Error(ErrorCode::internal, technique,
                fmt::format("no cell has the parameters {}", fmt::join(parameters, ", ")));
}

Value time_ratio(const results::Cell& one, const results::Cell& other) {
    return ratio_of(one.times->image_order.ns.raw, other.times->image_order.ns.raw);
}

Value build_ratio(const results::Cell& one, const results::Cell& other) {
    return ratio_of(one.times->build_ms.raw, other.times->build_ms.raw);
}

std::span<const Paper> all_papers() {
    return papers;
}

PaperReport measure(const Paper& paper, Context context) {
    PaperReport report;
    report.id = paper.id;
    report.title = paper.title;
    context.report = &report;
    const std::optional<double> steal_before = bench::steal_seconds();
    const bench::Stopwatch stopwatch;
    paper.measure(context);
    report.seconds = stopwatch.seconds();
    if (const std::optional<double> after = bench::steal_seconds(); after && steal_before)
        report.steal_seconds = std::max(0.0, *after - *steal_before);
    return report;
}

}  // namespace shadowbench::claims

// Complete results of runs that never were.
#pragma once

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "results/report.h"

namespace shadowbench::service {

inline results::Result made_result(const std::string& name) {
    results::Result result;
    result.name = name;
    result.hash = "hash of " + name;
    result.document = R"({"rays":{"seed":7},"scene":{"objects":[]}})";
    result.program = {"1.0", "abc", "compiler", "release"};
    result.machine = {"cpu", 1};
    result.times = {"2026-01-02T03:04:05Z", 1.0, 1};
    return result;
}

// With one cell of this status.
inline results::Result made_result(const std::string& name, results::CellStatus status) {
    results::Result result = made_result(name);
    results::Cell cell;
    cell.technique = "deep";
    cell.parameters_json = "{}";
    cell.status = status;
    results::LightResult light;
    light.cells = {std::move(cell)};
    result.variants = {{{}, {std::move(light)}}};
    return result;
}

// As result.json has it, in one line and without a quote of the shell.
inline std::string text_of(const results::Result& result) {
    return results::to_json(result).dump();
}

}  // namespace shadowbench::service

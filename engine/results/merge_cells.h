// Makes one result of the cells of a sweep, which one machine or several have measured.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/result.h"
#include "results/sweep_cell.h"

namespace shadowbench::results {

// Where and when a cell was measured.
struct CellOrigin {
    CellPlace place;
    std::string node;
    std::string machine_json;  // as a result.json states it
    std::string machine;       // "n1, AMD EPYC, 8 cores"
    RunTimes times;
};

struct Merged {
    Result result;
    std::vector<CellOrigin> origins;  // one a cell, in the order of the result
};

// Stands for the processor of a merged result whose cells were measured on several models.
inline constexpr const char* several_machines = "several machines";

// The cells must be all those of one scenario, each once, in the order of their places, and of one program. The result
// is that of run(): fronts are within a light of a variant, so each is of one machine. Its time is that of all cells
// together, and its start that of the first.
Merged merge_cells(std::span<const SweepCell> cells);

// result.json: that of the result, with "cells" under "times", which names the origin of every cell.
nlohmann::ordered_json to_json(const Merged& merged);

// result.csv, whose column "machine" is that of the cell.
std::string to_csv(const Merged& merged);

// For a terminal: one line for each machine, with its number of cells; empty if there is only one machine.
std::string machines_text(const Merged& merged);

// The computers, each once, that a result.json names as those of its cells; none if it was not merged.
std::vector<std::string> machines_of(const nlohmann::json& result);

// An exact measure that differs between two measurements of one cell.
struct Disagreement {
    std::string measure;     // "deep tolerance=0.02: /lookup_error/rms"
    std::string one, other;  // JSON texts
};

// The first one, or nothing. Exact measures are all but times. On one model of processor they must be equal. Between
// models only those of portable.h are compared, and numbers may differ by 1e-6, or by 1e-12 near 0.
std::optional<Disagreement> disagreement(const SweepCell& one, const SweepCell& other);

// The same of two results, each as portable.h makes it or with times too. Only the lights of their variants count.
std::optional<Disagreement> portable_disagreement(const nlohmann::ordered_json& one,
                                                  const nlohmann::ordered_json& other);

}  // namespace shadowbench::results

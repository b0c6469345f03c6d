// The folder that the shards of a sweep share, on one machine or on many:
//   sweep.json          what is swept; every shard of a sweep writes the same, its arguments aside
//   cells/<hash>.json   a cell: results/sweep_cell.h
// Files appear whole. Names that begin with a dot are what killed programs left.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/sweep_cell.h"

namespace shadowbench::service {

struct Sweep {
    std::vector<std::shared_ptr<const nlohmann::json>> scenarios;  // documents
    std::vector<std::string> only;                                 // technique ids; empty: all
    std::vector<std::string> arguments;  // of the shard that began it: its scenarios and options, without --shard
};

struct PlannedCell {
    std::size_t scenario = 0;
    results::CellPlace place;
    std::string title;  // "quickstart /rays/resolution=64 light key"
    std::string hash;   // results::cell_hash()
};

// All cells of a sweep: scenario by scenario, variant by variant, light by light. Throws what bench::cells_of() throws.
std::vector<PlannedCell> planned_cells(const Sweep& sweep);

// Makes the folder, or adds to it. Throws Error{bad_input} if it holds another sweep, and Error{io}.
void begin_sweep(const std::filesystem::path& folder, const Sweep& sweep);

// The sweep of a folder. Throws Error: no_such_file, io, or bad_input.
Sweep read_sweep(const std::filesystem::path& folder);

// Throws Error{bad_input}, place: sweep.json of the second folder, if they do not sweep the same.
void check_same(const Sweep& one, const Sweep& other, const std::filesystem::path& folder);

std::filesystem::path cell_file(const std::filesystem::path& folder, const PlannedCell& cell);

// The files of all cells, sorted by name; none if there is no folder of cells. Throws Error{io}.
std::vector<std::filesystem::path> cell_files(const std::filesystem::path& folder);

// Throws Error{bad_input}, place: the file, if it is damaged, and Error: no_such_file or io.
results::SweepCell read_cell_file(const std::filesystem::path& file);

// The cell, if its file is there. Throws what read_cell_file() throws, and Error{bad_input} if the file holds another
// cell.
std::optional<results::SweepCell> find_cell(const std::filesystem::path& folder, const PlannedCell& cell);

// The command that measures all cells that are missing.
std::string command_for_missing(const Sweep& sweep, const std::filesystem::path& folder);

}  // namespace shadowbench::service

// A cell of a sweep: one variant of a scenario with one light, measured by itself, and its file. The file is a
// result.json (report.h) with that variant and light alone, and one more key:
//   "cell": {"variant": 3, "light": 0, "node": "n1", "checksum": "0123456789abcdef"}
#pragma once

#include <compare>
#include <cstddef>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "results/result.h"

namespace shadowbench::results {

// Which cell of a scenario, counted from 0 as run() measures them.
struct CellPlace {
    std::size_t variant = 0, light = 0;
    friend auto operator<=>(const CellPlace&, const CellPlace&) = default;
};

struct SweepCell {
    CellPlace place;
    std::string node;  // the computer that measured it
    Result result;     // one variant with one light
};

// Names a cell, whichever program and machine measures it: a hash of the hash of its scenario, of the technique ids
// that the run is limited to, and of its place.
std::string cell_hash(const std::string& scenario_hash, std::span<const std::string> only, const CellPlace& place);
std::string cell_hash(const SweepCell& cell);

// The name of this computer: $SLURMD_NODENAME, or its host name.
std::string this_node();

// "AMD EPYC, 8 cores", and with the computer "n1, AMD EPYC, 8 cores".
std::string machine_text(const Machine& machine);
std::string machine_text(const SweepCell& cell);

// The content of a cell's file. The checksum is of all the rest.
nlohmann::ordered_json to_json(const SweepCell& cell);

// The inverse. Throws Error{bad_input}, place: `origin`, the name of the file, and the JSON pointer; also if a value
// was changed after the file was written.
SweepCell cell_from_json(const nlohmann::json& document, const std::string& origin);

}  // namespace shadowbench::results

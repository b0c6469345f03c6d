// The contents of result files as one list of cells, for scenarios and for kernels of Google Benchmark.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "metrics/interval_front.h"

namespace shadowbench::compare {

// What a measure counts, and so what more of it means.
enum class Kind {
    size,          // bytes, nodes: more is larger
    error,         // more is less accurate
    instructions,  // more is slower
};

// A number that does not depend on the clock. An error that is not finite is +infinity.
struct Exact {
    std::string name;
    Kind kind;
    double value;
};

// Samples of one process, in the order they were taken.
struct Process {
    std::vector<double> raw;    // at least 0
    std::vector<double> ratio;  // to the floor of the same repetition; empty: none
};

struct Timed {
    std::string name, unit;
    std::vector<Process> processes;
};

// How to run one cell again on its own.
struct Rerun {
    std::string program = "shadowbench";
    bool kernel = false;             // otherwise a cell of a scenario
    bool counted = false;            // a kernel whose instructions were counted, not timed
    std::string source;              // a scenario, its name, or a result.json; for a kernel its name; empty: unknown
    std::vector<std::string> given;  // further arguments, as "--set", "rays.seed=2"
    std::string technique;           // JSON, as in a scenario; empty: not known
    std::string only;                // the technique's type
    std::string sweeps;              // JSON, of this variant only; empty: the scenario has none
};

// The command as a line for a shell.
std::string command_of(const Rerun& rerun);

// The arguments, without the program, that run these cells together. There must be at least one; all must have the
// source, `given` and sweeps of the first.
std::vector<std::string> arguments_of(const std::vector<Rerun>& reruns);

struct Cell {
    std::string group;    // variant and light, as "rays.seed=2 / key": cells of a group share fronts; empty for kernels
    std::string name;     // technique and parameters, as "deep tolerance=0.02", or kernel
    std::string version;  // of the technique; empty for kernels
    bool failed = false;
    bool degraded = false;
    std::string failure;  // why it failed
    std::vector<Exact> exact;
    std::vector<Timed> timed;
    // What the intervals of its own result say of it; absent for kernels and for results without marks. Of several
    // results of one scenario, the first.
    std::optional<metrics::OnFront> on_time_front, on_bytes_front;
    Rerun rerun;
};

// The results of one scenario, or of all kernels. Several results of one scenario are processes of one suite.
struct Suite {
    std::string name;     // the scenario's, or "kernels"
    std::string hash;     // the scenario's; empty for kernels
    std::string seed;     // of the rays; empty for kernels
    std::string machine;  // "AMD EPYC, 2 cores"
    std::string commit;
    std::string program;  // version, commit and compiler
    std::string only;     // technique types that the run was limited to; empty: all
    std::string started;  // time of the first result
    std::size_t results = 0;
    std::vector<double> speed;  // Embree's rays a second, one per result: no change of the program affects them
    std::vector<Cell> cells;
};

struct Measured {
    std::vector<Suite> suites;
    std::vector<std::string> notes;  // remarks for the report
    // Equal on both sides of one interleaved comparison; otherwise empty. If equal, process i of one side ran beside
    // process i of the other.
    std::string interleaved;
    std::vector<std::string> files;  // names of the files, relative to their folder
};

// Adds one JSON document: a result of `shadowbench run`, or the output of a kernel program. Returns false if it is
// neither. `origin` is its file; if empty, commands name the scenario. Throws Error{bad_input}, place: `origin` with
// the JSON pointer.
bool add(Measured& measured, const nlohmann::json& document, const std::string& origin);

// Parses JSON of at most 64 levels. Throws Error{bad_input}, place: `origin` with line and column.
nlohmann::json parse(const std::string& text, const std::string& origin);

// Parses a file. Throws what parse() throws, and Error{no_such_file, io}, place: the file.
nlohmann::json read_json(const std::filesystem::path& file);

// The files of a path: the path itself, or every *.json below a folder, sorted by path; names that begin with a dot are
// left out. Throws Error{no_such_file}, and bad_input if a folder has none.
std::vector<std::filesystem::path> result_files(const std::filesystem::path& path);

// Reads a file, or every result and kernel file below a folder (other JSON files are ignored). Throws Error; bad_input
// also if nothing was measured.
Measured read(const std::filesystem::path& path);

// The name of a file beside the folders of both sides of an interleaved comparison.
inline constexpr const char* interleaved_mark = "interleaved.json";

}  // namespace shadowbench::compare

// What result files hold, as one plain list of cells: the same for scenarios and for kernels of Google Benchmark.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::compare {

// What a measure counts, and so what more of it is.
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

// How to run a cell again, alone.
struct Rerun {
    std::string program = "shadowbench";
    bool kernel = false;   // else a cell of a scenario
    bool counted = false;  // a kernel whose instructions were counted, not timed
    std::string source;    // a scenario, its name, or a result.json; of a kernel its name; empty: cannot be run
    std::vector<std::string> given;  // further arguments, as "--set", "rays.seed=2"
    std::string technique;           // JSON, as in a scenario; empty: not known
    std::string only;                // the technique's type
    std::string sweeps;              // JSON, of this variant alone; empty: the scenario has none
};

// The line for a shell.
std::string command_of(const Rerun& rerun);

// The arguments, without the program, that run these cells together. Not empty; all have the first one's source, given
// and sweeps.
std::vector<std::string> arguments_of(const std::vector<Rerun>& reruns);

struct Cell {
    std::string group;    // variant and light, as "rays.seed=2 / key": its cells share fronts; of kernels empty
    std::string name;     // technique and parameters, as "deep tolerance=0.02", or kernel
    std::string version;  // of the technique; of kernels empty
    bool failed = false;
    bool degraded = false;
    std::string failure;  // why it failed
    std::vector<Exact> exact;
    std::vector<Timed> timed;
    Rerun rerun;
};

// The results of one scenario, or of all kernels; several results of one scenario are processes of one suite.
struct Suite {
    std::string name;     // the scenario's, or "kernels"
    std::string hash;     // the scenario's; of kernels empty
    std::string seed;     // of the rays; of kernels empty
    std::string machine;  // "AMD EPYC, 2 cores"
    std::string commit;
    std::string program;  // version, commit and compiler
    std::string only;     // technique types that the run was limited to; empty: all
    std::string started;  // of the first
    std::size_t results = 0;
    std::vector<double> speed;  // of the machine, one a result: Embree's rays a second, which no change here touches
    std::vector<Cell> cells;
};

struct Measured {
    std::vector<Suite> suites;
    std::vector<std::string> notes;  // what is odd about them
    // Both sides of one interleaved comparison have the same; else empty. Process i of one side then ran beside process
    // i of the other.
    std::string interleaved;
    std::vector<std::string> files;  // of a folder, as they are called inside it
};

// Adds what one JSON document holds: a result of `shadowbench run`, or what a kernel program wrote. `origin` is its
// file, or empty: then commands name the scenario. False: it is neither. Throws Error{bad_input}, place: `origin` with
// the JSON pointer.
bool add(Measured& measured, const nlohmann::json& document, const std::string& origin);

// JSON of at most 64 levels. Throws Error{bad_input}, place: `origin` with line and column.
nlohmann::json parse(const std::string& text, const std::string& origin);

// A file's JSON. Throws what parse() throws, and Error{no_such_file, io}, place: the file.
nlohmann::json read_json(const std::filesystem::path& file);

// The files that stand for a path: itself, or every *.json below a folder, sorted by their places; names that begin
// with a dot are left out. Throws Error{no_such_file}; bad_input where a folder has none.
std::vector<std::filesystem::path> result_files(const std::filesystem::path& path);

// A file, or every result and kernel file below a folder (other JSON files are passed over). Throws Error; bad_input
// also where nothing was measured.
Measured read(const std::filesystem::path& path);

// Beside the folders of both sides of an interleaved comparison.
inline constexpr const char* interleaved_mark = "interleaved.json";

}  // namespace shadowbench::compare

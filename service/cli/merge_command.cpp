#include <algorithm>
#include <map>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_files.h"
#include "results/merge_cells.h"
#include "results/report.h"
#include "service/cli/job.h"
#include "service/cli/libraries.h"
#include "service/cli/outcomes.h"
#include "service/cli/output.h"
#include "service/cli/sweep_commands.h"
#include "service/cli/sweep_folder.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_missing_named = 20;

struct CellFile {
    fs::path file;
    results::SweepCell cell;
};

// The sweep that all folders hold.
Sweep common_sweep(const std::vector<std::string>& folders) {
    Sweep sweep = read_sweep(folders.at(0));
    for (std::size_t i = 1; i < folders.size(); ++i) check_same(sweep, read_sweep(folders[i]), folders[i]);
    return sweep;
}

// The cells of the sweep. Throws Error{bad_input} if its file was changed by hand into what no shard writes.
std::vector<PlannedCell> planned_of(const Sweep& sweep, const std::string& folder) {
    const fs::path file = fs::path(folder) / "sweep.json";
    try {
        std::vector<PlannedCell> planned = planned_cells(sweep);
        std::set<std::string> names;
        for (const auto& scenario : sweep.scenarios) names.insert(scenario->at("name").get<std::string>());
        if (planned.empty() || names.size() < sweep.scenarios.size())
            throw base::Error(base::ErrorCode::bad_input, "/scenarios", "must hold scenarios, each name once");
        return planned;
    } catch (const base::Error& error) {
        throw in_file(error, file);
    }
}

std::string program_text(const results::Program& program) {
    return fmt::format("{} ({}, {}, {})", program.version, program.commit, program.compiler, program.build_type);
}

// "libstairs.so (0123456789abcdef, isolated)"
std::string library_text(const std::optional<results::TechniqueLibrary>& library) {
    if (!library) return "the program itself";
    return fmt::format("{} ({}{})", library->file, library->hash, library->isolated ? ", isolated" : "");
}

// Where the techniques of all cells are from: one technique of a sweep must be from one file.
class Sources {
public:
    // Throws Error{bad_input}, place: the file, for a cell whose technique is from elsewhere than in an earlier cell.
    void add(const results::SweepCell& cell, const std::string& file) {
        for (const results::Cell& row : cell.result.variants.at(0).lights.at(0).cells) {
            const auto [known, is_new] = known_.try_emplace(row.technique, Source{row.library, file});
            if (is_new || known->second.library == row.library) continue;
            throw base::Error(base::ErrorCode::bad_input, file,
                              fmt::format("its technique {} is from {}, but that of {} from {}; measure all with the "
                                          "same library: run --shard measures cells of other libraries again",
                                          row.technique, library_text(row.library), known->second.file,
                                          library_text(known->second.library)));
        }
    }

private:
    struct Source {
        std::optional<results::TechniqueLibrary> library;
        std::string file;  // of the first cell
    };
    std::map<std::string, Source> known_;
};

using CellsByHash = std::map<std::string, std::vector<CellFile>>;

// Throws Error{bad_input}, place: the file, for cells that are damaged, of another sweep, or of another program or
// another library of a technique than the first.
CellsByHash read_cells(const std::vector<std::string>& folders, const std::vector<PlannedCell>& planned) {
    std::set<std::string> known;
    for (const PlannedCell& cell : planned) known.insert(cell.hash);
    CellsByHash cells;
    std::string first_file, first_program;
    Sources sources;
    for (const std::string& folder : folders)
        for (const fs::path& file : cell_files(folder)) {
            results::SweepCell cell = read_cell_file(file);
            const std::string hash = results::cell_hash(cell), program = program_text(cell.result.program);
            if (known.count(hash) == 0)
                throw base::Error(base::ErrorCode::bad_input, file.string(),
                                  fmt::format("is no cell of this sweep: it is of scenario {} ({}); move it away",
                                              cell.result.name, cell.result.hash));
            if (first_file.empty()) {
                first_file = file.string();
                first_program = program;
            }
            if (program != first_program)
                throw base::Error(base::ErrorCode::bad_input, file.string(),
                                  fmt::format("was measured by program {}, but {} by {}; measure all with one: "
                                              "run --shard measures cells of another version or commit again, but "
                                              "those of another compiler must be removed first",
                                              program, first_file, first_program));
            sources.add(cell, file.string());
            cells[hash].push_back({file, std::move(cell)});
        }
    return cells;
}

// Names cells that are there more than once. Throws Error{bad_input}, place: the second file, if they disagree.
void check_doubled(const PlannedCell& planned, const std::vector<CellFile>& files, std::ostream& out) {
    for (std::size_t i = 1; i < files.size(); ++i) {
        const CellFile &one = files[0], &other = files[i];
        const std::string on = results::machine_text(one.cell), other_on = results::machine_text(other.cell);
        if (const auto found = results::disagreement(one.cell, other.cell))
            throw base::Error(
                base::ErrorCode::bad_input, other.file.string(),
                fmt::format("{}: its measurements disagree in {}: {} here (on {}), {} in {} (on {})", planned.title,
                            found->measure, found->other, other_on, found->one, one.file.string(), on));
        out << fmt::format("doubled: {}: {} (on {}) agrees with {} (on {}), which counts\n", planned.title,
                           other.file.string(), other_on, one.file.string(), on);
    }
}

// Names the cells that are missing, and a command that measures them; if there are several folders, for the first.
void say_missing(const std::vector<const PlannedCell*>& missing, std::size_t all, const Sweep& sweep,
                 const std::string& folder, std::ostream& out) {
    if (missing.empty()) return;
    for (std::size_t i = 0; i < std::min(missing.size(), most_missing_named); ++i)
        out << fmt::format("missing: {}\n", missing[i]->title);
    if (missing.size() > most_missing_named) out << fmt::format("and {} more\n", missing.size() - most_missing_named);
    out << fmt::format("{} of {} cells are missing. Run the same shards again, or measure all that {} lacks: {}\n",
                       missing.size(), all, folder, command_for_missing(sweep, folder));
}

// Writes the result of one scenario and prints its table.
results::Result write_merged(const std::vector<results::SweepCell>& cells, const fs::path& folder, Output& output) {
    results::Merged merged = results::merge_cells(cells);
    base::write_files({{folder / "result.json", results::to_json(merged).dump(1) + "\n"},
                       {folder / "result.csv", results::to_csv(merged)}});
    output.add(merged);
    conclude(merged.result, folder, {}, output);
    return std::move(merged.result);
}

}  // namespace

bool merge_command(const MergeArguments& arguments, std::ostream& out, std::ostream& err) {
    load_libraries(arguments.libraries);
    const Sweep sweep = common_sweep(arguments.folders);
    const bool several = sweep.scenarios.size() > 1;
    Output output(arguments.output, several, out, err);
    const std::vector<PlannedCell> planned = planned_of(sweep, arguments.folders[0]);
    CellsByHash files = read_cells(arguments.folders, planned);

    std::vector<std::vector<results::SweepCell>> cells(sweep.scenarios.size());
    std::vector<std::size_t> lacking(sweep.scenarios.size());
    std::vector<const PlannedCell*> missing;
    for (const PlannedCell& cell : planned) {
        const auto found = files.find(cell.hash);
        if (found == files.end()) {
            missing.push_back(&cell);
            ++lacking[cell.scenario];
            continue;
        }
        check_doubled(cell, found->second, output.text());
        cells[cell.scenario].push_back(std::move(found->second[0].cell));
    }

    bool kept = true;
    std::vector<results::ScenarioOutcome> outcomes;
    for (std::size_t s = 0; s < sweep.scenarios.size(); ++s) {
        const nlohmann::json& document = *sweep.scenarios[s];
        if (lacking[s] > 0) {
            outcomes.push_back(without_result(
                document, fmt::format("{} of {} cells are missing", lacking[s], lacking[s] + cells[s].size())));
            continue;
        }
        outcomes.push_back({write_merged(cells[s], results_folder(arguments.out, several, document), output), ""});
        kept = kept && !results::any_failed(outcomes.back().result);
    }
    report_outcomes(outcomes, several, verdicts_file("", arguments.out, several), output);
    say_missing(missing, planned.size(), sweep, arguments.folders[0],
                arguments.output.has_data() ? err : output.text());
    output.end();
    return kept && missing.empty();
}

}  // namespace shadowbench::service

#include "service/cli/sweep_folder.h"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/durable_file.h"
#include "base/error.h"
#include "base/hash_text.h"
#include "base/shell_word.h"
#include "base/write_files.h"
#include "bench/cell_runner.h"
#include "compare/measured.h"
#include "results/fields.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t sweep_layout = 1;  // increased when a key of sweep.json changes its name or meaning

fs::path sweep_file(const fs::path& folder) {
    return folder / "sweep.json";
}

std::vector<std::string> texts_of(const results::Field& list) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < list.array().size(); ++i) texts.push_back(list.item(i).text());
    return texts;
}

std::string sweep_text(const Sweep& sweep) {
    nlohmann::ordered_json scenarios = nlohmann::ordered_json::array();
    for (const auto& scenario : sweep.scenarios) scenarios.push_back(nlohmann::ordered_json(*scenario));
    const nlohmann::ordered_json file{{"layout", sweep_layout},
                                      {"arguments", sweep.arguments},
                                      {"only", sweep.only},
                                      {"scenarios", std::move(scenarios)}};
    return file.dump(1) + "\n";
}

// False also if it cannot be known; then reading the file says why.
bool is_missing(const fs::path& file) {
    std::error_code failed;
    return !fs::exists(file, failed) && !failed;
}

[[noreturn]] void refuse_file(const base::Error& error, const char* advice) {
    throw base::Error(error.code(), error.where(), error.message() + advice);
}

}  // namespace

std::vector<PlannedCell> planned_cells(const Sweep& sweep) {
    std::vector<PlannedCell> cells;
    for (std::size_t s = 0; s < sweep.scenarios.size(); ++s) {
        const std::string hash = base::hash_text(sweep.scenarios[s]->dump());
        for (bench::CellOfDocument& cell : bench::cells_of(*sweep.scenarios[s], sweep.only))
            cells.push_back({s, cell.place, std::move(cell.title), results::cell_hash(hash, sweep.only, cell.place)});
    }
    return cells;
}

void begin_sweep(const fs::path& folder, const Sweep& sweep) {
    base::Undo made;
    base::make_writable(folder / "cells", made);
    if (is_missing(sweep_file(folder))) base::write_durable(sweep_file(folder), sweep_text(sweep));
    made.keep();
    check_same(sweep, read_sweep(folder), folder);
}

Sweep read_sweep(const fs::path& folder) {
    const fs::path file = sweep_file(folder);
    try {
        const nlohmann::json document = compare::read_json(file);
        const results::Field whole = results::top(document, file.string());
        if (whole.at("layout").count() != sweep_layout)
            results::refuse(whole.at("layout").where,
                            fmt::format("is not known; this program reads layout {}", sweep_layout));
        Sweep sweep;
        sweep.only = texts_of(whole.at("only"));
        sweep.arguments = texts_of(whole.at("arguments"));
        const results::Field scenarios = whole.at("scenarios");
        for (const nlohmann::json& scenario : scenarios.array())
            sweep.scenarios.push_back(std::make_shared<const nlohmann::json>(scenario));
        return sweep;
    } catch (const base::Error& error) {
        if (error.code() == base::ErrorCode::no_such_file)
            refuse_file(error, "; name a folder that run --shard has filled");
        throw;
    }
}

void check_same(const Sweep& one, const Sweep& other, const fs::path& folder) {
    const auto equal = [](const auto& a, const auto& b) { return a->dump() == b->dump(); };
    if (one.only != other.only ||
        !std::equal(one.scenarios.begin(), one.scenarios.end(), other.scenarios.begin(), other.scenarios.end(), equal))
        throw base::Error(base::ErrorCode::bad_input, sweep_file(folder).string(),
                          "is of another sweep: its scenarios, their order, or --only differ; give each sweep a folder "
                          "of its own");
}

fs::path cell_file(const fs::path& folder, const PlannedCell& cell) {
    return folder / "cells" / (cell.hash + ".json");
}

std::vector<fs::path> cell_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failed;
    fs::directory_iterator entry(folder / "cells", failed), end;
    for (; !failed && entry != end; entry.increment(failed)) {
        const fs::path& path = entry->path();
        if (path.filename().string().front() != '.' && path.extension() == ".json") files.push_back(path);
    }
    if (failed && failed != std::errc::no_such_file_or_directory)
        throw base::Error(base::ErrorCode::io, (folder / "cells").string(),
                          "cannot read the folder: " + failed.message());
    std::sort(files.begin(), files.end());
    return files;
}

results::SweepCell read_cell_file(const fs::path& file) {
    try {
        return results::cell_from_json(compare::read_json(file), file.string());
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::bad_input) throw;
        refuse_file(error, "; the file of this cell is damaged: remove it and measure the cell again");
    }
}

std::optional<results::SweepCell> find_cell(const fs::path& folder, const PlannedCell& cell) {
    const fs::path file = cell_file(folder, cell);
    if (is_missing(file)) return {};
    results::SweepCell found = read_cell_file(file);
    if (results::cell_hash(found) != cell.hash)
        throw base::Error(
            base::ErrorCode::bad_input, file.string(),
            fmt::format("holds another cell than {}, of scenario {}; move it away", cell.title, found.result.name));
    return found;
}

std::string command_for_missing(const Sweep& sweep, const fs::path& folder) {
    std::string command = "shadowbench run";
    for (const std::string& argument : sweep.arguments) command += " " + base::shell_word(argument);
    return command + " --shard 0/1 --out " + base::shell_word(folder.string());
}

}  // namespace shadowbench::service

#include <charconv>
#include <deque>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/durable_file.h"
#include "base/error.h"
#include "base/table.h"
#include "bench/cell_runner.h"
#include "results/program.h"
#include "results/settled.h"
#include "service/cli/libraries.h"
#include "service/cli/output.h"
#include "service/cli/progress_bar.h"
#include "service/cli/sweep_commands.h"
#include "service/cli/sweep_folder.h"
#include "service/cli/swept_scenarios.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

struct Shard {
    std::size_t index = 0, count = 1;
};

bool read_number(const char*& at, const char* end, std::size_t& number) {
    const auto [rest, fault] = std::from_chars(at, end, number);
    at = rest;
    return fault == std::errc();
}

Shard read_shard(const std::string& text) {
    Shard shard;
    const char* at = text.data();
    const char* const end = at + text.size();
    const bool good = read_number(at, end, shard.index) && at != end && *at++ == '/' &&
                      read_number(at, end, shard.count) && at == end && shard.index < shard.count;
    if (!good)
        throw base::Error(base::ErrorCode::usage, "--shard " + text,
                          "expected i/n, the shard's number from 0 on and the number of shards, as in 0/4");
    return shard;
}

bool same_version(const results::Program& one, const results::Program& other) {
    return one.version == other.version && one.commit == other.commit;
}

// Measures cells; those that follow each other in a scenario share what was loaded for it.
class Measuring {
public:
    Measuring(const std::vector<Swept>& swept, std::ostream& err) : swept_(swept), err_(err) {}

    // `place`: of the cell among those of the shard, for people. Throws what CellRunner does, with the scenario's file.
    results::SweepCell measure(const PlannedCell& cell, const std::string& place) {
        const Swept& scenario = swept_[cell.scenario];
        try {
            if (!runner_ || scenario_ != cell.scenario) {
                runner_.reset();
                runner_ = std::make_unique<bench::CellRunner>(*scenario.job.document, scenario.job.options);
                scenario_ = cell.scenario;
            }
            ProgressBar bar(err_);
            return runner_->measure(cell.place, [&](bench::Progress progress) {
                progress.place = place + (progress.place.empty() ? "" : " ") + progress.place;
                bar.show(progress);
            });
        } catch (const base::Error& error) {
            throw in_file(error, scenario.file);
        }
    }

private:
    const std::vector<Swept>& swept_;
    std::ostream& err_;
    std::unique_ptr<bench::CellRunner> runner_;
    std::size_t scenario_ = 0;  // of the runner
};

// Whether the cell is there and need not be measured. Says why in a line.
bool is_there(const std::optional<results::SweepCell>& found, const PlannedCell& cell, const fs::path& folder,
              std::ostream& out) {
    if (!found) return false;
    const std::string file = cell_file(folder, cell).string();
    const results::Program own = results::this_program(), &other = found->result.program;
    if (!same_libraries(found->result)) {
        out << fmt::format("measured again: {}: {} is of other libraries of techniques\n", cell.title, file)
            << std::flush;
        return false;
    }
    const bool there = same_version(own, other);
    out << (there ? fmt::format("skipped: {}: {} has it\n", cell.title, file)
                  : fmt::format("measured again: {}: {} is of version {} ({}), this is {} ({})\n", cell.title, file,
                                other.version, other.commit, own.version, own.commit))
        << std::flush;
    return there;
}

}  // namespace

bool shard_command(const RunArguments& arguments, std::ostream& all_out, std::ostream& all_err) {
    Output output(arguments.output, true, all_out, all_err);
    std::ostream &out = output.text(), &err = output.progress();
    const Shard shard = read_shard(arguments.shard);
    const std::vector<Swept> swept = read_swept(arguments);
    const Sweep sweep = sweep_of(swept, arguments);
    const fs::path folder = arguments.out;
    begin_sweep(folder, sweep);

    const std::vector<PlannedCell> all = planned_cells(sweep);
    std::vector<PlannedCell> own;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (i % shard.count == shard.index) own.push_back(all[i]);
    for (const PlannedCell& cell : own) find_cell(folder, cell);  // damaged files are found before hours of work

    Measuring measuring(swept, err);
    std::optional<base::Error> first_error;
    std::deque<results::Result> measured;
    std::size_t skipped = 0;
    bool kept = true;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const PlannedCell& cell = own[i];
        // Looked for again, since another shard may have measured it meanwhile: numbers of shards may change.
        const std::optional<results::SweepCell> found = find_cell(folder, cell);
        if (is_there(found, cell, folder, out)) {
            kept = kept && !results::any_failed(found->result);
            ++skipped;
            continue;
        }
        out << fmt::format("measuring: {}\n", cell.title) << std::flush;
        std::optional<results::SweepCell> fresh;
        try {
            fresh = measuring.measure(cell, fmt::format("{}/{}", i + 1, own.size()));
        } catch (const base::Error& error) {
            out << fmt::format("not measured: {}: {}\n", cell.title, error.what()) << std::flush;
            if (!first_error) first_error = error;
            continue;
        }
        base::write_durable(cell_file(folder, cell), results::to_json(*fresh).dump(1) + "\n");
        out << fmt::format("written: {}: {}\n", cell_file(folder, cell).string(), cell.title) << std::flush;
        kept = kept && !results::any_failed(fresh->result);
        measured.push_back(std::move(fresh->result));
    }
    out << fmt::format("shard {} has {} of {} cells: {} measured, {} skipped, {} not measured\n", arguments.shard,
                       own.size(), all.size(), measured.size(), skipped, own.size() - measured.size() - skipped);
    std::vector<const results::Result*> timed;
    for (const results::Result& result : measured) timed.push_back(&result);
    out << base::wrapped(results::unsettled_line(timed), output.style().width);
    if (first_error) throw *first_error;
    return kept;
}

}  // namespace shadowbench::service

#include <deque>
#include <map>
#include <new>
#include <optional>
#include <ostream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/pending_file.h"
#include "base/shell_word.h"
#include "base/write_files.h"
#include "bench/run.h"
#include "document/document.h"
#include "results/write_result.h"
#include "service/cli/commands.h"
#include "service/cli/job.h"
#include "service/cli/job_pictures.h"
#include "service/cli/outcomes.h"
#include "service/cli/output.h"
#include "service/cli/progress_bar.h"
#include "service/cli/scenario_files.h"
#include "service/cli/swept_scenarios.h"
#include "service/cli/terminal.h"
#include "techniques/technique.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

struct Planned {
    std::string name;  // by which the user can call for it again
    fs::path file;
    Job job;
    fs::path folder;  // of its results
};

void refuse_equal_names(const std::vector<Planned>& plan) {
    std::map<fs::path, fs::path> files;
    for (const Planned& planned : plan) {
        const auto [other, is_new] = files.emplace(planned.folder, planned.file);
        if (!is_new)
            throw base::Error(
                base::ErrorCode::bad_input, planned.file.string() + ": /name",
                fmt::format("{} has the same name, and so the same folder of results, {}; rename one of them",
                            other->second.string(), planned.folder.string()));
    }
}

// If there are several scenarios, all are checked before the first runs.
std::vector<Planned> make_plan(const RunArguments& arguments, const std::vector<fs::path>& files, bool several,
                               std::ostream& err) {
    std::vector<Planned> plan;
    if (!several) {
        Job job = read_job(arguments, files[0]);
        fs::path folder = results_folder(arguments.out, several, *job.document);
        plan.push_back({arguments.scenarios[0], files[0], std::move(job), std::move(folder)});
        return plan;
    }
    ProgressBar bar(err);
    for (const fs::path& file : files) {
        bar.show({file.filename().string(), "check", plan.size(), files.size()});
        try {
            Job job = read_job(arguments, file);
            bench::validate(*job.document, job.options);
            fs::path folder = results_folder(arguments.out, several, *job.document);
            plan.push_back({file.string(), file, std::move(job), std::move(folder)});
        } catch (const base::Error& error) {
            throw in_file(error, file);
        }
    }
    refuse_equal_names(plan);
    return plan;
}

// With the number and the name of the scenario in front, if there are several.
bench::Progress placed(bench::Progress progress, const std::string& place) {
    if (!place.empty()) progress.place = place + (progress.place.empty() ? "" : " ") + progress.place;
    return progress;
}

results::Result run_one(const Planned& planned, const std::string& place, std::ostream& err) {
    ProgressBar bar(err);
    return bench::run(*planned.job.document, planned.job.options,
                      [&](const bench::Progress& progress) { bar.show(placed(progress, place)); });
}

// The command that draws what --pictures draws.
std::string drawing_command(const RunArguments& arguments, const Planned& planned) {
    RunArguments one = arguments;
    one.scenarios = {planned.name};
    std::string command = "shadowbench render";
    for (const std::string& word : arguments_again(one)) command += " " + base::shell_word(word);
    return command + " --out " + base::shell_word(pictures_folder(planned.folder).string());
}

// Draws the pictures of a result that is written, if they were asked for. An error costs only them: the other scenarios
// run, and the first error is kept.
PicturesSaid add_pictures(const RunArguments& arguments, const Planned& planned, const std::string& place,
                          std::ostream& err, std::optional<base::Error>& first_error) {
    PicturesSaid said;
    if (!has_view(*document::expand(*planned.job.document).front().document)) {
        if (arguments.pictures) said.fault = "the scene has no objects for a camera to see";
        return said;
    }
    said.command = drawing_command(arguments, planned);
    if (!arguments.pictures) return said;
    std::optional<base::Error> fault;
    try {
        ProgressBar bar(err);
        fault = draw_pictures(*planned.job.document, planned.job.options, pictures_folder(planned.folder),
                              [&](const bench::Progress& progress) { bar.show(placed(progress, place)); });
    } catch (const base::Error& error) {
        fault = error;
    } catch (const std::bad_alloc&) {
        fault = base::Error(base::ErrorCode::internal, "pictures", "out of memory; use a smaller view");
    }
    if (!fault) return said;
    said.fault = fault->what();
    if (!first_error) first_error = in_file(*fault, planned.file);
    return said;
}

// Validates a document. Writes all its faults but the last to `err` and throws that one.
bench::Validated check(const Job& job, std::ostream& err) {
    try {
        ProgressBar bar(err);
        return bench::validate(*job.document, job.options,
                               [&](const bench::Progress& progress) { bar.show(progress); });
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::bad_input) throw;
        const std::vector<base::Error> faults = document::all_faults(*job.document, error);
        for (std::size_t i = 0; i + 1 < faults.size(); ++i) err << fmt::format("shadowbench: {}\n", faults[i].what());
        throw faults.back();
    }
}

}  // namespace

bool run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
    std::vector<fs::path> scenarios;
    bool several = arguments.scenarios.size() > 1;
    for (const std::string& name : arguments.scenarios) {
        const FoundScenarios found = find_scenarios(name);
        several = several || found.folder;
        scenarios.insert(scenarios.end(), found.files.begin(), found.files.end());
    }
    Output output(arguments.output, several, out, err);
    const std::vector<Planned> plan = make_plan(arguments, scenarios, several, output.progress());
    // Folders are made before hours of work. A run that fails leaves no new folder.
    base::Undo made_for_verdicts;
    const fs::path verdicts = verdicts_file(arguments.verdicts, arguments.out, several);
    if (verdicts.has_parent_path()) base::make_writable(verdicts.parent_path(), made_for_verdicts);
    if (!verdicts.empty()) {
        const base::PendingFile writable(verdicts);
    }
    std::deque<base::Undo> made;
    for (const Planned& planned : plan) base::make_writable(planned.folder, made.emplace_back());

    std::vector<results::ScenarioOutcome> outcomes;
    std::optional<base::Error> first_error;
    bool kept = true;
    PicturesSaid said;
    for (std::size_t i = 0; i < plan.size(); ++i) {
        const Planned& planned = plan[i];
        const std::string place =
            several ? fmt::format("{}/{} {}", i + 1, plan.size(), planned.folder.filename().string()) : "";
        try {
            outcomes.push_back({run_one(planned, place, output.progress()), ""});
        } catch (const base::Error& error) {
            if (!several) throw;
            // Validation could not find this. The other scenarios run.
            if (!first_error) first_error = in_file(error, planned.file);
            outcomes.push_back(without_result(*planned.job.document, error.what()));
            continue;
        }
        const results::Result& result = outcomes.back().result;
        results::write_result(planned.folder, result);
        made[i].keep();
        kept = kept && !results::any_failed(result);
        output.add(result);
        said = add_pictures(arguments, planned, place, output.progress(), first_error);
        if (several) conclude(result, planned.folder, said, output);
    }
    report_outcomes(outcomes, several, verdicts, output);
    if (!several) conclude(outcomes[0].result, plan[0].folder, said, output);
    output.end();
    made_for_verdicts.keep();
    if (first_error) throw *first_error;
    return kept;
}

void validate_command(const ScenarioArguments& arguments, std::ostream& out, std::ostream& err) {
    const Job job = read_job(arguments);
    const bench::Validated validated = check(job, err);
    out << fmt::format("OK {}: {} variant{} of {} light{} and {} technique{}\n", validated.name, validated.variants,
                       validated.variants == 1 ? "" : "s", validated.lights, validated.lights == 1 ? "" : "s",
                       validated.techniques, validated.techniques == 1 ? "" : "s");
    for (const std::string& file : validated.files) out << "file: " << file << "\n";
    for (const std::string& note : validated.notes) out << terminal_lines("note: " + note + "\n", out);
    for (const techniques::Technique& row : techniques::all())
        if (!row.library.fault.empty())
            out << terminal_lines(fmt::format("note: technique {}, from {}, will fail: {}\n", row.id, row.library.file,
                                              row.library.fault),
                                  out);
    for (const std::string& light : validated.blind)
        out << terminal_lines(
            fmt::format("note: light {} sees nothing that casts a shadow: no caster is inside its map and "
                        "behind its near plane\n",
                        light),
            out);
}

}  // namespace shadowbench::service

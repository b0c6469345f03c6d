#include <memory>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "bench/document.h"
#include "bench/report.h"
#include "bench/run.h"
#include "bench/write_result.h"
#include "service/cli/commands.h"
#include "service/cli/progress_bar.h"
#include "service/cli/scenario_files.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

struct Job {
    nlohmann::json document;
    bench::RunOptions options;
};

Job read_job(const ScenarioArguments& arguments) {
    const fs::path file = find_scenario(arguments.scenario);
    Job job;
    job.document = scene::parse_json(base::read_text(file), file.string());
    for (const std::string& assignment : arguments.set) bench::set_value(job.document, assignment);
    job.options.data = data_path(arguments.data, file);
    job.options.only = arguments.only;
    job.options.threads = arguments.threads;
    job.options.limits.all = static_cast<std::size_t>(arguments.memory_limit * 1024.0 * 1024.0 * 1024.0);
    job.options.limits.kept_rays = std::min(job.options.limits.kept_rays, job.options.limits.all / 2);
    return job;
}

// The folder of results: as told, or by the scenario's name once the document has one.
fs::path result_folder(const RunArguments& arguments, const nlohmann::json& document) {
    if (!arguments.out.empty()) return arguments.out;
    const auto name = document.is_object() ? document.find("name") : document.end();
    const bool named = name != document.end() && name->is_string() && !name->get_ref<const std::string&>().empty();
    return fs::path("results/runs") / (named ? fs::path(name->get<std::string>()).filename() : fs::path("unnamed"));
}

}  // namespace

bool run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
    const Job job = read_job(arguments);
    const fs::path folder = result_folder(arguments, job.document);
    bench::Undo made;  // a run that fails leaves no folder
    bench::make_writable(folder, made);

    std::unique_ptr<ProgressBar> bar;
    if (is_terminal(err)) bar = std::make_unique<ProgressBar>(err);
    const bench::Result result = bench::run(job.document, job.options, [&](const bench::Progress& progress) {
        if (bar) bar->show(progress);
    });
    bar.reset();
    bench::write_result(folder, result);
    made.keep();
    out << bench::to_table(result) << fmt::format("written: {0}/result.json, {0}/result.csv\n", folder.string());
    return !bench::any_failed(result);
}

void validate_command(const ScenarioArguments& arguments, std::ostream& out) {
    const Job job = read_job(arguments);
    const bench::Validated validated = bench::validate(job.document, job.options);
    out << fmt::format("OK {}: {} variant{} of {} light{} and {} technique{}\n", validated.name, validated.variants,
                       validated.variants == 1 ? "" : "s", validated.lights, validated.lights == 1 ? "" : "s",
                       validated.techniques, validated.techniques == 1 ? "" : "s");
}

}  // namespace shadowbench::service

#include <memory>
#include <ostream>

#include <fmt/format.h>

#include "bench/report.h"
#include "bench/run.h"
#include "bench/write_result.h"
#include "service/cli/commands.h"
#include "service/cli/job.h"
#include "service/cli/progress_bar.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

bool run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
    const Job job = read_job(arguments);
    const fs::path folder = output_folder(arguments.out, "results/runs", *job.document);
    bench::Undo made;  // a run that fails leaves no folder
    bench::make_writable(folder, made);

    std::unique_ptr<ProgressBar> bar;
    if (is_terminal(err)) bar = std::make_unique<ProgressBar>(err);
    const bench::Result result = bench::run(*job.document, job.options, [&](const bench::Progress& progress) {
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
    const bench::Validated validated = bench::validate(*job.document, job.options);
    out << fmt::format("OK {}: {} variant{} of {} light{} and {} technique{}\n", validated.name, validated.variants,
                       validated.variants == 1 ? "" : "s", validated.lights, validated.lights == 1 ? "" : "s",
                       validated.techniques, validated.techniques == 1 ? "" : "s");
}

}  // namespace shadowbench::service

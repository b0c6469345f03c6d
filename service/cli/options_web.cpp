#include <memory>
#include <ostream>

#include <CLI/CLI.hpp>

#include "service/cli/commands.h"
#include "service/cli/options.h"

namespace shadowbench::service {

void add_web_commands(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<ReportArguments>();
    CLI::App* report = app.add_subcommand("report", "Write a result as one HTML file with plots and pictures");
    set_help(*report, command_groups::files,
             {"report results/runs/quickstart", "report results/runs/quickstart --images results/images/quickstart", "report results/machines"},
             "Of a folder whose folders hold results, as results/machines has them (<machine>/<date>.json), it makes one\n"
             "page with the times of all machines.");
    report->add_option("RESULT_DIR", arguments->folder, "The folder with result.json, which run wrote, or a folder of machines")->required();
    report->add_option("--images", arguments->images,
                       "The folder with images.json, which render wrote [RESULT_DIR/images]");
    report->add_option("--out", arguments->out, "The file to write [RESULT_DIR/report.html]");
    commands.push_back({report, [arguments](std::ostream& out, std::ostream&) {
                            report_command(*arguments, out);
                            return 0;
                        }});
}

}  // namespace shadowbench::service

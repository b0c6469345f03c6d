#include <ctime>
#include <optional>
#include <ostream>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest.h"
#include "base/write_files.h"
#include "claims/paper.h"
#include "claims/quick.h"
#include "claims/report.h"
#include "results/machine.h"
#include "results/program.h"
#include "results/write_result.h"
#include "service/cli/commands.h"
#include "service/cli/progress_bar.h"
#include "service/cli/scenario_files.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

std::vector<const claims::Paper*> chosen(const std::string& name) {
    std::vector<const claims::Paper*> papers;
    std::vector<std::string> names{"all"};
    for (const claims::Paper& paper : claims::all_papers()) {
        if (name == "all" || name == paper.id) papers.push_back(&paper);
        names.push_back(paper.id);
    }
    if (papers.empty())
        throw base::Error(base::ErrorCode::usage, "reproduce",
                          fmt::format("unknown paper \"{}\"{}; there are: {}", name, base::perhaps(name, names),
                                      fmt::join(names, ", ")));
    return papers;
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm date{};
    gmtime_r(&now, &date);
    return fmt::format("{:04}-{:02}-{:02}", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

claims::Conditions conditions_of(bool quick) {
    const results::Machine machine = results::this_machine();
    const results::Program build = results::this_program();
    return {quick, fmt::format("{}, {} logical cores", machine.cpu, machine.logical_cores),
            fmt::format("shadowbench {} ({}, {}, {})", build.version, build.commit, build.compiler, build.build_type),
            today()};
}

// The full report in this folder beside which a quick one of these papers stands, and its name.
struct Beside {
    std::optional<claims::FullReport> full;
    std::string name;
};

Beside find_full_report(const fs::path& folder, const std::string& papers) {
    for (const std::string& name : {papers, std::string("papers")}) {
        const fs::path file = folder / (name + ".json");
        if (!fs::exists(file)) continue;
        claims::FullReport full = claims::read_full_report(file);
        const std::string text = fmt::format("the full report {}.json of {}", name, full.date);
        return {std::move(full), text};
    }
    return {};
}

}  // namespace

void reproduce_command(const ReproduceArguments& arguments, std::ostream& out, std::ostream& err) {
    const std::vector<const claims::Paper*> papers = chosen(arguments.paper);
    const fs::path folder = arguments.out.empty() ? fs::path("results") : fs::path(arguments.out);
    const std::string of_papers = papers.size() > 1 ? "papers" : papers.front()->id;
    const std::string name = of_papers + (arguments.quick ? "_quick" : "");
    const Beside beside = arguments.quick ? find_full_report(folder, of_papers) : Beside{};
    base::Undo made;
    base::make_writable(folder, made);

    claims::Context context;
    context.scenarios = find_scenario("papers/reeves1987_sphere").parent_path();  // the others lie beside it
    context.data = data_path(arguments.data, context.scenarios / "papers.json");
    context.quick = arguments.quick;
    context.threads = arguments.threads;
    std::vector<claims::PaperReport> reports;
    for (const claims::Paper* paper : papers) {
        ProgressBar bar(err);
        context.progress = [&](const bench::Progress& progress) { bar.show(progress); };
        reports.push_back(claims::measure(*paper, context));
        bar.end();
        if (beside.full) claims::stand_beside(*beside.full, reports.back());
        out << reports.back().title << "\n";
        for (const claims::Claim& claim : reports.back().claims)
            out << fmt::format("  {:<18}  {}: {}; here {}\n", to_string(claim.judged.verdict), claim.place, claim.says,
                               claim.measured);
        out.flush();
    }
    claims::Conditions conditions = conditions_of(arguments.quick);
    conditions.beside = beside.name;
    claims::write_reports(folder, name, reports, conditions);
    made.keep();
    if (const std::string steal = claims::steal_line(reports); !steal.empty()) out << steal << "\n";
    out << fmt::format("written: {0}/{1}.md, {0}/{1}.json, {0}/plots\n", folder.string(), name);
}

}  // namespace shadowbench::service

#include <filesystem>
#include <map>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/temporary_folder.h"
#include "base/write_files.h"
#include "bench/run.h"
#include "results/portable.h"
#include "results/report.h"
#include "results/write_result.h"
#include "service/cli/child.h"
#include "service/cli/job.h"
#include "service/cli/kernel_commands.h"
#include "service/cli/scenario_files.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

std::vector<fs::path> files_of(const std::vector<std::string>& names) {
    std::vector<fs::path> files;
    for (const std::string& name : names) {
        const FoundScenarios found = find_scenarios(name);
        files.insert(files.end(), found.files.begin(), found.files.end());
    }
    return files;
}

// Whether all techniques kept their promises.
bool add_scenario(const fs::path& scenario, int threads, const fs::path& folder, std::vector<base::NewFile>& files) {
    JobArguments arguments;
    arguments.threads = threads;
    const Job job = read_job(arguments, scenario);
    nlohmann::json document = *job.document;
    if (document.is_object()) results::make_portable_document(document);
    const results::Result result = bench::run(document, job.options, {});
    nlohmann::ordered_json portable = results::to_json(result);
    results::make_portable_result(portable);
    const fs::path file = folder / (result.name + ".json");
    for (const base::NewFile& other : files)
        if (other.path == file)
            throw Error(ErrorCode::bad_input, scenario.string() + ": /name",
                        fmt::format("another scenario has the name {} too; rename one of them", result.name));
    files.push_back({file, portable.dump(1) + "\n"});
    return !results::any_failed(result);
}

bool add_kernels(const std::string& given, const fs::path& folder, std::vector<base::NewFile>& files) {
    const std::string program = kernel_program(given);
    const EndingSignals signals;
    const base::TemporaryFolder temporary;
    const fs::path counts = temporary.path() / "kernels.json", log = temporary.path() / "log";
    const int code = run_child(program, {"--exact=" + counts.string()}, log);
    if (code != 0 && code != wrong_answer)
        throw Error(ErrorCode::internal, program,
                    fmt::format("ended with exit code {}: {}", code, base::read_text(log)));
    files.push_back({folder / "kernels.json", base::read_text(counts)});
    return code == 0;
}

}  // namespace

bool baseline_command(const BaselineArguments& arguments, std::ostream& out) {
    std::vector<base::NewFile> files;
    bool kept = add_kernels(arguments.kernels, arguments.out, files);
    for (const fs::path& scenario : files_of(arguments.scenarios)) {
        try {
            kept = add_scenario(scenario, arguments.threads, arguments.out, files) && kept;
        } catch (const Error& error) {
            throw Error(error.code(), scenario.string() + (error.where().empty() ? "" : ": " + error.where()),
                        error.message());
        }
    }
    base::write_files(files);
    for (const base::NewFile& file : files) out << fmt::format("written: {}\n", file.path.string());
    if (!kept)
        out << "a technique or a kernel broke its promise; see \"reason\" and \"error_message\" in these files\n";
    return kept;
}

}  // namespace shadowbench::service

#include "service/cli/swept_scenarios.h"

#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/cell_runner.h"
#include "service/cli/libraries.h"
#include "service/cli/scenario_files.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

std::vector<Swept> read_swept(const RunArguments& arguments) {
    std::vector<Swept> swept;
    std::map<std::string, fs::path> names;
    for (const std::string& name : arguments.scenarios) {
        const FoundScenarios found = find_scenarios(name);
        for (const fs::path& file : found.files) {
            try {
                Job job = read_job(arguments, file);
                bench::cells_of(*job.document, arguments.only);
                swept.push_back({file, std::move(job)});
            } catch (const base::Error& error) {
                throw in_file(error, file);
            }
            const auto [other, is_new] = names.emplace(swept.back().job.document->at("name").get<std::string>(), file);
            if (!is_new)
                throw base::Error(base::ErrorCode::bad_input, file.string() + ": /name",
                                  other->second.string() + " has the same name; rename one of them");
        }
    }
    return swept;
}

std::vector<std::string> arguments_again(const RunArguments& arguments) {
    std::vector<std::string> again = arguments.scenarios;
    for (std::string& word : arguments_again(static_cast<const JobArguments&>(arguments)))
        again.push_back(std::move(word));
    return again;
}

std::vector<std::string> arguments_again(const JobArguments& arguments) {
    std::vector<std::string> again;
    const auto add = [&](const char* option, const std::vector<std::string>& values) {
        for (const std::string& value : values) again.insert(again.end(), {option, value});
    };
    add("--set", arguments.set);
    add("--data", arguments.data);
    add("--only", arguments.only);
    if (arguments.threads != 0) add("--threads", {std::to_string(arguments.threads)});
    for (const std::string& argument : library_arguments(arguments.libraries)) again.push_back(argument);
    if (arguments.memory_limit != JobArguments().memory_limit)
        add("--memory-limit", {fmt::format("{}", arguments.memory_limit)});
    return again;
}

Sweep sweep_of(const std::vector<Swept>& swept, const RunArguments& arguments) {
    Sweep sweep;
    for (const Swept& one : swept) sweep.scenarios.push_back(one.job.document);
    sweep.only = arguments.only;
    sweep.arguments = arguments_again(arguments);
    return sweep;
}

}  // namespace shadowbench::service

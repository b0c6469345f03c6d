#include "service/cli/scenario_files.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest.h"
#include "base/shell_word.h"
#include "scene/data_file.h"
#include "scene/named_scenarios.h"
#include "service/cli/this_program.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

std::vector<fs::path> folders_of(const char* variable) {
    std::vector<fs::path> folders;
    const char* value = std::getenv(variable);
    std::istringstream list(value ? value : "");
    for (std::string folder; std::getline(list, folder, ':');)
        if (!folder.empty()) folders.emplace_back(folder);
    return folders;
}

// The folder in which `cmake --install` puts scenarios, relative to the program's file and so for any prefix.
fs::path installed_scenarios() {
    return (fs::path(this_program()).parent_path() / SHADOWBENCH_SHARE_FROM_PROGRAM / "scenarios").lexically_normal();
}

std::vector<fs::path> scenarios_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored))
        if (entry->is_regular_file(ignored) && entry->path().extension() == ".json") files.push_back(entry->path());
    std::sort(files.begin(), files.end());
    return files;
}

// The folder that a name means, or an empty path.
fs::path scenario_folder(const std::string& name) {
    std::error_code ignored;
    if (fs::is_directory(name, ignored)) return name;
    for (const fs::path& folder : scenario_folders())
        if (fs::is_directory(folder / name, ignored)) return folder / name;
    return {};
}

// A data file is no scenario. Text may be one.
void refuse_data(const fs::path& file) {
    const scene::FileFormat* format = scene::format_of_name(file);
    if (!format || format->extension == ".txt") return;
    throw Error(
        ErrorCode::bad_input, file.string(),
        fmt::format("this is a data file ({}); make a scenario around it: shadowbench new {} --out scenario.json",
                    format->title, base::shell_word(file.string())));
}

std::vector<std::string> known_names(const std::vector<fs::path>& folders) {
    std::vector<std::string> names;
    for (const scene::NamedScenario& scenario : scene::list_scenarios(folders)) {
        names.push_back(scenario.name);
        names.push_back(scenario.file.stem().string());
    }
    return names;
}

}  // namespace

std::vector<fs::path> scenario_folders() {
    std::vector<fs::path> folders{"scenarios"};
    for (const fs::path& folder : folders_of("SHADOWBENCH_SCENARIOS")) folders.push_back(folder);
    std::error_code ignored;
    const fs::path installed = installed_scenarios();
    if (fs::is_directory(installed, ignored)) folders.push_back(installed);
    return folders;
}

fs::path find_scenario(const std::string& name) {
    std::error_code ignored;
    if (fs::is_regular_file(name, ignored)) {
        refuse_data(name);
        return name;
    }
    const std::vector<fs::path> folders = scenario_folders();
    if (fs::path found = scene::find_scenario(folders, name); !found.empty()) return found;
    if (const fs::path folder = scenario_folder(name); !folder.empty())
        throw Error(ErrorCode::no_such_file, name,
                    scenarios_in(folder).empty() ? "this is a folder without scenarios (*.json)"
                                                 : "this is a folder; name one of the scenarios (*.json) in it");
    std::string looked_in;
    for (const fs::path& folder : folders) looked_in += ", " + folder.string();
    throw Error(ErrorCode::no_such_file, name,
                "there is no such file, and no scenario of this name" + base::perhaps(name, known_names(folders)) +
                    ", in" + looked_in.substr(1));
}

FoundScenarios find_scenarios(const std::string& name) {
    try {
        return {{find_scenario(name)}, false};
    } catch (const Error&) {
        const fs::path folder = scenario_folder(name);
        if (folder.empty()) throw;
        FoundScenarios found{scenarios_in(folder), true};
        if (found.files.empty())
            throw Error(ErrorCode::no_such_file, folder.string(), "this is a folder without scenarios (*.json)");
        return found;
    }
}

scene::SearchPath data_path(const std::vector<std::string>& given, const fs::path& scenario) {
    scene::SearchPath path;
    std::error_code ignored;
    for (const std::string& folder : given) {
        if (!fs::is_directory(folder, ignored))
            throw Error(ErrorCode::no_such_file, "--data " + folder, "there is no such folder");
        path.folders.emplace_back(folder);
    }
    for (const fs::path& folder : folders_of("SHADOWBENCH_DATA")) path.folders.push_back(folder);
    const fs::path own = scenario.has_parent_path() ? scenario.parent_path() : fs::path(".");
    path.folders.insert(path.folders.end(), {own, own / "data", "scenarios/data"});
    return path;
}

}  // namespace shadowbench::service

#include "service/cli/libraries.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "techniques/external/load.h"
#include "techniques/technique.h"

namespace shadowbench::service {

void load_libraries(const LibraryArguments& libraries) {
    for (const std::string& file : libraries.files) techniques::load_library(file);
}

std::vector<std::string> arguments_of(const LibraryArguments& libraries) {
    std::vector<std::string> arguments;
    for (const std::string& file : libraries.files)
        arguments.insert(arguments.end(), {"--technique-library", std::filesystem::absolute(file).string()});
    if (libraries.isolate)
        arguments.insert(arguments.end(), {"--isolate", "--call-seconds", fmt::format("{}", libraries.call_seconds)});
    return arguments;
}

bool same_libraries(const results::Result& result) {
    const auto same = [](const results::Cell& cell) {
        for (const techniques::Technique& row : techniques::all()) {
            if (cell.technique != row.id) continue;
            const techniques::Library& own = row.library;
            if (own.file.empty()) return !cell.library;
            return cell.library && cell.library->file == own.file && cell.library->hash == own.hash;
        }
        return true;  // the scenario has it no more
    };
    for (const results::VariantResult& variant : result.variants)
        for (const results::LightResult& light : variant.lights)
            if (!std::all_of(light.cells.begin(), light.cells.end(), same)) return false;
    return true;
}

}  // namespace shadowbench::service

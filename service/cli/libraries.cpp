#include "service/cli/libraries.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash_text.h"
#include "service/cli/this_program.h"
#include "service/isolation/isolated.h"
#include "techniques/external/load.h"
#include "techniques/technique.h"

namespace shadowbench::service {

void load_libraries(const LibraryArguments& libraries, double memory_limit) {
    const double granted = memory_limit > 0.0 ? std::max(memory_limit, 1.0) : 0.0;  // the program itself needs some
    const auto memory = static_cast<std::size_t>(granted * 1024.0 * 1024.0 * 1024.0);
    for (const std::string& file : libraries.files) {
        if (!libraries.isolate) {
            techniques::load_library(file);
            continue;
        }
        static const HeldProgram program;  // for as long as rows start it
        techniques::load_library(file, [&](const std::filesystem::path& opened) {
            return open_isolated(opened, {program.path(), libraries.call_seconds, memory});
        });
    }
}

std::vector<std::string> libraries_in(const std::string& folder) {
    std::error_code failed;
    std::vector<std::string> files;
    for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (at->path().extension() == ".so" && at->is_regular_file())
            files.push_back(std::filesystem::absolute(at->path()).string());
    if (failed)
        throw base::Error(base::ErrorCode::no_such_file, "--technique-libraries " + folder,
                          "the folder cannot be read: " + failed.message());
    std::sort(files.begin(), files.end());
    return files;
}

std::string hash_of_libraries() {
    std::string text;
    for (const techniques::Technique& row : techniques::all()) text += row.library.hash;
    return text.empty() ? "" : base::hash_text(text);
}

std::vector<std::string> library_arguments(const LibraryArguments& libraries) {
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
            return cell.library && cell.library->file == own.file && cell.library->hash == own.hash &&
                   cell.library->isolated == own.isolated;
        }
        return true;  // the scenario has it no more
    };
    for (const results::VariantResult& variant : result.variants)
        for (const results::LightResult& light : variant.lights)
            if (!std::all_of(light.cells.begin(), light.cells.end(), same)) return false;
    return true;
}

}  // namespace shadowbench::service

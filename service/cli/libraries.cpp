#include "service/cli/libraries.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash_text.h"
#include "service/cli/this_program.h"
#include "service/isolation/isolated.h"
#include "techniques/external/library.h"
#include "techniques/external/load.h"
#include "techniques/technique.h"

namespace shadowbench::service {

void load_libraries(const LibraryArguments& libraries, double memory_limit) {
    for (const std::string& text : libraries.unusable) {
        const std::size_t end = text.rfind('\n');
        if (end == std::string::npos)
            throw base::Error(base::ErrorCode::usage, "--unusable-library",
                              "expected a file, a line break and a reason");
        techniques::load_library(text.substr(0, end),
                                 [&](const std::filesystem::path& file) -> techniques::OpenLibrary {
                                     throw base::Error(base::ErrorCode::internal, file.string(), text.substr(end + 1));
                                 });
    }
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
    if (libraries.isolate && !libraries.files.empty())
        arguments.insert(arguments.end(), {"--isolate", "--call-seconds", fmt::format("{}", libraries.call_seconds)});
    for (const std::string& text : libraries.unusable) arguments.push_back("--unusable-library=" + text);
    return arguments;
}

std::vector<UnusableLibrary> part_unusable(LibraryArguments& libraries) {
    std::vector<UnusableLibrary> unusable;
    std::erase_if(libraries.files, [&](const std::string& file) {
        const techniques::Library library = techniques::identify(file);
        for (const techniques::Technique& row : techniques::all()) {
            if (row.library.file != library.file || row.library.hash != library.hash || row.library.fault.empty())
                continue;
            std::string reason = row.library.fault;
            std::replace(reason.begin(), reason.end(), '\n', ' ');
            libraries.unusable.push_back(std::filesystem::absolute(file).string() + "\n" + reason);
            unusable.push_back({file, reason});
            return true;
        }
        return false;
    });
    return unusable;
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

#include "scene/named_scenarios.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "scene/scenario.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;

struct Entry {
    std::string own_name;  // empty: none
    std::string path;      // in its folder, without ".json"
    std::string purpose, fault;
    fs::path file;
};
using Folder = std::vector<Entry>;  // by path

std::string text_at(const nlohmann::json& document, const char* key) {
    const auto found = document.find(key);
    return found != document.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Entry read(const fs::path& folder, const fs::path& file) {
    Entry entry;
    entry.path = file.lexically_relative(folder).replace_extension().generic_string();
    entry.file = file;
    try {
        const nlohmann::json document = parse_json(base::read_text(file), file.string());
        if (!document.is_object()) return entry;
        entry.own_name = text_at(document, "name");
        entry.purpose = text_at(document, "purpose");
    } catch (const std::exception& error) {  // one broken file does not hide the others
        entry.fault = error.what();
    }
    return entry;
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
        if (entry->is_directory(ignored) && entry->path().filename() == "data") entry.disable_recursion_pending();
        if (entry->is_regular_file(ignored) && entry->path().extension() == ".json") files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

Folder read_folder(const fs::path& folder) {
    Folder entries;
    for (const fs::path& file : files_in(folder)) entries.push_back(read(folder, file));
    return entries;
}

// The file with this path in the folder, with or without ".json", or an empty path.
fs::path file_at(const fs::path& folder, const std::string& name) {
    std::error_code ignored;
    for (const std::string& path : {name, name + ".json"})
        if (fs::is_regular_file(folder / path, ignored)) return folder / path;
    return {};
}

fs::path named_file(const Folder& entries, const std::string& name) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.own_name == name; });
    return found == entries.end() ? fs::path() : found->file;
}

}  // namespace

std::vector<NamedScenario> list_scenarios(std::span<const fs::path> folders) {
    std::vector<Folder> all;
    for (const fs::path& folder : folders) all.push_back(read_folder(folder));
    const auto finds = [&](const std::string& name, const fs::path& file) {
        if (name.empty()) return false;
        for (std::size_t f = 0; f < all.size(); ++f) {
            fs::path found = file_at(folders[f], name);
            if (found.empty()) found = named_file(all[f], name);
            if (!found.empty()) return found == file;
        }
        return false;
    };
    std::vector<NamedScenario> list;
    for (const Folder& folder : all)
        for (const Entry& entry : folder) {
            std::string name = finds(entry.own_name, entry.file) ? entry.own_name : entry.path;
            if (finds(name, entry.file)) list.push_back({std::move(name), entry.purpose, entry.file, entry.fault});
        }
    return list;
}

fs::path find_scenario(std::span<const fs::path> folders, const std::string& name) {
    if (name.empty()) return {};
    for (const fs::path& folder : folders) {
        fs::path found = file_at(folder, name);
        if (found.empty()) found = named_file(read_folder(folder), name);
        if (!found.empty()) return found;
    }
    return {};
}

}  // namespace shadowbench::scene

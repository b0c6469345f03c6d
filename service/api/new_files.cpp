#include "service/api/new_files.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_pointer.h"
#include "base/utf8.h"
#include "document/document.h"
#include "scene/beside.h"
#include "scene/new_scenario.h"
#include "scene/scenario.h"
#include "techniques/technique.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using nlohmann::json;

constexpr std::size_t most_entries = 20'000;  // looked at in the data folders, so that one request costs little
constexpr std::size_t most_together = 16;     // files in one scenario
constexpr int deepest_folder = 8;
constexpr const char* notices[] = {"licence", "license", "copying", "readme", "notice", "changelog"};

std::string in_lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// A text beside data, which is no list of points.
bool is_notice(const fs::path& file) {
    const std::string name = in_lower_case(file.filename().string());
    return name.ends_with(".txt") && std::any_of(std::begin(notices), std::end(notices), [&](std::string_view word) {
               return name.starts_with(word) && (name[word.size()] == '.' || name[word.size()] == '-');
           });
}

bool is_read(const fs::path& file) {
    return !is_notice(file) && scene::format_of_name(file);
}

struct NewRequest {
    std::vector<std::string> files;
    scene::UpAxis up = scene::UpAxis::y;
};

[[noreturn]] void refuse_new(const std::string& where, const std::string& message) {
    throw Error(ErrorCode::bad_input, where, message);
}

NewRequest read_new(const std::string& text) {
    const json request = scene::parse_json(text, "body");
    if (!request.is_object()) refuse_new("/", "must be an object with the key files");
    NewRequest result;
    for (const auto& [key, value] : request.items()) {
        const std::string where = base::append_token("", key);
        if (key == "up") {
            if (value != "y" && value != "z") refuse_new(where, "must be \"y\" or \"z\"");
            if (value == "z") result.up = scene::UpAxis::z;
        } else if (key == "files") {
            if (!value.is_array()) refuse_new(where, "must be a list of names");
            for (const json& name : value) {
                if (!name.is_string()) refuse_new(fmt::format("{}/{}", where, result.files.size()), "must be a name");
                result.files.push_back(name.get<std::string>());
            }
        } else {
            refuse_new(where, "unknown key; the body has the keys files and up");
        }
    }
    if (result.files.empty() || result.files.size() > most_together)
        refuse_new("/files", fmt::format("must hold 1 to {} names of files in the data folders", most_together));
    return result;
}

}  // namespace

std::vector<std::string_view> fitting_techniques(std::span<const scene::DataFile> files) {
    const bool opaque = scene::is_opaque(files), traceable = !files[0].scene.deep_image;
    std::vector<std::string_view> types;
    for (const techniques::Technique& row : techniques::all()) {
        const techniques::Promises& promises = row.promises;
        const bool fits = opaque ? promises.localised : !promises.opaque_only && !promises.approximate;
        if (fits && (traceable || !row.traits.traces)) types.push_back(row.id);
    }
    return types;
}

DataFiles data_files(const std::vector<fs::path>& folders, std::size_t most, const fs::path& apart) {
    DataFiles found;
    std::size_t seen = 0;
    for (const fs::path& folder : folders) {
        std::error_code fault;
        fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, fault), end;
        for (; !fault && it != end; it.increment(fault)) {
            if (++seen > most_entries) {
                found.more = true;
                break;
            }
            if (it.depth() >= deepest_folder) it.disable_recursion_pending();
            std::error_code ignored;
            if (!apart.empty() && it->is_directory(ignored) && fs::equivalent(it->path(), apart, ignored)) {
                it.disable_recursion_pending();
                continue;
            }
            if (!is_read(it->path()) || !it->is_regular_file(ignored)) continue;
            if (it->is_symlink(ignored) && !scene::lies_in(it->path(), folder)) continue;
            const std::uintmax_t bytes = it->file_size(ignored);
            const std::string name = it->path().lexically_relative(folder).generic_string();
            if (!ignored && base::is_utf8(name)) found.files.push_back({name, bytes});
        }
    }
    const auto by_name = [](const NamedFile& a, const NamedFile& b) { return a.name < b.name; };
    std::stable_sort(found.files.begin(), found.files.end(), by_name);
    // A name means the file in the first folder that has it.
    const auto same = [](const NamedFile& a, const NamedFile& b) { return a.name == b.name; };
    found.files.erase(std::unique(found.files.begin(), found.files.end(), same), found.files.end());
    if (found.files.size() > most) {
        found.files.resize(most);
        found.more = true;
    }
    return found;
}

std::string scenario_around(const std::string& request, const std::vector<fs::path>& folders) {
    const NewRequest asked = read_new(request);
    const auto path = scene::SearchPath::confined_to(folders);
    std::vector<scene::DataFile> files;
    for (std::size_t i = 0; i < asked.files.size(); ++i)
        files.push_back(scene::read_data_file(scene::find_file(path, asked.files[i], fmt::format("/files/{}", i)), {}));
    const auto scenario = scene::new_scenario(files, asked.files, fitting_techniques(files), asked.up);
    const std::string text = scenario.dump();
    document::check_document(json::parse(text));
    return text;
}

}  // namespace shadowbench::service

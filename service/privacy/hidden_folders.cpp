#include "service/privacy/hidden_folders.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

bool separates_words(char c) {
    return std::string_view(" \t\r\n\"'`()[]{}<>,;|").find(c) != std::string_view::npos;
}

// "--data=/srv/data" and "file:/srv/data" begin a path too.
bool begins_path(const std::string& text, std::size_t at) {
    return at == 0 || separates_words(text[at - 1]) || text[at - 1] == '=' || text[at - 1] == ':';
}

// "/srv/data", "/srv/data:12", "/srv/data." at the end of a sentence; not "/srv/database" or "/srv/data.old".
bool ends_path(const std::string& text, std::size_t at) {
    if (at == text.size() || separates_words(text[at]) || text[at] == ':') return true;
    return text[at] == '.' && (at + 1 == text.size() || separates_words(text[at + 1]));
}

std::size_t behind_slashes(const std::string& text, std::size_t at) {
    while (at < text.size() && text[at] == '/') ++at;
    return at;
}

// The end of the folder's path if the text has it at this place. Any number of slashes counts as one.
std::optional<std::size_t> match(const std::string& text, std::size_t at, const std::string& path) {
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (at == text.size() || text[at] != path[i]) return std::nullopt;
        at = path[i] == '/' ? behind_slashes(text, at) : at + 1;
    }
    return at;
}

struct Replacement {
    std::size_t end;  // of what it replaces
    std::string text;
};

std::optional<Replacement> replace_folder(const std::string& text, std::size_t at,
                                          const std::vector<HiddenFolder>& folders) {
    for (const HiddenFolder& folder : folders) {
        const std::optional<std::size_t> end = match(text, at, folder.path);
        if (!end) continue;
        const std::size_t rest = behind_slashes(text, *end);
        if (rest > *end && !ends_path(text, rest)) return Replacement{rest, ""};
        // A relative name without a slash may be any word of the text.
        if (ends_path(text, rest) && (rest > *end || folder.path.find('/') != std::string::npos))
            return Replacement{rest, folder.name};
    }
    return std::nullopt;
}

std::optional<Replacement> keep_last_part(const std::string& text, std::size_t at) {
    if (text[at] != '/') return std::nullopt;
    std::size_t end = at;
    while (end < text.size() && !separates_words(text[end])) ++end;
    const std::string path = text.substr(at, end - at);
    if (behind_slashes(path, 0) == path.size()) return std::nullopt;  // " / "
    const std::size_t last = path.find_last_not_of('/');
    return Replacement{end, path.substr(path.rfind('/', last) + 1)};
}

void add(std::vector<HiddenFolder>& folders, const std::string& path, const char* name) {
    const auto add_form = [&](std::string form) {
        while (form.size() > 1 && form.back() == '/') form.pop_back();
        if (!form.empty() && form != "/" && form != ".") folders.push_back({std::move(form), name});
    };
    std::error_code failed;
    add_form(path);
    add_form(fs::path(path).lexically_normal().string());
    if (const fs::path absolute = fs::absolute(path, failed); !failed) {
        add_form(absolute.string());
        add_form(absolute.lexically_normal().string());
    }
    if (const fs::path real = fs::weakly_canonical(path, failed); !failed) add_form(real.string());
}

}  // namespace

std::vector<HiddenFolder> hidden_folders(const std::string& state, const std::vector<std::string>& data) {
    std::vector<HiddenFolder> folders;
    if (!state.empty()) add(folders, state, "the server's folder");
    for (const std::string& folder : data) add(folders, folder, "the data folder");
    std::stable_sort(folders.begin(), folders.end(),
                     [](const HiddenFolder& a, const HiddenFolder& b) { return a.path.size() > b.path.size(); });
    return folders;
}

std::string hide(const std::string& text, const std::vector<HiddenFolder>& folders, OtherPaths others) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        std::optional<Replacement> replacement;
        if (begins_path(text, at)) {
            replacement = replace_folder(text, at, folders);
            if (!replacement && others == OtherPaths::last_part) replacement = keep_last_part(text, at);
        }
        if (!replacement) {
            result += text[at++];
            continue;
        }
        result += replacement->text;
        at = replacement->end;
    }
    return result;
}

base::Error hide(const base::Error& error, const std::vector<HiddenFolder>& folders) {
    return {error.code(), hide(error.where(), folders), hide(error.message(), folders)};
}

}  // namespace shadowbench::service

#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/beside.h"
#include "scene/scenario.h"

namespace shadowbench::scene {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

namespace {

// The server's folders are not shown: of a name that begins with one of them, the rest is.
std::string way_out_text(const SearchPath& path, const std::string& name) {
    if (!fs::path(name).is_absolute())
        return fmt::format("\"{}\" must be a name inside the data folders, without ..", name);
    for (const fs::path& folder : path.folders) {
        const fs::path inside = fs::path(name).lexically_relative(folder);
        if (!inside.empty() && inside != "." && !names_way_out(inside.string()))
            return fmt::format(
                "the name is absolute; only names relative to the data folders are read here: write \"{}\"",
                inside.string());
    }
    return "the name is absolute; only names relative to the data folders are read here: put the file into one of "
           "them, and write its name from there";
}

fs::path find_confined(const SearchPath& path, const std::string& name, const std::string& where) {
    if (names_way_out(name)) throw Error(ErrorCode::bad_input, where, way_out_text(path, name));
    std::error_code ignored;
    for (const fs::path& folder : path.folders) {
        const fs::path file = folder / name;
        if (!fs::is_regular_file(file, ignored)) continue;
        if (lies_in(file, folder)) return file;
        throw Error(ErrorCode::bad_input, where,
                    fmt::format("\"{}\" leads out of the data folders; name a file inside them", name));
    }
    throw Error(ErrorCode::no_such_file, where, fmt::format("there is no file \"{}\" in the data folders", name));
}

}  // namespace

SearchPath SearchPath::confined_to(std::vector<fs::path> folders) {
    SearchPath path;
    path.folders = std::move(folders);
    path.confined = true;
    return path;
}

fs::path find_file(const SearchPath& path, const std::string& name, const std::string& where) {
    if (path.confined) return find_confined(path, name, where);
    std::error_code ignored;
    const fs::path relative(name);
    if (relative.is_absolute()) {
        if (fs::is_regular_file(relative, ignored)) return relative;
        throw Error(ErrorCode::no_such_file, where, fmt::format("there is no file \"{}\"", name));
    }
    std::string looked_in;
    for (const fs::path& folder : path.folders) {
        if (fs::is_regular_file(folder / relative, ignored)) return folder / relative;
        looked_in += (looked_in.empty() ? "" : ", ") + folder.string();
    }
    throw Error(ErrorCode::no_such_file, where,
                fmt::format("there is no file \"{}\"; looked in: {}", name,
                            looked_in.empty() ? "no folder (the search path is empty)" : looked_in));
}

}  // namespace shadowbench::scene

#include <fmt/format.h>

#include "base/error.h"
#include "scene/scenario.h"

namespace shadowbench::scene {

namespace fs = std::filesystem;

fs::path find_file(const SearchPath& path, const std::string& name, const std::string& where) {
    std::error_code ignored;
    const fs::path relative(name);
    if (relative.is_absolute()) {
        if (fs::is_regular_file(relative, ignored)) return relative;
        throw base::Error(base::ErrorCode::no_such_file, where, fmt::format("there is no file \"{}\"", name));
    }
    std::string looked_in;
    for (const fs::path& folder : path) {
        if (fs::is_regular_file(folder / relative, ignored)) return folder / relative;
        looked_in += (looked_in.empty() ? "" : ", ") + folder.string();
    }
    throw base::Error(base::ErrorCode::no_such_file, where,
                      fmt::format("there is no file \"{}\"; looked in: {}", name,
                                  looked_in.empty() ? "no folder (the search path is empty)" : looked_in));
}

}  // namespace shadowbench::scene

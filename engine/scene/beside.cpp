#include "scene/beside.h"

#include <algorithm>
#include <system_error>

namespace shadowbench::scene {

namespace fs = std::filesystem;

bool names_way_out(const std::string& name) {
    const fs::path path(name);
    return path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end() ||
           name.find('\0') != std::string::npos;
}

bool lies_in(const fs::path& file, const fs::path& folder) {
    std::error_code file_fault, folder_fault;
    const fs::path real = fs::canonical(file, file_fault), top = fs::canonical(folder, folder_fault);
    return !file_fault && !folder_fault &&
           std::mismatch(top.begin(), top.end(), real.begin(), real.end()).first == top.end();
}

Beside find_beside(const fs::path& file, const std::string& name) {
    if (name.empty() || names_way_out(name)) return {Beside::State::not_a_name};
    const fs::path found = file.parent_path() / name;
    std::error_code fault;
    if (!fs::is_regular_file(found, fault)) return {Beside::State::missing};
    const fs::path itself = fs::canonical(file, fault);  // a link lies in the folder that it leads to
    if (fault || !lies_in(found, itself.parent_path())) return {Beside::State::outside};
    return {Beside::State::found, found};
}

}  // namespace shadowbench::scene

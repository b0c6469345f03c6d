#include "scene/readers/beside.h"

#include <algorithm>
#include <system_error>

namespace shadowbench::scene {

Beside find_beside(const std::filesystem::path& file, const std::string& name) {
    namespace fs = std::filesystem;
    const fs::path path(name);
    const bool goes_up = std::find(path.begin(), path.end(), "..") != path.end();
    if (path.empty() || path.is_absolute() || goes_up || name.find('\0') != std::string::npos)
        return {Beside::State::not_a_name};
    const fs::path found = file.parent_path() / path;
    std::error_code fault, other_fault;
    if (!fs::is_regular_file(found, fault)) return {Beside::State::missing};
    const fs::path real = fs::canonical(found, fault), itself = fs::canonical(file, other_fault);
    const fs::path folder = itself.parent_path();
    const bool inside = std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end();
    if (fault || other_fault || !inside) return {Beside::State::outside};
    return {Beside::State::found, found};
}

}  // namespace shadowbench::scene

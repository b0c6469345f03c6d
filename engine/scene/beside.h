// Files that another file names: they must lie in its folder or below it, so that no file shows what other folders hold.
#pragma once

#include <filesystem>
#include <string>

namespace shadowbench::scene {

struct Beside {
    enum class State {
        found,
        not_a_name,  // absolute, or with .., or empty
        missing,     // or no regular file
        outside,     // a link leads out of the folder
    };
    State state = State::missing;
    std::filesystem::path file = {};  // if it is found
};
Beside find_beside(const std::filesystem::path& file, const std::string& name);

// Whether a name can lead out of the folder that it is looked up in: it is absolute, has .., or a zero byte.
bool names_way_out(const std::string& name);
// Resolves links first. False if either is not there.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace shadowbench::scene

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

}  // namespace shadowbench::scene

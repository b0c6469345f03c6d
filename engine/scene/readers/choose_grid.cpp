#include "scene/readers/choose_grid.h"

#include <algorithm>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::scene {
namespace {

struct Chooser {
    const std::filesystem::path& file;
    std::span<const VdbGridName> grids;

    [[noreturn]] void refuse(const std::string& message) const {
        std::string names;
        for (const VdbGridName& grid : grids) names += (names.empty() ? "" : ", ") + shown(grid);
        throw base::Error(base::ErrorCode::bad_input, file.string(),
                          fmt::format("{}; the grids are: {}", message, names.empty() ? "none" : names));
    }

    template <class Wanted>
    std::vector<std::size_t> all_that(const Wanted& wanted) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < grids.size(); ++i)
            if (wanted(grids[i])) found.push_back(i);
        return found;
    }

    std::size_t by_number(int number) const {
        if (number < 0 || static_cast<std::size_t>(number) >= grids.size())
            refuse(fmt::format("there is no grid number {}, counted from 0", number));
        return static_cast<std::size_t>(number);
    }

    std::size_t by_name(const std::string& name) const {
        const auto found = all_that([&](const VdbGridName& grid) {
            return grid.name == name || grid.unique_name == name || shown(grid) == name;
        });
        if (found.empty()) refuse(fmt::format("there is no grid \"{}\"", name));
        if (found.size() > 1)
            refuse(fmt::format("{} grids are called \"{}\": give \"grid\" as a number, from 0 on", found.size(), name));
        return found[0];
    }

    std::size_t without_key() const {
        if (!all_that([](const VdbGridName& grid) { return grid.name == usual_grid; }).empty())
            return by_name(usual_grid);
        const auto floats = all_that([](const VdbGridName& grid) { return grid.type == vdb_float_tree; });
        if (floats.empty()) refuse("the file has no grid of float values");
        if (floats.size() > 1)
            refuse(
                fmt::format("there is no grid \"{}\", and several others: give \"grid\", a name or a number from 0 "
                            "on",
                            usual_grid));
        return floats[0];
    }
};

}  // namespace

std::string shown(const VdbGridName& grid) {
    if (grid.name.empty()) return "(no name)";
    const std::size_t end = grid.unique_name.find(vdb_suffix);
    return end == std::string::npos ? grid.name : fmt::format("{}[{}]", grid.name, grid.unique_name.substr(end + 1));
}

std::size_t choose_grid(const std::filesystem::path& file, std::span<const VdbGridName> grids,
                        const GridChoice& choice) {
    const Chooser chooser{file, grids};
    std::size_t chosen = 0;
    if (const int* number = std::get_if<int>(&choice))
        chosen = chooser.by_number(*number);
    else if (const auto* name = std::get_if<std::string>(&choice))
        chosen = chooser.by_name(*name);
    else
        chosen = chooser.without_key();
    return chosen;
}

void note_grid(const VdbGridName& grid, std::span<const std::string> passed_over, float background, ReadNotes& notes) {
    constexpr std::size_t most_names = 8;
    const std::size_t others = passed_over.size();
    const auto named = passed_over.first(std::min(others, most_names));
    if (others > 0)
        notes.lines.push_back(fmt::format("the grid \"{}\" is read and {} passed over: {}{}", shown(grid), others,
                                          fmt::join(named, ", "), named.size() < others ? ", ..." : ""));
    else if (grid.name != usual_grid)
        notes.lines.push_back(fmt::format("the grid \"{}\" is read, the only one", shown(grid)));
    if (background > 0.0f)
        notes.lines.push_back(fmt::format(
            "the grid's background is {}, but outside the box of its active voxels there is no density", background));
}

}  // namespace shadowbench::scene

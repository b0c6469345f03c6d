// Parts of a pbrt scene, for the objects of a scenario that take them.
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/readers/pbrt_files.h"
#include "scene/readers/read_mesh.h"

namespace shadowbench::scene {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

MeshFile read_pbrt_mesh(const fs::path& file) {
    PbrtFile scene = read_pbrt(file);
    return {std::move(scene.mesh), std::move(scene.passed_over)};
}

GridVolume read_pbrt_medium(const fs::path& file, const GridChoice& choice) {
    PbrtFile scene = read_pbrt(file);
    const auto refuse_choice = [&](const std::string& message) {
        std::string names;
        for (const PbrtMedium& each : scene.media)
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", each.name);
        throw Error(ErrorCode::bad_input, file.string(),
                    fmt::format("{}; the media of the file: {}", message, names.empty() ? "none" : names));
    };
    std::size_t chosen = 0;
    if (const int* number = std::get_if<int>(&choice)) {
        if (*number < 0 || static_cast<std::size_t>(*number) >= scene.media.size())
            refuse_choice(fmt::format("there is no medium number {}, counted from 0", *number));
        chosen = static_cast<std::size_t>(*number);
    } else if (const auto* name = std::get_if<std::string>(&choice)) {
        while (chosen < scene.media.size() && scene.media[chosen].name != *name) ++chosen;
        if (chosen == scene.media.size()) refuse_choice(fmt::format("there is no medium \"{}\"", *name));
        const auto same = [&](const PbrtMedium& each) { return each.name == *name; };
        if (std::count_if(scene.media.begin(), scene.media.end(), same) > 1)
            refuse_choice("several grids have that name: give \"grid\" as a number, from 0 on");
    } else if (scene.media.size() != 1) {
        refuse_choice("give \"grid\", the name of a medium or its number from 0 on");
    }
    return std::move(scene.media[chosen].volume);
}

}  // namespace shadowbench::scene

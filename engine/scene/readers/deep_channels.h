// Finds the channels of a deep image's part that hold the depth and opacity of samples.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/read_notes.h"

namespace shadowbench::scene {

struct DeepChannels {
    std::array<int, 3> alpha{-1, -1, -1};  // of red, green and blue; one channel serves all colours that lack their own
    int z = -1, z_back = -1;               // z_back: -1 without one
};

// `layer` as in DeepChoice. Notes the other layers that could have been meant. Throws Error{bad_input}, place the file,
// with the layers or channels that exist, if none fits or several do.
DeepChannels find_deep_channels(const std::vector<std::string>& names, const std::optional<std::string>& layer,
                                const std::filesystem::path& file, ReadNotes& notes);

}  // namespace shadowbench::scene

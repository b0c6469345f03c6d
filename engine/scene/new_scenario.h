// Scenarios that are made around data files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scene/data_file.h"
#include "scene/stage.h"

namespace shadowbench::scene {

// What loads the file in a scenario, which calls it `name`: the objects that cast shadows, or the value of
// "deep_image". Hair is translucent. The optical depth is about 2 through a volume's densest column, along the axis
// where that is least, and through the middle of a point, except of media whose file states their extinction.
std::vector<nlohmann::ordered_json> scene_objects(const DataFile& data, const std::string& name);

// Whether only opaque surfaces cast shadows in a scenario around the files.
bool is_opaque(std::span<const DataFile> files);

// A scenario around the files, which it calls by `names`, with these types of techniques. An image becomes the alpha
// texture of the mesh before it, if that has texture coordinates, and else a quad of its own. A deep image stands
// alone. Throws Error, place the file: bad_input if nothing in it casts a shadow, its box is too large or too small, or
// its name is not UTF-8; usage if a deep image is not alone.
nlohmann::ordered_json new_scenario(std::span<const DataFile> files, std::span<const std::string> names,
                                    std::span<const std::string_view> techniques, UpAxis up);

}  // namespace shadowbench::scene

#include "claims/hand_made.h"

#include <nlohmann/json.hpp>

#include "rays/light_view.h"

namespace shadowbench::claims {

std::vector<float> look_up(const char* technique, const nlohmann::json& parameters, const rays::LightRays& tile,
                           float z_max, std::span<const techniques::Query> queries) {
    rays::MapLayout layout;
    layout.width = layout.tile_width = tile.width;
    layout.height = layout.tile_height = tile.height;
    layout.z_min = 0.0f;
    layout.z_max = z_max;
    const rays::LightView view;
    const techniques::Technique& row = techniques::find(technique, "");
    const auto map = row.create(techniques::read_parameters(row.parameters, parameters, ""));
    map->begin({layout, view, nullptr});
    map->add(tile);
    map->finish();
    std::vector<float> visibility(queries.size());
    map->lookup(queries, visibility);
    return visibility;
}

}  // namespace shadowbench::claims

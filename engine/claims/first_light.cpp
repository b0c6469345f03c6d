#include "claims/first_light.h"

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "rays/capture.h"

namespace shadowbench::claims {

FirstLight::FirstLight(const nlohmann::json& document, const scene::SearchPath& data)
    : variant(document::expand(document).front()),
      loader(data),
      scenario(loader.load(variant)),
      contenders(bench::make_contenders(scenario, variant)),
      light(bench::prepare_light(scenario, 0, contenders, {})) {}

std::vector<rays::LightRays> FirstLight::tiles() const {
    const rays::Capture capture(scenario.scene, light.view, light.layout);
    std::vector<rays::LightRays> all(static_cast<std::size_t>(light.layout.tiles()));
    base::parallel_for(all.size(), [&](std::size_t t) { all[t] = capture.tile(static_cast<int>(t)); });
    return all;
}

bench::Maps FirstLight::build(const bench::Contender& contender, std::span<const rays::LightRays> tiles) const {
    bench::Maps maps = bench::begin_maps(*contender.row, contender.values, input());
    base::parallel_for(tiles.size(), [&](std::size_t t) { bench::add(maps, tiles[t]); });
    bench::finish(maps);
    return maps;
}

}  // namespace shadowbench::claims

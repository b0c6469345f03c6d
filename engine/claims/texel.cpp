#include "claims/texel.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/contender.h"
#include "bench/load.h"
#include "bench/prepared_light.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "document/document.h"
#include "rays/capture.h"
#include "rays/light_view.h"

namespace shadowbench::claims {
namespace {

struct Place {
    std::size_t tile = 0, ray = 0;
    std::uint64_t segments = 0;
};

Place busiest(const std::vector<rays::LightRays>& tiles, const rays::MapLayout& layout) {
    const double half = 0.5 * (static_cast<double>(layout.z_min) + layout.z_max);
    Place best;
    for (std::size_t t = 0; t < tiles.size(); ++t)
        for (std::size_t r = 0; r < tiles[t].rays(); ++r) {
            const std::uint64_t segments = tiles[t].begin[r + 1] - tiles[t].begin[r];
            if (segments > best.segments && rays::transmittance(tiles[t], r, 0, half) > 0.3) best = {t, r, segments};
        }
    return best;
}

Series to_series(const std::string& name, const curves::Curve& curve, const rays::MapLayout& layout) {
    Series s{name, {{layout.z_min, curve.empty() ? 1.0 : curve.front().value}}, true};
    for (const curves::Vertex& v : curve) s.points.emplace_back(v.z, v.value);
    s.points.emplace_back(layout.z_max, curve.empty() ? 1.0 : curve.back().value);
    return s;
}

}  // namespace

TexelCurves busiest_texel(const nlohmann::json& document, const scene::SearchPath& data) {
    const std::vector<document::Variant> variants = document::expand(document);
    bench::ScenarioLoader loader(data);
    const scene::Scenario& scenario = loader.load(variants.front());
    std::vector<bench::Contender> contenders = bench::make_contenders(scenario, variants.front());
    const auto [view, layout, least] = bench::prepare_light(scenario, 0, contenders, {});
    if (layout.samples() != 1 || layout.apron > 0)
        throw base::Error(base::ErrorCode::internal, scenario.name,
                          "a texel's curve needs one ray a pixel, and filters that are no wider");
    const rays::Capture capture(scenario.scene, view, layout);
    std::vector<rays::LightRays> tiles;
    for (int t = 0; t < layout.tiles(); ++t) tiles.push_back(capture.tile(t));

    const Place place = busiest(tiles, layout);
    const rays::LightRays& chosen = tiles[place.tile];
    TexelCurves result;
    result.segments = place.segments;
    result.x = chosen.x0 + static_cast<int>(place.ray) % chosen.width;
    result.y = chosen.y0 + static_cast<int>(place.ray) / chosen.width;
    curves::SweepScratch scratch;
    curves::Curve exact, stored;
    curves::visibility(chosen, place.ray, 1, 1e-5, scratch, exact);
    std::vector<float> depths;
    for (int i = 0; i <= 400; ++i)
        depths.push_back(layout.z_min + (layout.z_max - layout.z_min) * static_cast<float>(i) / 400.0f);
    for (const bench::Contender& contender : contenders) {
        bench::Maps maps = bench::begin_maps(*contender.row, contender.values, {layout, view, nullptr});
        for (const rays::LightRays& tile : tiles) bench::add(maps, tile);
        bench::finish(maps);
        bench::stored(maps, result.x, result.y, 0, depths, stored);
        result.series.push_back(to_series(results::title(contender.cell), stored, layout));
        result.error.push_back(curves::distance(stored, exact, layout.z_min, layout.z_max).max);
    }
    result.series.push_back(to_series(fmt::format("uncompressed ({} segments)", place.segments), exact, layout));
    result.error.push_back(0.0);
    return result;
}

}  // namespace shadowbench::claims

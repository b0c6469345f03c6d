#include "claims/texel.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "claims/first_light.h"
#include "curves/norms.h"
#include "curves/sweep.h"

namespace shadowbench::claims {
namespace {

using base::Error;
using base::ErrorCode;

struct Candidate {
    std::int64_t far;  // from the number of nodes that is wished for
    RayPlace place;
    int x, y;
};

std::uint64_t segments_of(const rays::LightRays& tile, std::size_t ray) {
    return tile.begin[ray + 1] - tile.begin[ray];
}

std::vector<Candidate> candidates(const std::vector<rays::LightRays>& tiles, const rays::MapLayout& layout,
                                  const RayWish& wish) {
    std::vector<Candidate> found;
    for (std::size_t t = 0; t < tiles.size(); ++t)
        for (std::size_t r = 0; r < tiles[t].rays(); ++r) {
            const auto nodes = static_cast<std::int64_t>(2 * segments_of(tiles[t], r));
            if (nodes == 0 || (wish.fits && !wish.fits(tiles[t], r, layout))) continue;
            found.push_back({wish.nodes > 0 ? std::abs(nodes - wish.nodes) : -nodes,
                             {t, r},
                             tiles[t].x0 + static_cast<int>(r) % tiles[t].width,
                             tiles[t].y0 + static_cast<int>(r) / tiles[t].width});
        }
    std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.far < b.far; });
    return found;
}

Series to_series(const std::string& name, const curves::Curve& curve, const rays::MapLayout& layout) {
    Series s{name, {{layout.z_min, curve.empty() ? 1.0 : curve.front().value}}, true};
    for (const curves::Vertex& v : curve) s.points.emplace_back(v.z, v.value);
    s.points.emplace_back(layout.z_max, curve.empty() ? 1.0 : curve.back().value);
    return s;
}

// One light of a scenario, captured, and a map of every technique.
struct Built {
    Built(const nlohmann::json& document, const scene::SearchPath& data);

    FirstLight first;
    std::vector<rays::LightRays> tiles;
    std::vector<bench::Maps> maps;
};

Built::Built(const nlohmann::json& document, const scene::SearchPath& data) : first(document, data) {
    const rays::MapLayout& layout = first.light.layout;
    if (layout.samples() != 1 || layout.apron > 0)
        throw Error(ErrorCode::internal, first.scenario.name,
                    "a texel's curve needs one ray a pixel, and filters that are no wider");
    tiles = first.tiles();
    for (const bench::Contender& contender : first.contenders) maps.push_back(first.build(contender, tiles));
}

TexelCurves curves_of(const Built& built, const RayPlace& place) {
    const rays::MapLayout& layout = built.first.light.layout;
    const rays::LightRays& tile = built.tiles[place.tile];
    TexelCurves result;
    result.segments = segments_of(tile, place.ray);
    result.x = tile.x0 + static_cast<int>(place.ray) % tile.width;
    result.y = tile.y0 + static_cast<int>(place.ray) / tile.width;
    curves::SweepScratch scratch;
    curves::Curve exact, stored;
    curves::visibility(tile, place.ray, 1, 1e-5, scratch, exact);
    std::vector<float> depths;
    for (int i = 0; i <= 400; ++i)
        depths.push_back(layout.z_min + (layout.z_max - layout.z_min) * static_cast<float>(i) / 400.0f);
    for (std::size_t c = 0; c < built.maps.size(); ++c) {
        bench::stored(built.maps[c], result.x, result.y, 0, depths, stored);
        result.series.push_back(to_series(results::title(built.first.contenders[c].cell), stored, layout));
        result.error.push_back(curves::distance(stored, exact, layout.z_min, layout.z_max).max);
        result.stored.push_back(stored);
    }
    result.series.push_back(to_series(fmt::format("uncompressed ({} segments)", result.segments), exact, layout));
    result.error.push_back(0.0);
    result.stored.push_back(exact);
    return result;
}

}  // namespace

bool lit_at_half_depth(const rays::LightRays& tile, std::size_t ray, const rays::MapLayout& layout) {
    const double half = 0.5 * (static_cast<double>(layout.z_min) + layout.z_max);
    return rays::transmittance(tile, ray, 0, half) > 0.3;
}

std::vector<RayPlace> choose_rays(const std::vector<rays::LightRays>& tiles, const rays::MapLayout& layout,
                                  const RayWish& wish, std::size_t count) {
    const int apart = layout.width / 32;
    std::vector<Candidate> chosen;
    for (const Candidate& one : candidates(tiles, layout, wish)) {
        if (chosen.size() == count) break;
        if (std::all_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
                return std::max(std::abs(one.x - other.x), std::abs(one.y - other.y)) > apart;
            }))
            chosen.push_back(one);
    }
    if (chosen.size() < count)
        throw Error(ErrorCode::internal, "light rays",
                    fmt::format("only {} of {} rays are as the paper describes them", chosen.size(), count));
    std::vector<RayPlace> places;
    for (const Candidate& one : chosen) places.push_back(one.place);
    return places;
}

std::size_t Texels::series(const std::string& technique, const std::vector<std::string>& parameters) const {
    return static_cast<std::size_t>(&cell_of(light, technique, parameters) - light.cells.data());
}

Texels texel_curves(const nlohmann::json& document, const scene::SearchPath& data, const RayWish& wish,
                    std::size_t count) {
    const Built built(document, data);
    Texels result;
    for (const RayPlace& place : choose_rays(built.tiles, built.first.light.layout, wish, count))
        result.curves.push_back(curves_of(built, place));
    for (std::size_t c = 0; c < built.maps.size(); ++c) {
        result.light.cells.push_back(built.first.contenders[c].cell);
        result.light.cells.back().bytes = bench::bytes(built.maps[c]);
    }
    return result;
}

TexelCurves busiest_texel(const nlohmann::json& document, const scene::SearchPath& data) {
    return texel_curves(document, data, {0, lit_at_half_depth}, 1).curves.front();
}

}  // namespace shadowbench::claims

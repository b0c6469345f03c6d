#include "claims/pixel_classes.h"

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/shared_tile.h"
#include "claims/first_light.h"
#include "rays/capture.h"

namespace shadowbench::claims {
namespace {

// The first light of a scenario, ready to be captured.
struct Source {
    Source(const nlohmann::json& document, const scene::SearchPath& data)
        : first(document, data), capture(first.scenario.scene, first.light.view, first.light.layout) {}

    const rays::MapLayout& layout() const { return first.light.layout; }
    std::size_t pixels() const { return static_cast<std::size_t>(layout().width) * layout().height; }
    std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * layout().width + x; }

    // Calls visit(tile) for every tile, on several threads.
    template <class Visit>
    void for_each_tile(const Visit& visit) const {
        base::parallel_for(static_cast<std::size_t>(layout().tiles()),
                           [&](std::size_t t) { visit(capture.tile(static_cast<int>(t))); });
    }

    FirstLight first;
    rays::Capture capture;
};

MeanVertices means_of(const Source& source, const bench::Maps& map, const std::vector<char>& chosen) {
    double of_chosen = 0.0, of_others = 0.0, count = 0.0;
    curves::Curve curve;
    for (int y = 0; y < source.layout().height; ++y)
        for (int x = 0; x < source.layout().width; ++x) {
            bench::stored(map, x, y, 0, {}, curve);
            const bool is_chosen = chosen[source.pixel(x, y)] != 0;
            (is_chosen ? of_chosen : of_others) += static_cast<double>(curve.size());
            count += is_chosen;
        }
    const auto pixels = static_cast<double>(source.pixels());
    return {(of_chosen + of_others) / pixels, count > 0.0 ? of_chosen / count : 0.0,
            count < pixels ? of_others / (pixels - count) : 0.0};
}

}  // namespace

std::vector<char> crossed_pixels(const nlohmann::json& document, const scene::SearchPath& data) {
    const Source source(document, data);
    std::vector<char> found(source.pixels(), 0);
    source.for_each_tile([&](const rays::LightRays& tile) {
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x) {
                const std::size_t first = (static_cast<std::size_t>(y) * tile.width + x) * tile.samples;
                if (tile.begin[first + static_cast<std::size_t>(tile.samples)] > tile.begin[first])
                    found[source.pixel(tile.x0 + x, tile.y0 + y)] = 1;
            }
    });
    return found;
}

std::vector<MeanVertices> mean_vertices(const nlohmann::json& document, const scene::SearchPath& data,
                                        const std::vector<char>& chosen) {
    const Source source(document, data);
    std::vector<bench::Maps> maps;
    for (const bench::Contender& contender : source.first.contenders)
        maps.push_back(bench::begin_maps(*contender.row, contender.values, source.first.input()));
    source.for_each_tile([&](const rays::LightRays& tile) {
        bench::SharedTile shared(tile);
        for (bench::Maps& map : maps) bench::add(map, shared);
    });
    std::vector<MeanVertices> means;
    for (bench::Maps& map : maps) {
        bench::finish(map);
        means.push_back(means_of(source, map, chosen));
    }
    return means;
}

}  // namespace shadowbench::claims

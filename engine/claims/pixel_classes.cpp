#include "claims/pixel_classes.h"

#include <memory>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/contender.h"
#include "bench/load.h"
#include "bench/maps.h"
#include "bench/prepared_light.h"
#include "document/document.h"
#include "rays/capture.h"

namespace shadowbench::claims {
namespace {

// The first light of a scenario, ready to be captured.
struct Source {
    Source(const nlohmann::json& document, const scene::SearchPath& data) : loader(data) {
        const std::vector<document::Variant> variants = document::expand(document);
        const scene::Scenario& scenario = loader.load(variants.front());
        contenders = bench::make_contenders(scenario, variants.front());
        light = bench::prepare_light(scenario, 0, contenders, {});
        capture = std::make_unique<rays::Capture>(scenario.scene, light.view, light.layout);
    }
    Source(const Source&) = delete;  // the capture refers to its parts
    Source& operator=(const Source&) = delete;

    std::size_t pixels() const { return static_cast<std::size_t>(light.layout.width) * light.layout.height; }
    std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * light.layout.width + x; }

    // Calls visit(tile) for every tile, on several threads.
    template <class Visit>
    void for_each_tile(const Visit& visit) const {
        base::parallel_for(static_cast<std::size_t>(light.layout.tiles()),
                           [&](std::size_t t) { visit(capture->tile(static_cast<int>(t))); });
    }

    bench::ScenarioLoader loader;
    std::vector<bench::Contender> contenders;
    bench::PreparedLight light;
    std::unique_ptr<rays::Capture> capture;
};

MeanVertices means_of(const Source& source, const bench::Maps& map, const std::vector<char>& chosen) {
    double of_chosen = 0.0, of_others = 0.0, count = 0.0;
    curves::Curve curve;
    for (int y = 0; y < source.light.layout.height; ++y)
        for (int x = 0; x < source.light.layout.width; ++x) {
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
    for (const bench::Contender& contender : source.contenders)
        maps.push_back(
            bench::begin_maps(*contender.row, contender.values, {source.light.layout, source.light.view, nullptr}));
    source.for_each_tile([&](const rays::LightRays& tile) {
        for (bench::Maps& map : maps) bench::add(map, tile);
    });
    std::vector<MeanVertices> means;
    for (bench::Maps& map : maps) {
        bench::finish(map);
        means.push_back(means_of(source, map, chosen));
    }
    return means;
}

}  // namespace shadowbench::claims

#include "bench/pixel_curves.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/contender.h"
#include "bench/load.h"
#include "bench/one_light.h"
#include "bench/prepared_light.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "document/document.h"
#include "rays/capture.h"

namespace shadowbench::bench {
namespace {

using base::Error;
using base::ErrorCode;
using curves::Curve;
using rays::LightRays;
using techniques::Cells;

constexpr double linearisation = 1e-4;  // error of the lines that approximate exponentials in the exact functions
constexpr int media_tile = 8;            // pixels a side: an answer costs a march for each ray of the pixel's tile
constexpr int even_depths = 128;        // extra samples of functions that are not piecewise linear
constexpr const char* light_prefix = "light=";  // of places in errors: the service's parameter

document::Variant take_variant(const nlohmann::json& document, const RunOptions& options, std::size_t index) {
    std::vector<document::Variant> variants = document::expand(document::select_variant(document, index));
    document::keep_only(variants[0], options.only);
    return std::move(variants[0]);
}

// A tile as the maps of one apron are built from it, with its channels.
struct Tile {
    LightRays rays;
    std::vector<LightRays> channels;

    std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y - rays.y0) * static_cast<std::size_t>(rays.width) +
               static_cast<std::size_t>(x - rays.x0);
    }
};

Tile capture_tile(const rays::Capture& capture, int index, int apron) {
    Tile tile{capture.tile(index, apron), {}};
    for (int c = 0; c < tile.rays.channels; ++c)
        tile.channels.push_back(tile.rays.channels == 1 ? tile.rays : rays::channel(tile.rays, c));
    return tile;
}

// The curve from the map's front to its back.
Curve with_ends(Curve curve, const rays::MapLayout& layout) {
    if (curve.empty()) curve.push_back({layout.z_min, 1.0f});
    if (curve.front().z > layout.z_min) curve.insert(curve.begin(), {layout.z_min, curve.front().value});
    if (curve.back().z < layout.z_max) curve.push_back({layout.z_max, curve.back().value});
    return curve;
}

}  // namespace

struct PixelProbe::State {
    RunOptions options;
    base::ThreadLimit threads;
    document::Variant variant;
    ScenarioLoader loader;
    const scene::Scenario& scenario;
    const scene::Light& light;
    rays::LightView view;
    std::vector<Contender> contenders;
    rays::MapLayout layout;
    std::unique_ptr<rays::Tracer> casters;
    std::unique_ptr<rays::Capture> capture;

    int built = -1;                           // index of the tile in `maps` and `tiles`
    std::vector<std::pair<int, Tile>> tiles;  // by apron
    std::vector<std::optional<Maps>> maps;    // one per contender; absent if it failed
    std::vector<std::string> faults;          // why contenders failed
    curves::SweepScratch scratch;

    State(const nlohmann::json& document, const RunOptions& run_options, const std::string& light_name,
          std::size_t index)
        : options(run_options),
          threads(run_options.threads),
          variant(take_variant(document, run_options, index)),
          loader(run_options.data),
          scenario(loader.load(variant)),
          light(scenario.lights[find_light(names_of(scenario.lights), light_name, light_prefix)]) {
        contenders = make_contenders(scenario, variant);
        PreparedLight prepared =
            prepare_light(scenario, static_cast<std::size_t>(&light - &scenario.lights[0]), contenders, options.limits);
        view = prepared.view;
        layout = prepared.layout;
        if (layout.media) {
            layout.tile_width = std::min(layout.tile_width, media_tile);
            layout.tile_height = std::min(layout.tile_height, media_tile);
        }
        if (!scenario.scene.objects.empty()) casters = std::make_unique<rays::Tracer>(scenario.scene, true);
        capture = std::make_unique<rays::Capture>(scenario.scene, view, layout);
    }

    const Tile& tile_of(int apron) const {
        return std::find_if(tiles.begin(), tiles.end(), [&](const auto& t) { return t.first == apron; })->second;
    }

    void build(int tile) {
        if (built == tile) return;
        built = -1;
        tiles.clear();
        maps.clear();
        maps.resize(contenders.size());
        faults.assign(contenders.size(), "");
        std::vector<int> aprons = aprons_of(contenders);
        if (std::find(aprons.begin(), aprons.end(), 0) == aprons.end()) aprons.push_back(0);
        for (const int apron : aprons) tiles.emplace_back(apron, capture_tile(*capture, tile, apron));
        base::parallel_for(contenders.size(), [&](std::size_t i) {
            const Contender& contender = contenders[i];
            try {
                Maps technique_maps = begin_maps(*contender.row, contender.values, {layout, view, casters.get()});
                add(technique_maps, tile_of(contender.needs.apron).rays);
                finish(technique_maps);
                maps[i] = std::move(technique_maps);
            } catch (const Error& error) {
                faults[i] = error.message();
            }
        });
        built = tile;
    }

    // The exact function of some rays of a pixel.
    Curve exact(const Tile& tile, int channel, std::size_t first, std::size_t count) {
        Curve curve;
        curves::visibility(tile.channels[static_cast<std::size_t>(channel)], first, count, linearisation, scratch,
                           curve);
        return curve;
    }

    // The exact function of the rays that a stored function of the pixel represents.
    Curve reference(const Maps& technique_maps, const Tile& tile, int x, int y, int channel) {
        const std::size_t samples = static_cast<std::size_t>(layout.samples()), first = tile.pixel(x, y) * samples;
        const std::size_t middle =
            static_cast<std::size_t>((layout.samples_y / 2) * layout.samples_x + layout.samples_x / 2);
        if (cells(technique_maps) == Cells::centre) return exact(tile, channel, first + middle, 1);
        if (cells(technique_maps) != Cells::filtered) return exact(tile, channel, first, samples);
        std::vector<curves::WeightedRay> weights;
        Curve curve;
        const LightRays& rays = tile.channels[static_cast<std::size_t>(channel)];
        technique_maps.parts[0]->weights(x, y, rays, weights);
        curves::visibility(rays, weights, linearisation, scratch, curve);
        return curve;
    }

    std::vector<float> depths_for(const Curve& curve) const {
        std::vector<float> depths;
        for (const curves::Vertex& v : curve) depths.push_back(v.z);
        for (int i = 0; i <= even_depths; ++i)
            depths.push_back(layout.z_min +
                             (layout.z_max - layout.z_min) * static_cast<float>(i) / static_cast<float>(even_depths));
        std::sort(depths.begin(), depths.end());
        depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
        return depths;
    }

    // The function that the maps hold for the pixel. Adds its nodes to `nodes`.
    Curve stored_curve(const Maps& technique_maps, int x, int y, int channel, const std::vector<float>& depths,
                       std::uint64_t& nodes) {
        const bool per_sample = cells(technique_maps) == Cells::sample;
        const int nx = per_sample ? layout.samples_x : 1, ny = per_sample ? layout.samples_y : 1;
        std::vector<Curve> parts(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
        std::vector<curves::WeightedCurve> terms;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const int s = static_cast<int>(i);
            stored(technique_maps, x * nx + s % nx, y * ny + s / nx, channel, depths, parts[i]);
            nodes += parts[i].size();
            terms.push_back({parts[i], 1.0 / static_cast<double>(parts.size())});
        }
        if (parts.size() == 1) return std::move(parts[0]);
        Curve mean;
        curves::weighted_sum(terms, scratch, mean);
        return mean;
    }

    TechniqueCurve curve_of(std::size_t i, int x, int y) {
        TechniqueCurve out;
        out.title = results::title(contenders[i].cell);
        out.technique = contenders[i].cell.technique;
        if (!maps[i]) {
            out.absent = faults[i];
            return out;
        }
        out.cells = cells(*maps[i]);
        if (out.cells == Cells::none) {
            out.absent = "stores no function";
            return out;
        }
        const Tile& tile = tile_of(contenders[i].needs.apron);
        for (int c = 0; c < layout.channels; ++c) {
            const Curve truth = reference(*maps[i], tile, x, y, c);
            Curve curve = stored_curve(*maps[i], x, y, c, depths_for(truth), out.nodes);
            out.error_max = std::max(out.error_max, curves::distance(curve, truth, layout.z_min, layout.z_max).max);
            out.channels.push_back(with_ends(std::move(curve), layout));
        }
        out.absent = fault(*maps[i]);
        return out;
    }
};

void check_light(const nlohmann::json& document, const std::string& light, std::size_t variant) {
    find_light(scene::light_names(document::select_variant(document, variant)), light, light_prefix);
}

PixelProbe::PixelProbe(const nlohmann::json& document, const RunOptions& options, const std::string& light,
                       std::size_t variant)
    : state_(std::make_unique<State>(document, options, light, variant)) {}

PixelProbe::~PixelProbe() = default;

PixelCurves PixelProbe::at(int x, int y) {
    State& s = *state_;
    if (x < 0 || y < 0 || x >= s.layout.width || y >= s.layout.height)
        throw Error(ErrorCode::usage, fmt::format("({}, {})", x, y),
                    fmt::format("the map of light \"{}\" has pixels (0, 0) to ({}, {})", s.light.name,
                                s.layout.width - 1, s.layout.height - 1));
    s.build((y / s.layout.tile_height) * s.layout.tiles_x() + x / s.layout.tile_width);
    PixelCurves out{s.light.name, x, y, s.layout.z_min, s.layout.z_max, s.layout.samples(), {}, {}};
    const Tile& tile = s.tile_of(0);
    const std::size_t samples = static_cast<std::size_t>(s.layout.samples());
    for (int c = 0; c < s.layout.channels; ++c)
        out.exact.push_back(with_ends(s.exact(tile, c, tile.pixel(x, y) * samples, samples), s.layout));
    for (std::size_t i = 0; i < s.contenders.size(); ++i) out.curves.push_back(s.curve_of(i, x, y));
    return out;
}

namespace {

using json = nlohmann::ordered_json;

const char* name_of(Cells cells) {
    switch (cells) {
        case Cells::pixel:
            return "pixel";
        case Cells::sample:
            return "samples";
        case Cells::centre:
            return "centre";
        case Cells::filtered:
            return "filtered";
        case Cells::none:
            break;
    }
    return "none";
}

// The depths of a technique's channels differ, so each channel beyond the first has its own column of depths.
json to_json(const std::vector<Curve>& channels) {
    const auto column = [](const Curve& curve, float curves::Vertex::*member) {
        json values = json::array();
        for (const curves::Vertex& v : curve) values.push_back(v.*member);
        return values;
    };
    json out = {{"z", column(channels[0], &curves::Vertex::z)}, {"v", column(channels[0], &curves::Vertex::value)}};
    if (channels.size() == 1) return out;
    out["channels"] = json::array();
    out["channels_z"] = json::array();
    for (const Curve& curve : channels) {
        out["channels"].push_back(column(curve, &curves::Vertex::value));
        out["channels_z"].push_back(column(curve, &curves::Vertex::z));
    }
    return out;
}

json to_json(const TechniqueCurve& curve) {
    json out = {{"title", curve.title}, {"technique", curve.technique}};
    if (!curve.absent.empty()) {
        out["absent"] = curve.absent;
        return out;
    }
    out.update(to_json(curve.channels));
    out["of"] = name_of(curve.cells);
    out["nodes"] = curve.nodes;
    out["error_max"] = curve.error_max;
    return out;
}

}  // namespace

nlohmann::ordered_json to_json(const PixelCurves& curves) {
    json rows = json::array();
    for (const TechniqueCurve& curve : curves.curves) rows.push_back(to_json(curve));
    return {{"light", curves.light},
            {"x", curves.x},
            {"y", curves.y},
            {"z_min", curves.z_min},
            {"z_max", curves.z_max},
            {"rays", curves.rays},
            {"exact", to_json(curves.exact)},
            {"curves", std::move(rows)}};
}

}  // namespace shadowbench::bench

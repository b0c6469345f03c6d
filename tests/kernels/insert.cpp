// Insertion of segments into texels of a fixed number of nodes: the rows whose build does little else, from given
// functions, whose segments meet, and from the rays of smoke, whose segments overlap.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kernels/inputs.h"
#include "kernels/kernel.h"
#include "techniques/technique.h"

namespace shadowbench::kernels {
namespace {

constexpr double rounding = 1e-5;  // of the light that passes a ray, as a share of it

struct Rays {
    SharedInput input;
    rays::MapLayout layout;
    std::vector<rays::LightRays> tiles;
};

// A map one pixel high, of a ray for each function.
void set_functions(const std::vector<curves::Curve>& functions, Rays& out) {
    rays::LightRays tile;
    tile.begin.push_back(0);
    for (const curves::Curve& function : functions) {
        for (std::size_t i = 0; i + 1 < function.size(); ++i) {
            const curves::Vertex &from = function[i], &to = function[i + 1];
            if (!(to.value < from.value)) continue;
            tile.z_front.push_back(from.z);
            tile.z_back.push_back(to.z);
            tile.transmittance.push_back(to.value / from.value);
        }
        tile.begin.push_back(static_cast<std::uint32_t>(tile.segments()));
    }
    tile.width = static_cast<int>(functions.size());
    tile.height = 1;
    out.layout = {.width = tile.width,
                  .media = true,
                  .z_min = out.input->layout.z_min,
                  .z_max = out.input->layout.z_max,
                  .tile_width = tile.width};
    out.tiles.push_back(std::move(tile));
}

std::unique_ptr<techniques::Map> build(const Rays& rays, const techniques::Technique& row,
                                       const techniques::ParameterValues& values) {
    auto map = row.create(values);
    map->begin({rays.layout, rays.input->view, nullptr});
    for (const rays::LightRays& tile : rays.tiles) map->add(tile);
    map->finish();
    return map;
}

// What lies behind all of a ray is the product of its segments.
void check_passed(const techniques::Map& map, const Rays& rays) {
    const int across = rays.layout.samples_x, down = rays.layout.samples_y;
    curves::Curve stored;
    for (const rays::LightRays& tile : rays.tiles)
        for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
            const int pixel = static_cast<int>(ray) / tile.samples, sample = static_cast<int>(ray) % tile.samples;
            map.stored((tile.x0 + pixel % tile.width) * across + sample % across,
                       (tile.y0 + pixel / tile.width) * down + sample / across, 0, {}, stored);
            double passed = 1.0;
            for (std::uint32_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s) passed *= tile.transmittance[s];
            const double found = stored.empty() ? 1.0 : stored.back().value;
            check(std::abs(found - passed) <= rounding * passed,
                  fmt::format("{} of the light passes a ray, not {}", found, passed));
        }
}

Subject prepare_insert(Kind kind, bool overlapping, int nodes, const char* order) {
    const auto rays = std::make_shared<Rays>();
    rays->input = make_input(kind, 64, overlapping ? 1 : 4);
    if (overlapping) {
        rays->layout = rays->input->layout;
        rays->tiles = capture_all(*rays->input);
    } else {
        set_functions(functions_of(kind, 64, 4), *rays);
    }
    const techniques::Technique& row = techniques::find("avsm", "");
    const techniques::ParameterValues values =
        techniques::read_parameters(row.parameters, {{"nodes", nodes}, {"order", order}, {"cells", "sample"}}, "");
    const auto map = build(*rays, row, values);
    check_passed(*map, *rays);

    Subject subject;
    subject.exact.bytes = static_cast<double>(map->bytes());
    subject.exact.nodes = static_cast<double>(map->nodes().total);
    subject.vertices = static_cast<double>(segments_of(rays->tiles));
    subject.pass = [rays, &row, values] { benchmark::DoNotOptimize(build(*rays, row, values).get()); };
    std::vector<const void*> lines;
    append_lines(rays->tiles, lines);
    subject.floor = floor_of(std::move(lines));
    return subject;
}

void add_insert(Kernels& kernels, Kind kind, bool overlapping, int nodes) {
    for (const char* order : {"sorted", "shuffled"})
        kernels.push_back(
            {fmt::format("insert/avsm/{}{}/nodes:{}/{}", name_of(kind), overlapping ? "_rays" : "", nodes, order),
             [=] { return prepare_insert(kind, overlapping, nodes, order); }});
}

}  // namespace

void add_insert_kernels(Kernels& kernels) {
    for (const Kind kind : {Kind::smoke, Kind::hair, Kind::mixed}) add_insert(kernels, kind, false, 8);
    add_insert(kernels, Kind::smoke, true, 8);
    for (const int nodes : {16, 64}) add_insert(kernels, Kind::mixed, false, nodes);
}

}  // namespace shadowbench::kernels

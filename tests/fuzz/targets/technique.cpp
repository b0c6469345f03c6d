#include "techniques/technique.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <nlohmann/json.hpp>

#include "curves/functions_file.h"
#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "rays/light_view.h"
#include "scene/scenario.h"

namespace shadowbench::fuzz {
namespace {

using namespace techniques;
using curves::Curve;

constexpr std::size_t most_functions = 16, most_vertices = 256;
constexpr std::size_t most_bytes = std::size_t{1} << 26;  // of a map

constexpr const char* some_functions =
    "3\n0 1\n1 0.5\n1 0.25\n"
    "2\n0.5 0.9\n0.5 0\n"
    "0\n"
    "1\n0.25 0.5\n";

// Rays of one pixel per function: its steps become surfaces, its slopes media.
rays::LightRays rays_of(const std::vector<Curve>& functions, int channels) {
    rays::LightRays rays;
    rays.width = static_cast<int>(functions.size());
    rays.height = 1;
    rays.channels = channels;
    rays.begin = {0};
    const auto add = [&](float front, float back, float through) {
        rays.z_front.push_back(front);
        rays.z_back.push_back(back);
        for (int c = 0; c < channels; ++c) rays.transmittance.push_back(c == 1 ? std::sqrt(through) : through);
        rays.submission.push_back(static_cast<std::uint32_t>(rays.z_front.size() - 1 - rays.begin.back()));
    };
    for (const Curve& function : functions) {
        if (!function.empty() && function[0].value < 1.0f) add(function[0].z, function[0].z, function[0].value);
        for (std::size_t i = 1; i < function.size(); ++i)
            if (function[i].value < function[i - 1].value)
                add(function[i - 1].z, function[i].z, function[i].value / function[i - 1].value);
        rays.begin.push_back(static_cast<std::uint32_t>(rays.z_front.size()));
    }
    return rays;
}

rays::MapLayout layout_of(const std::vector<Curve>& functions, int channels) {
    rays::MapLayout layout;
    layout.width = layout.tile_width = static_cast<int>(functions.size());
    layout.channels = channels;
    layout.media = true;
    layout.z_min = std::numeric_limits<float>::max();
    layout.z_max = std::numeric_limits<float>::lowest();
    for (const Curve& function : functions)
        for (const curves::Vertex& vertex : function) {
            layout.z_min = std::min(layout.z_min, vertex.z);
            layout.z_max = std::max(layout.z_max, vertex.z);
        }
    if (!(layout.z_min <= layout.z_max)) layout.z_min = 0.0f, layout.z_max = 1.0f;
    return layout;
}

std::vector<Query> queries_of(const std::vector<Curve>& functions) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<Query> queries;
    for (std::size_t i = 0; i < functions.size(); ++i) {
        const float x = static_cast<float>(i) + 0.5f;
        for (const float z : {-1e18f, 0.0f, 1e18f}) queries.push_back({x, 0.5f, z, 2.5f});
        for (const curves::Vertex& vertex : functions[i])
            for (const float z : {std::nextafter(vertex.z, -infinity), vertex.z, std::nextafter(vertex.z, infinity)})
                queries.push_back({x, 0.5f, z, 1.0f});
    }
    queries.push_back({-1.0f, 0.5f, 1.0f, 1.0f});
    return queries;
}

void expect_sound(const Technique& row, const ParameterValues& values, const Map& map,
                  const std::vector<Curve>& functions) {
    const Promises promised = promises(row, values);
    const std::vector<Query> queries = queries_of(functions);
    std::vector<float> visibility(queries.size() * static_cast<std::size_t>(map.channels()), -1.0f);
    map.lookup(queries, visibility);
    expect_finite(visibility, "lookups are finite");
    if (promised.unit_range) expect_in(visibility, -1e-6f, 1.0f + 1e-6f, "lookups are in [0, 1]");
    std::vector<const void*> lines;
    for (const Query& query : queries) map.touched(query, lines);
    map.nodes();
    if (map.cells() == Cells::none) return;
    Curve stored;
    const std::vector<float> depths = {0.0f, 1.0f};
    for (int c = 0; c < map.channels(); ++c) {
        map.stored(0, 0, c, depths, stored);
        for (const curves::Vertex& vertex : stored)
            expect(std::isfinite(vertex.z) && std::isfinite(vertex.value), "stored functions are finite");
        if (promised.monotone && promised.unit_range && !promised.opaque_only)
            expect(curves::is_visibility(stored, 1e-6f), "stored functions keep their promises");
    }
}

void build_from_rays(const Technique& row, const ParameterValues& values, const std::vector<Curve>& functions) {
    const int channels = row.coloured ? 3 : 1;
    rays::MapLayout layout = layout_of(functions, channels);
    if (row.least_bytes && row.least_bytes(values, layout) > most_bytes) return;
    const rays::LightView view;
    const auto map = row.create(values);
    layout.apron = map->needs().apron;
    layout.submission = map->needs().submission;
    rays::LightRays tile = rays_of(functions, channels);
    if (!layout.submission) tile.submission.clear();
    map->begin({layout, view, nullptr, 0});
    map->add(tile);
    map->finish();
    expect_sound(row, values, *map, functions);
}

std::vector<Curve> read_some(std::string_view bytes) {
    const InputFile file(bytes.empty() ? some_functions : bytes, ".txt");
    std::vector<Curve> functions = curves::read_functions(file.path());
    std::erase_if(functions, [](const Curve& function) { return function.size() > most_vertices; });
    if (functions.size() > most_functions) functions.resize(most_functions);
    return functions;
}

}  // namespace

// The first line is a technique as in a scenario; the rest is a file of functions.
void technique(std::string_view bytes) {
    const std::string line(take_line(bytes));
    attempt({base::ErrorCode::bad_input}, [&] {
        nlohmann::json object = scene::parse_json(line, "line");
        if (!object.is_object() || !object.contains("type") || !object["type"].is_string()) return;
        const Technique& row = find(object["type"].get<std::string>(), "/techniques/0/type");
        object.erase("type");
        const ParameterValues values = read_parameters(row.parameters, object, "/techniques/0");
        expect(read_parameters(row.parameters, to_json(values), "").values == values.values,
               "what is written is read back");
        const std::vector<Curve> functions = read_some(bytes);
        if (functions.empty()) return;
        if (row.from_curves) expect_sound(row, values, *row.from_curves(values, functions), functions);
        if (!row.traits.traces) build_from_rays(row, values, functions);
    });
}

}  // namespace shadowbench::fuzz

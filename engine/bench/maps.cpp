#include "bench/maps.h"

#include <algorithm>

namespace shadowbench::bench {

using techniques::Map;

Maps begin_maps(const techniques::Technique& row, const techniques::ParameterValues& values,
                const techniques::BuildInput& input) {
    Maps maps;
    maps.layout = std::make_unique<rays::MapLayout>(input.layout);
    if (!row.coloured) maps.layout->channels = 1;
    for (int c = 0; c < input.layout.channels; c += maps.layout->channels) {
        maps.parts.push_back(row.create(values));
        maps.parts.back()->begin({*maps.layout, input.view, input.tracer, c});
    }
    return maps;
}

void add(Maps& maps, const rays::LightRays& tile) {
    if (maps.parts.size() == 1) return maps.parts[0]->add(tile);
    for (std::size_t c = 0; c < maps.parts.size(); ++c) maps.parts[c]->add(rays::channel(tile, static_cast<int>(c)));
}

void finish(Maps& maps) {
    for (const auto& map : maps.parts) map->finish();
}

void lookup(const Maps& maps, std::span<const techniques::Query> queries, std::span<float> visibility) {
    const std::size_t each = queries.size() * static_cast<std::size_t>(maps.parts[0]->channels());
    for (std::size_t p = 0; p < maps.parts.size(); ++p)
        maps.parts[p]->lookup(queries, visibility.subspan(p * each, each));
}

std::size_t touched(const Maps& maps, std::span<const techniques::Query> queries, std::size_t limit,
                    std::vector<const void*>& lines) {
    const std::size_t before = lines.size();
    std::size_t covered = 0;
    while (covered < queries.size() && (lines.size() - before) * maps.parts.size() < limit)
        maps.parts[0]->touched(queries[covered++], lines);
    for (std::size_t p = 1; p < maps.parts.size(); ++p)
        for (std::size_t q = 0; q < covered; ++q) maps.parts[p]->touched(queries[q], lines);
    return covered;
}

std::size_t bytes(const Maps& maps) {
    std::size_t sum = 0;
    for (const auto& map : maps.parts) sum += map->bytes();
    return sum;
}

std::size_t working_bytes(const Maps& maps) {
    std::size_t sum = 0;
    for (const auto& map : maps.parts) sum += map->working_bytes();
    return sum;
}

techniques::NodeStats nodes(const Maps& maps) {
    techniques::NodeStats sum;
    for (const auto& map : maps.parts) {
        const techniques::NodeStats one = map->nodes();
        sum.cells += one.cells;
        sum.total += one.total;
        sum.max = std::max(sum.max, one.max);
        if (sum.histogram.size() < one.histogram.size()) sum.histogram.resize(one.histogram.size());
        for (std::size_t n = 0; n < one.histogram.size(); ++n) sum.histogram[n] += one.histogram[n];
    }
    return sum;
}

techniques::Cells cells(const Maps& maps) {
    return maps.parts[0]->cells();
}

void stored(const Maps& maps, int x, int y, int channel, std::span<const float> depths, curves::Curve& out) {
    const bool split = maps.parts.size() > 1;
    maps.parts[split ? static_cast<std::size_t>(channel) : 0]->stored(x, y, split ? 0 : channel, depths, out);
}

}  // namespace shadowbench::bench

#include "bench/maps.h"

#include <algorithm>

namespace shadowbench::bench {

using techniques::Map;

Maps begin_maps(const techniques::Technique& row, const techniques::ParameterValues& values,
                const techniques::BuildInput& input) {
    Maps maps;
    maps.layout = std::make_unique<rays::MapLayout>(input.layout);
    maps.layout->channels = 1;
    for (int c = 0; c < input.layout.channels; ++c) {
        maps.channel.push_back(row.create(values));
        maps.channel.back()->begin({*maps.layout, input.view, input.tracer, c});
    }
    return maps;
}

void add(Maps& maps, const rays::LightRays& tile) {
    if (tile.channels == 1) return maps.channel[0]->add(tile);
    for (int c = 0; c < tile.channels; ++c) maps.channel[static_cast<std::size_t>(c)]->add(rays::channel(tile, c));
}

void finish(Maps& maps) {
    for (const auto& map : maps.channel) map->finish();
}

void lookup(const Maps& maps, const Asked& asked, std::span<float> visibility) {
    const std::size_t count = asked.queries.size();
    for (std::size_t c = 0; c < maps.channel.size(); ++c) {
        const std::span<float> answers = visibility.subspan(c * count, count);
        if (asked.footprints.empty())
            maps.channel[c]->lookup(asked.queries, answers);
        else
            maps.channel[c]->lookup_shaped(asked.queries, asked.footprints, answers);
    }
}

std::size_t touched(const Maps& maps, const Asked& asked, std::size_t limit, std::vector<const void*>& lines) {
    const std::size_t before = lines.size();
    const auto touch = [&](const Map& map, std::size_t q) {
        if (asked.footprints.empty())
            map.touched(asked.queries[q], lines);
        else
            map.touched_shaped(asked.queries[q], asked.footprints[q], lines);
    };
    std::size_t covered = 0;
    while (covered < asked.queries.size() && (lines.size() - before) * maps.channel.size() < limit)
        touch(*maps.channel[0], covered++);
    for (std::size_t c = 1; c < maps.channel.size(); ++c)
        for (std::size_t q = 0; q < covered; ++q) touch(*maps.channel[c], q);
    return covered;
}

std::size_t bytes(const Maps& maps) {
    std::size_t sum = 0;
    for (const auto& map : maps.channel) sum += map->bytes();
    return sum;
}

std::size_t working_bytes(const Maps& maps) {
    std::size_t sum = 0;
    for (const auto& map : maps.channel) sum += map->working_bytes();
    return sum;
}

techniques::NodeStats nodes(const Maps& maps) {
    techniques::NodeStats sum;
    for (const auto& map : maps.channel) {
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
    return maps.channel[0]->cells();
}

}  // namespace shadowbench::bench

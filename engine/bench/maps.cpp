#include "bench/maps.h"

#include <algorithm>

#include "base/parallel.h"
#include "bench/shared_tile.h"

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
    SharedTile shared(tile);
    add(maps, shared);
}

void finish(Maps& maps) {
    for (const auto& map : maps.parts) map->finish();
}

void set_lookups(Maps& maps, const techniques::ParameterValues& values) {
    for (const auto& map : maps.parts) map->set_lookups(values);
}

std::string fault(const Maps& maps) {
    for (const auto& map : maps.parts)
        if (std::string fault = map->fault(); !fault.empty()) return fault;
    return {};
}

void lookup(const Maps& maps, const Asked& asked, std::span<float> visibility) {
    const std::size_t per_map = asked.queries.size() * static_cast<std::size_t>(maps.parts[0]->channels());
    for (std::size_t p = 0; p < maps.parts.size(); ++p) {
        const std::span<float> answers = visibility.subspan(p * per_map, per_map);
        if (asked.footprints.empty())
            maps.parts[p]->lookup(asked.queries, answers);
        else
            maps.parts[p]->lookup_shaped(asked.queries, asked.footprints, answers);
    }
}

std::vector<float> lookup_all(const Maps& maps, const Asked& asked) {
    // In pieces of a fixed size, so that the number of threads does not change them.
    constexpr std::size_t piece_size = 256;
    const std::size_t all = asked.queries.size();
    std::vector<float> visibility(all * maps.channels());
    const std::size_t pieces = (all + piece_size - 1) / piece_size;
    base::parallel_for(pieces, [&](std::size_t piece) {
        const std::size_t first = piece * piece_size;
        const std::size_t count = std::min(piece_size, all - first);
        std::vector<float> answers(count * maps.channels());
        lookup(maps, asked.part(first, count), answers);
        for (std::size_t c = 0; c < maps.channels(); ++c)
            std::copy_n(answers.data() + c * count, count, visibility.data() + c * all + first);
    });
    return visibility;
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
    while (covered < asked.queries.size() && (lines.size() - before) * maps.parts.size() < limit)
        touch(*maps.parts[0], covered++);
    for (std::size_t p = 1; p < maps.parts.size(); ++p)
        for (std::size_t q = 0; q < covered; ++q) touch(*maps.parts[p], q);
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
        const techniques::NodeStats stats = map->nodes();
        sum.cells += stats.cells;
        sum.total += stats.total;
        sum.max = std::max(sum.max, stats.max);
        if (sum.histogram.size() < stats.histogram.size()) sum.histogram.resize(stats.histogram.size());
        for (std::size_t n = 0; n < stats.histogram.size(); ++n) sum.histogram[n] += stats.histogram[n];
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

// The map of one technique: one Map or, for coloured light rays and a technique of one channel, one Map per channel.
#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "techniques/technique.h"

namespace shadowbench::bench {

// Queries to maps. The pixels of a camera have footprints, one per query; other receivers have none.
struct Asked {
    std::span<const techniques::Query> queries;
    std::span<const techniques::Footprint> footprints;

    template <class Range>
    requires std::convertible_to<const Range&, std::span<const techniques::Query>> Asked(
        const Range& range, std::span<const techniques::Footprint> shapes = {})
        : queries(range), footprints(shapes) {}
    Asked part(std::size_t first, std::size_t count) const {
        return {queries.subspan(first, count), footprints.empty() ? footprints : footprints.subspan(first, count)};
    }
};

struct Maps {
    // The layout with which the maps were begun: that of the light rays, as the maps see it. Must not move.
    std::unique_ptr<rays::MapLayout> layout;
    std::vector<std::unique_ptr<techniques::Map>> parts;

    std::size_t channels() const { return parts.size() * static_cast<std::size_t>(parts[0]->channels()); }
};

// Begins the maps for input.layout. Throws what the technique throws.
Maps begin_maps(const techniques::Technique& row, const techniques::ParameterValues& values,
                const techniques::BuildInput& input);

// Thread-safe for different tiles. Where several maps are made of one tile, see SharedTile.
void add(Maps& maps, const rays::LightRays& tile);
void finish(Maps& maps);
// See Map::set_lookups.
void set_lookups(Maps& maps, const techniques::ParameterValues& values);

// Why no answer of the maps counts; empty: they do. See Map::fault.
std::string fault(const Maps& maps);

// Answers are stored channel after channel: `visibility` has queries.size() * channels() places.
void lookup(const Maps& maps, const Asked& asked, std::span<float> visibility);
// The same for many queries, on all threads.
std::vector<float> lookup_all(const Maps& maps, const Asked& asked);

// Appends the cache lines that a lookup of all these queries reads, in the order of the reads, until there are `limit`
// or more. Returns how many queries were covered in every channel.
std::size_t touched(const Maps& maps, const Asked& asked, std::size_t limit, std::vector<const void*>& lines);

std::size_t bytes(const Maps& maps);
std::size_t working_bytes(const Maps& maps);
techniques::NodeStats nodes(const Maps& maps);
techniques::Cells cells(const Maps& maps);
// The function stored in a cell for one channel of the light rays.
void stored(const Maps& maps, int x, int y, int channel, std::span<const float> depths, curves::Curve& out);

}  // namespace shadowbench::bench

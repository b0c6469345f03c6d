#include "bench/shared_tile.h"

namespace shadowbench::bench {
namespace {

const rays::LightRays& rays_of_part(const Maps& maps, std::size_t p, SharedTile& tile) {
    return maps.parts.size() == 1 ? tile.rays() : tile.channel(p);
}

// Functions take some 32 bytes a segment: those of larger tiles are made ray by ray, by each map.
constexpr std::size_t most_segments = std::size_t{1} << 19;

bool has_functions(const rays::LightRays& tile) {
    return !tile.z_back.empty() && tile.segments() <= most_segments;
}

bool a_map_a_channel(const Maps& maps, const rays::LightRays& tile) {
    return static_cast<int>(maps.parts.size()) == tile.channels;
}

}  // namespace

const rays::LightRays& SharedTile::channel(std::size_t c) {
    if (rays_.channels == 1) return rays_;
    if (!channels_[c]) channels_[c] = rays::channel(rays_, static_cast<int>(c));
    return *channels_[c];
}

const curves::RayFunctions& SharedTile::functions(std::size_t c) {
    if (!functions_[c]) functions_[c].emplace(channel(c));
    return *functions_[c];
}

const techniques::MeanRays& SharedTile::means(std::size_t c) {
    if (!means_[c]) means_[c].emplace().of(channel(c), has_functions(rays_) ? &functions(c) : nullptr);
    return *means_[c];
}

bool shares(const techniques::RayNeeds& needs, const rays::MapLayout& layout) {
    return (needs.means && layout.samples() > 1) || (needs.functions && layout.media);
}

bool reads_means(const Maps& maps, const rays::LightRays& tile) {
    return tile.samples > 1 && a_map_a_channel(maps, tile) && maps.parts[0]->needs().means;
}

bool reads_functions(const Maps& maps, const rays::LightRays& tile) {
    if (!has_functions(tile) || !a_map_a_channel(maps, tile)) return false;
    return maps.parts[0]->needs().functions || reads_means(maps, tile);
}

void prepare_part(const Maps& maps, std::size_t p, SharedTile& tile) {
    rays_of_part(maps, p, tile);
}

void add_part(Maps& maps, std::size_t p, SharedTile& tile) {
    if (reads_means(maps, tile.rays()))
        maps.parts[p]->add_means(tile.means(p));
    else if (reads_functions(maps, tile.rays()))
        maps.parts[p]->add_functions(tile.channel(p), tile.functions(p));
    else
        maps.parts[p]->add(rays_of_part(maps, p, tile));
}

void add(Maps& maps, SharedTile& tile) {
    for (std::size_t p = 0; p < maps.parts.size(); ++p) add_part(maps, p, tile);
}

}  // namespace shadowbench::bench

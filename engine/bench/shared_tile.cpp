#include "bench/shared_tile.h"

namespace shadowbench::bench {
namespace {

const rays::LightRays& rays_of_part(const Maps& maps, std::size_t p, SharedTile& tile) {
    return maps.parts.size() == 1 ? tile.rays() : tile.channel(p);
}

}  // namespace

const rays::LightRays& SharedTile::channel(std::size_t c) {
    if (rays_.channels == 1) return rays_;
    if (!channels_[c]) channels_[c] = rays::channel(rays_, static_cast<int>(c));
    return *channels_[c];
}

const techniques::MeanRays& SharedTile::means(std::size_t c) {
    if (!means_[c]) means_[c].emplace().of(channel(c));
    return *means_[c];
}

bool reads_means(const Maps& maps, const rays::LightRays& tile) {
    return tile.samples > 1 && static_cast<int>(maps.parts.size()) == tile.channels && maps.parts[0]->needs().means;
}

void prepare_part(const Maps& maps, std::size_t p, SharedTile& tile) {
    rays_of_part(maps, p, tile);
}

void add_part(Maps& maps, std::size_t p, SharedTile& tile) {
    if (reads_means(maps, tile.rays()))
        maps.parts[p]->add_means(tile.means(p));
    else
        maps.parts[p]->add(rays_of_part(maps, p, tile));
}

void add(Maps& maps, SharedTile& tile) {
    for (std::size_t p = 0; p < maps.parts.size(); ++p) add_part(maps, p, tile);
}

}  // namespace shadowbench::bench

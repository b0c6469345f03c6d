#include "bench/node_ratio.h"

#include <algorithm>

#include "base/random.h"
#include "curves/fewest.h"
#include "metrics/ratio_of_sums.h"

namespace shadowbench::bench {
namespace {

using techniques::Cells;

constexpr std::uint64_t compared_cells = 1024;  // of one map: the search takes up to some milliseconds a cell

// One cell in so many is compared.
std::uint64_t node_share(std::uint64_t cells) {
    return std::max<std::uint64_t>(1, (cells + compared_cells - 1) / compared_cells);
}

bool in_node_share(std::uint64_t x, std::uint64_t y, std::uint64_t share) {
    return share == 1 || base::hash(x, y) % share == 0;
}

void append_pair(std::size_t stored, std::size_t fewest, NodesBesideFewest& out) {
    out.stored.push_back(static_cast<double>(stored));
    out.fewest.push_back(static_cast<double>(fewest));
}

}  // namespace

void compare_nodes(const Maps& maps, const rays::LightRays& tile, const rays::MapLayout& layout,
                   NodesBesideFewest& out) {
    const Cells kind = cells(maps);
    if (maps.parts.size() != 1 || (kind != Cells::pixel && kind != Cells::filtered)) return;
    const techniques::Map& map = *maps.parts[0];
    const std::uint64_t share =
        node_share(static_cast<std::uint64_t>(layout.width) * static_cast<std::uint64_t>(layout.height));
    const rays::TileCore core = rays::core_of(layout, tile.tile);
    curves::Curve function;
    for (int y = core.y0; y < core.y0 + core.height; ++y)
        for (int x = core.x0; x < core.x0 + core.width; ++x) {
            if (!in_node_share(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y), share)) continue;
            const std::optional<techniques::FewestNodes> fewest = map.fewest_nodes(x, y, tile);
            if (!fewest) return;
            if (!fewest->known) {
                ++out.left_out;
                continue;
            }
            map.stored(x, y, 0, {}, function);
            append_pair(function.size(), fewest->nodes, out);
        }
}

void compare_nodes(std::span<const curves::Curve> functions, std::span<const curves::Curve> stored, double tolerance,
                   NodesBesideFewest& out) {
    const std::uint64_t share = node_share(functions.size());
    curves::FewestScratch scratch;
    scratch.most_steps = curves::steps_of_a_bound;
    curves::Curve fewest;
    for (std::size_t i = 0; i < functions.size(); ++i) {
        if (!in_node_share(i, 0, share)) continue;
        fewest.resize(functions[i].size());
        const std::size_t nodes =
            curves::compress_to_fewest(functions[i], static_cast<float>(tolerance), scratch, fewest.data());
        if (scratch.complete)
            append_pair(stored[i].size(), nodes, out);
        else
            ++out.left_out;
    }
}

std::optional<results::FewestNodes> over_fewest(std::span<const NodesBesideFewest> parts, std::uint64_t cells) {
    NodesBesideFewest all;
    for (const NodesBesideFewest& part : parts) {
        all.stored.insert(all.stored.end(), part.stored.begin(), part.stored.end());
        all.fewest.insert(all.fewest.end(), part.fewest.begin(), part.fewest.end());
        all.left_out += part.left_out;
    }
    results::FewestNodes over;
    for (std::size_t i = 0; i < all.stored.size(); ++i) {
        over.nodes += static_cast<std::uint64_t>(all.stored[i]);
        over.fewest += static_cast<std::uint64_t>(all.fewest[i]);
    }
    if (over.fewest == 0) return {};
    over.cells = all.stored.size();
    over.left_out = all.left_out;
    const bool all_cells = node_share(cells) == 1;
    over.interval =
        metrics::ratio_interval(all.stored, all.fewest, all_cells ? over.cells : static_cast<std::size_t>(cells));
    return over;
}

}  // namespace shadowbench::bench

#include "claims/salvi_streams.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"

namespace shadowbench::claims::salvi {

std::vector<rays::LightRays> shuffled(const std::vector<rays::LightRays>& tiles, std::uint32_t window,
                                      std::uint64_t seed) {
    std::vector<rays::LightRays> result(tiles.size());
    base::parallel_for(tiles.size(), [&](std::size_t t) {
        rays::LightRays& tile = result[t] = tiles[t];
        for (std::size_t r = 0; r < tile.rays(); ++r) {
            base::Random random(base::hash(seed, t, r));
            for (std::uint32_t first = tile.begin[r]; first < tile.begin[r + 1];) {
                const std::uint32_t count = std::min(window, tile.begin[r + 1] - first);
                for (std::uint32_t k = count; k > 1; --k)
                    std::swap(tile.submission[first + k - 1],
                              tile.submission[first + static_cast<std::uint32_t>(random.below(k))]);
                first += count;
            }
        }
    });
    return result;
}

std::uint64_t insertion_sort(const rays::LightRays& tile, std::size_t ray, std::vector<Segment>& out) {
    std::uint64_t moves = 0;
    out.clear();
    for (std::uint32_t k = tile.begin[ray]; k < tile.begin[ray + 1]; ++k) {
        const std::uint32_t s = tile.submission[k];
        const Segment added{tile.z_front[s], tile.back(s), tile.transmittance[s]};
        out.push_back(added);
        std::size_t at = out.size() - 1;
        for (; at > 0 && out[at - 1].front > added.front; --at, ++moves) out[at] = out[at - 1];
        out[at] = added;
    }
    return moves;
}

rays::LightRays one_ray(const rays::LightRays& tile, std::span<const std::uint32_t> order) {
    rays::LightRays one;
    one.width = one.height = 1;
    one.begin = {0, static_cast<std::uint32_t>(order.size())};
    std::vector<std::uint32_t> by_depth(order.begin(), order.end());
    std::sort(by_depth.begin(), by_depth.end());
    for (const std::uint32_t s : by_depth) {
        one.z_front.push_back(tile.z_front[s]);
        one.z_back.push_back(tile.back(s));
        one.transmittance.push_back(tile.transmittance[s]);
    }
    for (const std::uint32_t s : order)
        one.submission.push_back(
            static_cast<std::uint32_t>(std::lower_bound(by_depth.begin(), by_depth.end(), s) - by_depth.begin()));
    return one;
}

curves::Curve with_medium(curves::Curve curve, const Segment& medium) {
    const auto [front, back, through] = medium;
    if (curve.empty()) return {{front, 1.0f}, {back, through}};
    for (const float z : {front, back}) {
        const auto at = std::lower_bound(curve.begin(), curve.end(), z,
                                         [](const curves::Vertex& v, float depth) { return v.z < depth; });
        if (at == curve.end() || at->z != z) curve.insert(at, {z, curves::evaluate(curve, z)});
    }
    const double rate = std::log(static_cast<double>(through)) / (static_cast<double>(back) - front);
    for (curves::Vertex& v : curve) {
        if (v.z >= back)
            v.value *= through;
        else if (v.z > front)
            v.value *= static_cast<float>(std::exp(rate * (static_cast<double>(v.z) - front)));
    }
    return curve;
}

}  // namespace shadowbench::claims::salvi

#include "curves/sweep_surfaces.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "curves/depth_sort.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

bool surfaces_only(const rays::LightRays& rays, std::size_t first, std::size_t count) {
    const std::size_t begin = rays.begin[first], end = rays.begin[first + count];
    // Compared as bytes, which is fast; zeros of different sign merely cost the general path.
    return rays.z_back.empty() || begin == end ||
           std::memcmp(&rays.z_front[begin], &rays.z_back[begin], (end - begin) * sizeof(float)) == 0;
}

// Transmittances become integers: what a ray loses at its surfaces then adds up exactly to what it has lost in all, so
// the sum neither drifts nor rises, ends at exactly 0 behind opaque surfaces, and is the same in every order of the
// rays.
void visibility_of_surfaces(const rays::LightRays& rays, std::size_t first, std::size_t count, SweepScratch& scratch,
                            Curve& out) {
    const std::size_t segments = rays.begin[first + count] - rays.begin[first];
    const int bits = std::min(52, 62 - static_cast<int>(std::bit_width(count)));
    const std::int64_t one = std::int64_t{1} << bits;

    scratch.order.resize(segments);
    scratch.drops.resize(segments);
    std::uint64_t* const order = scratch.order.data();
    std::int64_t* const drops = scratch.drops.data();
    const std::size_t stride = static_cast<std::size_t>(rays.channels);
    std::size_t events = 0;
    for (std::size_t ray = first; ray < first + count; ++ray) {
        double through = static_cast<double>(one);
        std::int64_t left = one;
        for (std::size_t s = rays.begin[ray], end = rays.begin[ray + 1]; s < end && left > 0; ++s) {
            through *= rays.transmittance[s * stride];
            const std::int64_t now = static_cast<std::int64_t>(through);
            order[events] = depth_item(rays.z_front[s], static_cast<std::uint32_t>(events));
            drops[events] = left - now;
            events += left != now;
            left = now;
        }
    }
    scratch.order.resize(events);
    sort_by_depth(scratch.order, scratch.sorting);

    out.resize(2 * events);
    Vertex* vertex = out.data();
    std::int64_t sum = one * static_cast<std::int64_t>(count);
    const double scale = 1.0 / static_cast<double>(sum);
    float before = 1.0f;
    const std::uint64_t* item = scratch.order.data();
    for (const std::uint64_t* const end = item + events; item != end;) {
        const std::uint64_t key = *item >> 32;
        do sum -= drops[static_cast<std::uint32_t>(*item)];
        while (++item != end && *item >> 32 == key);
        const float after = static_cast<float>(static_cast<double>(sum) * scale);
        if (after == before) continue;  // too little for a float
        const float z = key_depth(static_cast<std::uint32_t>(key));
        *vertex++ = {z, before};
        *vertex++ = {z, after};
        before = after;
    }
    out.resize(static_cast<std::size_t>(vertex - out.data()));
}

}  // namespace shadowbench::curves

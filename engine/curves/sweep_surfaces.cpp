#include "curves/sweep_surfaces.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "curves/depth_sort.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

namespace {

// Compares bytes, which is fast; zeros of different sign merely take the general path.
bool same(const rays::LightRays& rays, std::size_t begin, std::size_t end) {
    return begin == end || std::memcmp(&rays.z_front[begin], &rays.z_back[begin], (end - begin) * sizeof(float)) == 0;
}

// Represents transmittances as integers: the losses of a ray at its surfaces then add up exactly to its total loss, so
// the sum neither drifts nor rises, ends at exactly 0 behind opaque surfaces, and is the same for every order of the
// rays.
class Drops {
public:
    Drops(SweepScratch& scratch, std::size_t most) : scratch_(scratch) {
        scratch.order.resize(most);
        scratch.drops.resize(most);
    }

    // Adds what a ray of this weight loses at each of its surfaces.
    void add(const rays::LightRays& rays, std::size_t ray, int channel, std::int64_t weight) {
        std::uint64_t* const order = scratch_.order.data();
        std::int64_t* const drops = scratch_.drops.data();
        const std::size_t stride = static_cast<std::size_t>(rays.channels);
        const float* const transmittance = rays.transmittance.data() + channel;
        double through = static_cast<double>(weight);
        std::int64_t left = weight;
        std::size_t count = count_;
        for (std::size_t s = rays.begin[ray], end = rays.begin[ray + 1]; s < end && left > 0; ++s) {
            through *= transmittance[s * stride];
            const std::int64_t now = static_cast<std::int64_t>(through);
            order[count] = depth_item(rays.z_front[s], static_cast<std::uint32_t>(count));
            drops[count] = left - now;
            count += left != now;
            left = now;
        }
        count_ = count;
    }

    // Appends the function that starts at 1, which is `sum`.
    void run(std::int64_t sum, Curve& out) {
        scratch_.order.resize(count_);
        sort_by_depth(scratch_.order, scratch_.sorting);
        const std::int64_t* const drops = scratch_.drops.data();
        out.resize(2 * count_);
        Vertex* vertex = out.data();
        const double scale = 1.0 / static_cast<double>(sum);
        float before = 1.0f;
        const std::uint64_t* item = scratch_.order.data();
        for (const std::uint64_t* const end = item + count_; item != end;) {
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

private:
    SweepScratch& scratch_;
    std::size_t count_ = 0;
};

}  // namespace

bool surfaces_only(const rays::LightRays& rays, std::size_t first, std::size_t count) {
    return rays.z_back.empty() || same(rays, rays.begin[first], rays.begin[first + count]);
}

bool surfaces_only(const rays::LightRays& rays, std::span<const WeightedRay> chosen) {
    return rays.z_back.empty() || std::all_of(chosen.begin(), chosen.end(), [&](const WeightedRay& r) {
               return same(rays, rays.begin[r.ray], rays.begin[r.ray + 1]);
           });
}

void visibility_of_surfaces(const rays::LightRays& rays, std::size_t first, std::size_t count, int channel,
                            SweepScratch& scratch, Curve& out) {
    const int bits = std::min(52, 62 - static_cast<int>(std::bit_width(count)));
    const std::int64_t one = std::int64_t{1} << bits;
    Drops drops(scratch, rays.begin[first + count] - rays.begin[first]);
    for (std::size_t ray = first; ray < first + count; ++ray) drops.add(rays, ray, channel, one);
    drops.run(one * static_cast<std::int64_t>(count), out);
}

void visibility_of_surfaces(const rays::LightRays& rays, std::span<const WeightedRay> chosen, int channel,
                            SweepScratch& scratch, Curve& out) {
    double total = 0.0;
    std::size_t segments = 0;
    for (const WeightedRay& r : chosen) {
        total += r.weight;
        segments += rays.begin[r.ray + 1] - rays.begin[r.ray];
    }
    Drops drops(scratch, segments);
    std::int64_t sum = 0;
    for (const WeightedRay& r : chosen) {
        const auto weight = static_cast<std::int64_t>(r.weight / total * 0x1p60);
        drops.add(rays, r.ray, channel, weight);
        sum += weight;
    }
    drops.run(sum, out);
}

}  // namespace shadowbench::curves

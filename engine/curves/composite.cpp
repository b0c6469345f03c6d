#include "curves/composite.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rays/light_rays.h"

namespace shadowbench::curves {

namespace {

// Below this a double product is soon denormal, and its logarithm is no longer an accurate optical depth.
constexpr double kFaintest = 1e-300;

void composite_surfaces(const rays::LightRays& rays, std::size_t ray, int channel, std::vector<Node>& out) {
    double value = 1.0;
    for (std::size_t s = rays.begin[ray], end = rays.begin[ray + 1]; s < end && value > 0.0;) {
        const float z = rays.z_front[s];
        const double before = value;
        for (; s < end && rays.z_front[s] == z; ++s) value *= rays.transmittance[s * rays.channels + channel];
        if (value == before) continue;
        out.push_back({z, before});
        out.push_back({z, value});
    }
}

// Many overlapping media can reach optical depths whose transmittance is 0 in double. The node (z, 0) would hide how
// steeply the function fell, so a node goes where the value is still above 0, at a depth that a float can hold.
void add_faintest(OpenMedia& open, double z, std::vector<Node>& out) {
    const Node last = out.back();
    double extinction = open.extinction();
    for (const std::size_t number : open.ended()) extinction += open.medium(number).per_depth();
    const float low = static_cast<float>(last.z), high = std::numeric_limits<float>::infinity();
    float at = static_cast<float>(last.z + std::log(last.value / kFaintest) / extinction);
    if (at > last.z + std::log(last.value / kFaintest) / extinction) at = std::nextafter(at, low);
    if (!(at > low)) at = std::nextafter(low, high);
    if (at < z) out.push_back({at, last.value * std::exp(-extinction * (at - last.z))});
}

}  // namespace

void composite(const rays::LightRays& rays, std::size_t ray, int channel, OpenMedia& open, std::vector<Node>& out) {
    out.clear();
    if (rays.z_back.empty()) return composite_surfaces(rays, ray, channel, out);

    open.clear();
    double closed = 1.0;  // product of all segments wholly in front
    const std::size_t end = rays.begin[ray + 1];
    std::size_t s = rays.begin[ray];
    const auto through = [&] { return double{rays.transmittance[s * rays.channels + channel]}; };
    while (true) {
        while (s < end && through() >= 1.0) ++s;
        if (s == end && open.empty()) return;
        double z = s < end ? double{rays.z_front[s]} : std::numeric_limits<double>::infinity();
        if (!open.empty()) z = std::min(z, open.first_back());

        open.close(z);
        double before = closed, after = closed;
        for (const std::size_t number : open.ended()) {
            before *= open.medium(number).through_inside();
            after *= open.medium(number).through;
        }
        const double optical_depth = open.optical_depth(z);
        for (; s < end && rays.z_front[s] == z && (rays.z_back[s] <= z || through() >= 1.0); ++s) after *= through();
        // Sorted by z_back at equal z_front: surfaces come first, and a medium ends behind its front.
        closed = after;
        if (optical_depth > 0.0) {
            const double faded = std::exp(-optical_depth);
            before *= faded;
            after *= faded;
        }
        if (!out.empty()) {
            if (before < kFaintest && out.back().value > kFaintest && z > out.back().z) add_faintest(open, z, out);
            before = std::min(before, out.back().value);  // the exponential's last digit may be off
            after = std::min(after, before);
        }
        out.push_back({z, before});
        if (after < before) out.push_back({z, after});
        if (after == 0.0) return;

        for (; s < end && rays.z_front[s] == z; ++s)
            if (through() < 1.0) open.open({z, rays.z_back[s], through()});
    }
}

}  // namespace shadowbench::curves

#include "curves/composite.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rays/light_rays.h"

namespace shadowbench::curves {

namespace {

// Below this a double product is soon denormal, and its logarithm no longer tells the optical depth.
constexpr double kFaintest = 1e-300;

struct Medium {
    double front, back;
    double through;            // transmittance of the whole segment
    double extinction = -1.0;  // per unit of z; computed when first needed, most media never overlap another segment

    double through_inside() const { return std::max(through, double{std::numeric_limits<float>::min()}); }
    double optical_depth(double z) {
        if (extinction < 0.0) extinction = -std::log(through_inside()) / (back - front);
        return extinction * (z - front);
    }
};

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

// Many media one upon the other can reach optical depths whose transmittance is 0 in double. The node (z, 0) would hide
// how steeply the function fell, so a node goes where it is still a number, at a depth that a float can hold.
void add_faintest(std::vector<Medium>& active, double z, std::vector<Node>& out) {
    const Node last = out.back();
    double extinction = 0.0;
    for (Medium& medium : active) extinction += medium.optical_depth(z) - medium.optical_depth(last.z);
    extinction /= z - last.z;
    const float low = static_cast<float>(last.z), high = std::numeric_limits<float>::infinity();
    float at = static_cast<float>(last.z + std::log(last.value / kFaintest) / extinction);
    if (at > last.z + std::log(last.value / kFaintest) / extinction) at = std::nextafter(at, low);
    if (!(at > low)) at = std::nextafter(low, high);
    if (at < z) out.push_back({at, last.value * std::exp(-extinction * (at - last.z))});
}

}  // namespace

void composite(const rays::LightRays& rays, std::size_t ray, int channel, std::vector<Node>& out) {
    out.clear();
    if (rays.z_back.empty()) return composite_surfaces(rays, ray, channel, out);

    std::vector<Medium> active;
    double closed = 1.0;  // product of all that lies wholly in front
    const std::size_t end = rays.begin[ray + 1];
    std::size_t s = rays.begin[ray];
    const auto through = [&] { return double{rays.transmittance[s * rays.channels + channel]}; };
    while (true) {
        while (s < end && through() >= 1.0) ++s;
        if (s == end && active.empty()) return;
        double z = s < end ? double{rays.z_front[s]} : std::numeric_limits<double>::infinity();
        for (const Medium& medium : active) z = std::min(z, medium.back);

        double before = closed, after = closed, optical_depth = 0.0;
        for (Medium& medium : active)
            if (medium.back > z) {
                optical_depth += medium.optical_depth(z);
            } else {
                before *= medium.through_inside();
                after *= medium.through;
            }
        for (; s < end && rays.z_front[s] == z && (rays.z_back[s] <= z || through() >= 1.0); ++s) after *= through();
        // Sorted by z_back at one z_front: the surfaces come first, and a medium ends behind its front.
        closed = after;
        if (optical_depth > 0.0) {
            const double faded = std::exp(-optical_depth);
            before *= faded;
            after *= faded;
        }
        if (!out.empty()) {
            if (before < kFaintest && out.back().value > kFaintest && z > out.back().z) add_faintest(active, z, out);
            before = std::min(before, out.back().value);  // the exponential's last digit
            after = std::min(after, before);
        }
        out.push_back({z, before});
        if (after < before) out.push_back({z, after});
        if (after == 0.0) return;

        std::erase_if(active, [z](const Medium& medium) { return medium.back <= z; });
        for (; s < end && rays.z_front[s] == z; ++s)
            if (through() < 1.0) active.push_back({z, rays.z_back[s], through()});
    }
}

}  // namespace shadowbench::curves

#include "rays/light_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace shadowbench::rays {

void set_samples(MapLayout& layout, int samples) {
    int across = static_cast<int>(std::sqrt(static_cast<double>(samples)));
    while (across > 1 && samples % across != 0) --across;
    layout.samples_x = std::max(across, 1);
    layout.samples_y = samples / layout.samples_x;
}

SamplePosition sample_position(const MapLayout& layout, int i, int j) {
    double u = 0.5, v = 0.5;
    if (layout.jittered) {
        const std::uint64_t bits =
            base::hash(layout.seed, static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint32_t>(j));
        u = static_cast<double>(bits >> 32) * 0x1p-32;
        v = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
    }
    return {(i + u) / layout.samples_x, (j + v) / layout.samples_y};
}

LightRays channel(const LightRays& rays, int channel) {
    LightRays one = rays;
    one.channels = 1;
    if (rays.channels > 1) {
        one.transmittance.resize(rays.segments());
        for (std::size_t s = 0; s < rays.segments(); ++s)
            one.transmittance[s] = rays.transmittance[s * rays.channels + channel];
    }
    return one;
}

double transmittance(const LightRays& rays, std::size_t ray, int channel, double z) {
    double result = 1.0;
    for (std::size_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s) {
        const double front = rays.z_front[s], back = rays.back(s);
        if (front >= z) break;
        const double through = rays.transmittance[s * rays.channels + channel];
        if (back <= z)
            result *= through;
        else  // inside a medium: its optical depth so far; a transmittance of 0 counts as the smallest normal float
            result *= std::exp(std::log(std::max(through, static_cast<double>(std::numeric_limits<float>::min()))) *
                               ((z - front) / (back - front)));
    }
    return result;
}

}  // namespace shadowbench::rays

#include "bench/memory.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"

namespace shadowbench::bench {
namespace {

constexpr double gib = 1024.0 * 1024.0 * 1024.0;
constexpr double ray_bytes = 12.0;  // an offset and one surface

double least_map_bytes(const Contender& contender, double pixels, double rays) {
    switch (contender.row->create(contender.values)->cells()) {
        case techniques::Cells::pixel:
            return pixels * 8.0;
        case techniques::Cells::centre:
            return pixels * 4.0;
        case techniques::Cells::sample:
            return rays * 4.0;
        case techniques::Cells::none:
            break;
    }
    return 0.0;
}

}  // namespace

double least_bytes(const rays::MapLayout& layout, std::span<const Contender> contenders, const MemoryLimits& limits) {
    const double pixels = static_cast<double>(layout.width) * layout.height;
    const double rays = pixels * layout.samples();
    const double tile = static_cast<double>(layout.tile_width) * layout.tile_height * layout.samples() * ray_bytes;
    const double in_flight = 4.0 * base::thread_count() * tile;
    double maps = 0.0, largest = 0.0;
    for (const Contender& contender : contenders) {
        const double one = layout.channels * least_map_bytes(contender, pixels, rays);
        maps += one;
        largest = std::max(largest, one);  // a second one while its build is timed
    }
    return std::min(rays * ray_bytes, static_cast<double>(limits.kept_rays)) + std::min(in_flight, rays * ray_bytes) +
           maps + largest;
}

void check_memory(const rays::MapLayout& layout, std::span<const Contender> contenders, const MemoryLimits& limits,
                  const std::string& where) {
    const double need = least_bytes(layout, contenders, limits);
    if (need <= static_cast<double>(limits.all)) return;
    throw base::Error(
        base::ErrorCode::bad_input, where,
        fmt::format("{} x {} pixels of {} samples need at least {:.3g} GiB; the memory limit is {:.3g} GiB",
                    layout.width, layout.height, layout.samples(), need / gib, static_cast<double>(limits.all) / gib));
}

}  // namespace shadowbench::bench

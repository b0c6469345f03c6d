#include "bench/memory.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/reference.h"
#include "rays/capture.h"

namespace shadowbench::bench {
namespace {

constexpr double mib = 1024.0 * 1024.0, gib = 1024.0 * mib;
constexpr double ray_bytes = 12.0;          // an offset and one surface
constexpr double batch_bytes = 64.0 * mib;  // what a source may hold in flight
constexpr double tile_bytes = 64.0;         // what the capture and the truth keep for every tile, even without rays

// The rays of the tiles that are captured at a time.
double in_flight_bytes(const rays::MapLayout& layout) {
    const double pixels = static_cast<double>(layout.width) * layout.height;
    const double tile = static_cast<double>(layout.tile_width) * layout.tile_height;
    return std::min(4.0 * base::thread_count() * tile, pixels) * layout.samples() * ray_bytes;
}

double all_tiles_bytes(const rays::MapLayout& layout) {
    return tile_bytes * layout.tiles_x() * layout.tiles_y();
}

// The least bytes of all maps, and of the largest of them once more: it exists a second time while builds are timed.
double least_map_bytes(const rays::MapLayout& layout, std::span<const Contender> contenders) {
    double maps = 0.0, largest = 0.0;
    rays::MapLayout one_channel = layout;
    one_channel.channels = 1;
    for (const Contender& contender : contenders) {
        const double bytes =
            contender.row->coloured
                ? static_cast<double>(contender.row->least_bytes(contender.values, layout))
                : layout.channels * static_cast<double>(contender.row->least_bytes(contender.values, one_channel));
        maps += bytes;
        largest = std::max(largest, bytes);
    }
    return maps + largest;
}

}  // namespace

double least_bytes(const rays::MapLayout& layout, const rays::MapLayout& reference,
                   std::span<const Contender> contenders) {
    // The truth is found before any map is built.
    const double building = in_flight_bytes(layout) + least_map_bytes(layout, contenders);
    const double judging = in_flight_bytes(reference) + all_tiles_bytes(reference);
    return all_tiles_bytes(layout) + std::max(building, judging);
}

double least_ray_bytes(const rays::MapLayout& layout) {
    return static_cast<double>(layout.width) * layout.height * layout.samples() * ray_bytes;
}

double check_memory(const scene::Scenario& scenario, const rays::LightView& view, std::span<const Contender> contenders,
                    const MemoryLimits& limits, const std::string& where) {
    const rays::MapLayout layout = rays::make_layout(scenario.scene, view, scenario.rays);
    const scene::RaySettings judging = reference_settings(scenario);
    const rays::MapLayout reference =
        rays::make_layout(scenario.scene, view, settings_of_a_set(scenario.scene, judging));
    const double need = least_bytes(layout, reference, contenders);
    if (need <= static_cast<double>(limits.all)) return need;
    throw base::Error(base::ErrorCode::bad_input, where,
                      fmt::format("{} x {} pixels of {} samples, and {} for the reference, need at least {:.3g} GiB; "
                                  "the memory limit is {:.3g} GiB",
                                  layout.width, layout.height, layout.samples(),
                                  reference.samples() * ray_sets(scenario.scene, judging).sets, need / gib,
                                  static_cast<double>(limits.all) / gib));
}

std::size_t resident_bytes() {
#if defined(__GLIBC__)
    malloc_trim(0);  // what is free does not count
#endif
    std::ifstream file("/proc/self/statm");
    std::size_t reserved = 0, resident = 0;
    file >> reserved >> resident;
    return file ? resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

MemoryLimits limits_beside(std::size_t held, const rays::MapLayout& layout, std::span<const Contender> contenders,
                           MemoryLimits limits) {
    limits.held = held;
    const double others = static_cast<double>(held) + all_tiles_bytes(layout) +
                          std::max(in_flight_bytes(layout), batch_bytes) + least_map_bytes(layout, contenders);
    const double left = std::max(0.0, static_cast<double>(limits.all) - others);
    limits.kept_rays = std::min(limits.kept_rays, static_cast<std::size_t>(left));
    return limits;
}

std::size_t room_beside(std::span<const Contender> contenders, const RaySource& source, const MemoryLimits& limits) {
    std::size_t held = limits.held + source.kept_bytes();
    for (const Contender& contender : contenders)
        if (contender.ok()) held += contender.cell.bytes;
    return limits.all > held ? limits.all - held : 0;
}

void make_room(std::span<const Contender> contenders, RaySource& source, const MemoryLimits& limits) {
    std::size_t largest = 0;
    for (const Contender& contender : contenders)
        if (contender.ok()) largest = std::max(largest, contender.cell.working_bytes);
    if (room_beside(contenders, source, limits) < largest) source.drop_kept();
}

}  // namespace shadowbench::bench

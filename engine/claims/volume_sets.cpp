#include "claims/volume_sets.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/lookup_timing.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::volume {
namespace {

using results::Cell;
using results::LightResult;

}  // namespace

const Cell& volume_deep(const LightResult& light, const char* interpolation, int steps, const char* filter) {
    return cell_of(light, "volume_deep",
                   {fmt::format("interpolation={}", interpolation), fmt::format("steps={}", steps),
                    fmt::format("filter={}", filter)});
}

const Cell& avsm(const LightResult& light, int nodes) {
    return cell_of(light, "avsm", {fmt::format("nodes={}", nodes)});
}

std::size_t place_of(const Cell& cell, const LightResult& light) {
    return static_cast<std::size_t>(&cell - light.cells.data());
}

double bytes_a_texel(const Cell& cell, const LightResult& light) {
    return static_cast<double>(cell.bytes) / (static_cast<double>(light.layout.width) * light.layout.height);
}

MeasuredSet measure_set(const Context& context, const DataSet& set) {
    const char* plane_alone = "receivers.media_lookups=0";
    const char* plane_techniques = R"(techniques=[{"type":"volume_deep","cells":"sample"}])";
    const std::vector<std::string> smaller = {"rays.resolution=128", "receivers.resolution=64"};
    MeasuredSet m{set.name,
                  context.run(set.scenario, {}, smaller),
                  context.run(set.scenario, {plane_alone, plane_techniques}, smaller),
                  {},
                  {},
                  0};
    const base::ThreadLimit threads(context.threads);
    const SeededLight light(context, set.scenario, {}, smaller);
    {
        const std::vector<bench::Maps> maps = light.build(0);
        const bench::QuerySet all = light.queries();
        const bench::QuerySet asked = bench::pick(all.asked(), bench::choose_runs(all.queries.size(), 32768));
        std::vector<TimedLookups> timed;
        for (const bench::Maps& map : maps) timed.push_back({&map, asked.asked()});
        m.lookups = lookup_turns(timed, {});
    }
    m.builds = light.build_turns({});
    m.march = light.capture_place();
    return m;
}

}  // namespace shadowbench::claims::volume

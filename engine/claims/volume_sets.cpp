#include "claims/volume_sets.h"

#include <span>
#include <string>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/lookup_timing.h"
#include "claims/seeded_light.h"
#include "metrics/statistics.h"

namespace shadowbench::claims::volume {
namespace {

using results::Cell;
using results::LightResult;

double rms_between(std::span<const float> a, std::span<const float> b) {
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) differences[i] = static_cast<double>(a[i]) - b[i];
    return metrics::error_norms(differences).rms;
}

// Exact for these maps and receivers: nothing is drawn.
Value between(const std::vector<bench::Maps>& maps, const bench::QuerySet& asked, const LightResult& light, int steps) {
    const auto answers = [&](const char* interpolation) {
        return bench::lookup_all(maps[place_of(volume_deep(light, interpolation, steps), light)], asked.asked());
    };
    return exactly(rms_between(answers("smooth"), answers("bucket")));
}

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
                  0,
                  {}};
    const base::ThreadLimit threads(context.threads);
    const SeededLight light(context, set.scenario, {}, smaller);
    {
        const std::vector<bench::Maps> maps = light.build(0);
        const bench::QuerySet all = light.queries();
        m.apart = {between(maps, all, m.light(), map_steps), between(maps, all, m.light(), few_steps)};
        const bench::QuerySet asked = bench::pick(all.asked(), bench::choose_runs(all.queries.size(), 32768));
        std::vector<TimedLookups> timed;
        for (const bench::Maps& map : maps) timed.push_back({&map, asked.asked()});
        m.lookups = lookup_turns(timed, {});
    }
    const Compared compared[] = {{place_of(volume_deep(m.light(), "smooth"), m.light()),
                                  place_of(volume_deep(m.light(), "bucket"), m.light())}};
    m.builds = light.build_turns(compared);
    m.march = light.capture_place();
    return m;
}

}  // namespace shadowbench::claims::volume

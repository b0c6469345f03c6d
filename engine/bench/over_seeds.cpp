#include "bench/over_seeds.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/gather.h"
#include "bench/ray_source.h"
#include "rays/capture.h"

namespace shadowbench::bench {
namespace {

// The sums of the rays of all tiles for each query. The captured segments hold the grid volumes.
std::vector<Moments> gather_kept(const RaySource& source, const techniques::BuildInput& input,
                                 std::span<const techniques::Query> queries, Gather gather) {
    static const rays::GridMedia no_grids({}, true);
    std::vector<std::vector<Part>> parts = parts_by_tile(input.layout, queries);
    std::size_t first = 0;
    source.for_each_batch(0, [&](RaySource::Batch batch) {
        base::parallel_for(batch.size(), [&](std::size_t i) {
            gather(batch[i], input.layout, queries, {no_grids, input.view}, parts[first + i]);
        });
        first += batch.size();
    });
    return reduce(parts, queries.size());
}

// The mean of the rays inside each footprint, or the nearest ray if there is none; channel after channel.
std::vector<double> means_of_rays(const RaySource& source, const techniques::BuildInput& input,
                                  std::span<const techniques::Query> queries) {
    const std::vector<Moments> moments =
        gather_or_nearest(queries, [&](std::span<const techniques::Query> asked, Gather gather) {
            return gather_kept(source, input, asked, gather);
        });
    std::vector<double> means;
    for (int c = 0; c < input.layout.channels; ++c)
        for (const Moments& m : moments) means.push_back(m.count ? m.sum[c] / static_cast<double>(m.count) : 1.0);
    return means;
}

// Sums of values over seeds, each with its squares.
class SpreadOfMeans {
public:
    void add(const std::vector<double>& means) {
        sum_.resize(means.size());
        squares_.resize(means.size());
        for (std::size_t i = 0; i < means.size(); ++i) {
            sum_[i] += means[i];
            squares_[i] += means[i] * means[i];
        }
        ++seeds_;
    }
    Spread spread() const {
        Spread spread;
        double total = 0.0;
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            const double variance = std::max(0.0, (squares_[i] - sum_[i] * sum_[i] / seeds_) / (seeds_ - 1.0));
            total += variance;
            spread.max = std::max(spread.max, std::sqrt(variance));
        }
        if (!sum_.empty()) spread.rms = std::sqrt(total / static_cast<double>(sum_.size()));
        return spread;
    }

private:
    std::vector<double> sum_, squares_;
    int seeds_ = 0;
};

// Builds the contenders from these rays and adds what they answer. The maps are dropped again.
void build_and_judge(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                     const Asked& judged, const Truth& truth, std::size_t memory_limit) {
    std::vector<Contender> built;
    for (const Contender& contender : contenders) built.push_back(unbuilt(contender));
    build_all(built, source, input, memory_limit, {});
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        Contender& contender = contenders[i];
        if (!contender.ok()) continue;
        const std::vector<double> errors = errors_of(built[i], judged, truth);
        if (!built[i].ok()) {
            contender.cell.over_seeds.clear();
            fail(contender, fmt::format("with the rays of seed {}: {}", input.layout.seed, built[i].cell.reason));
            continue;
        }
        contender.seed_errors.add(errors);
        contender.cell.over_seeds.push_back({metrics::error_norms(errors), built[i].cell.bytes});
    }
}

}  // namespace

Spread measure_over_seeds(const OtherRays& rays, std::span<Contender> contenders, const Asked& judged,
                          const Truth& truth, const ReferenceWatch& watch) {
    if (!rays.input.layout.jittered || rays.seeds < 2) return {};
    SpreadOfMeans spread;
    for (int s = 0; s < rays.seeds; ++s) {
        rays::MapLayout layout = rays.input.layout;
        layout.seed = base::hash(layout.seed, static_cast<std::uint64_t>(s) + 1);
        const techniques::BuildInput input{layout, rays.input.view, rays.input.tracer};
        const rays::Capture capture(rays.scene, input.view, layout);
        const RaySource source(capture, layout, rays.limits.kept_rays, {});
        spread.add(means_of_rays(source, input, judged.queries));
        build_and_judge(contenders, source, input, judged, truth, rays.limits.all);
        if (watch) watch(static_cast<std::size_t>(s) + 1, static_cast<std::size_t>(rays.seeds));
    }
    return spread.spread();
}

}  // namespace shadowbench::bench

// How long Trials foresees that measurements take, and what it knows of bytes without them.
#include <algorithm>
#include <utility>

#include "recommend/attempt.h"

namespace shadowbench::recommend {
namespace {

constexpr double large_pixels = 1 << 16;  // of a map that may be large
constexpr double timing_seconds = 0.5;    // of the least repetitions of one point

double least_bytes(const Setting& setting, rays::MapLayout layout) {
    if (setting.row->coloured) return static_cast<double>(setting.row->least_bytes(setting.values, layout));
    const int channels = std::exchange(layout.channels, 1);
    return channels * static_cast<double>(setting.row->least_bytes(setting.values, layout));
}

}  // namespace

double Trials::effort(const Point& point) const {
    // Asked often: no setting is made unless a map of these light rays is kept.
    const bench::RayChoice own{space_->resolution(point), space_->samples(point), scenario_->rays.seed};
    const techniques::Technique* row = &space_->row(point.family);
    for (const Kept& kept : kept_)
        if (kept.setting.row == row && kept.setting.resolution == own.resolution && kept.setting.samples == own.samples &&
            same_map(kept.setting, space_->setting(point)))
            return rest_of_a_trial;
    return rest_of_a_trial + build_seconds(point) + (store_->kept(own) ? 0.0 : store_->estimate_seconds(own));
}

double Trials::least_effort() const {
    return rest_of_a_trial;
}

// What building and judging the map takes, as far as maps of the technique tell, and large maps of any.
double Trials::build_seconds(const Point& point) const {
    const base::Vec2i sides = space_->resolution(point);
    const double pixels = static_cast<double>(sides.x) * sides.y;
    const auto before = efforts_.find(&space_->row(point.family));
    const bool grows = space_->uses_rays(point.family) && before != efforts_.end() && before->second.rays > 0.0;
    const double by_rays = grows ? pixels * space_->samples(point) * before->second.seconds / before->second.rays : 0.0;
    // Maps of few pixels are not large: no setting is made for them.
    if (pixels < large_pixels) return by_rays;
    const double bytes = at_least(point, Cost::bytes);
    return bytes < large_map ? by_rays : std::max(by_rays, bytes * large_seconds_ / large_bytes_);
}

double Trials::at_least(const Point& point, Cost cost) const {
    if (cost != Cost::bytes) return 0.0;
    const std::vector<Axis>& axes = families()[point.family].axes;
    std::size_t index = 0, points = 1;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        index = index * axes[a].values.size() + static_cast<std::size_t>(point.step[a]);
        points *= axes[a].values.size();
    }
    least_bytes_.resize(std::max(least_bytes_.size(), point.family + 1));
    std::vector<double>& known = least_bytes_[point.family];
    if (known.empty()) known.assign(points, -1.0);
    if (known[index] < 0.0) {
        const Setting setting = space_->setting(point);
        known[index] = least_bytes(setting, layout(setting));
    }
    return known[index];
}

// What comparing the answers of a measured point with the truth takes on one thread. Shadow rays take seconds.
double Trials::judging_seconds(const Point& point) const {
    const Trial* trial = trial_of(point);
    if (!trial) return 0.0;
    const double ns = trial->cost[static_cast<std::size_t>(Cost::lookup)];
    return 1e-9 * ns * static_cast<double>(judged_.queries.size());
}

// Every seed has light rays of its own.
double Trials::confirm_effort(const Point& point, std::span<const Point> others) const {
    const bench::RayChoice own{space_->resolution(point), space_->samples(point), scenario_->rays.seed};
    const bool captured = std::any_of(others.begin(), others.end(), [&](const Point& other) {
        return space_->uses_rays(other.family) && space_->resolution(other) == own.resolution &&
               space_->samples(other) == own.samples;
    });
    const double build = build_seconds(point),
                 capture = space_->uses_rays(point.family) && !captured ? store_->estimate_seconds(own) : 0.0;
    return seeds * (capture + build + judging_seconds(point) + rest_of_a_trial) + fewer_builds * build + timing_seconds;
}

}  // namespace shadowbench::recommend

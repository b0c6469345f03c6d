#include "service/jobs/fraction.h"

#include <algorithm>
#include <string_view>

namespace shadowbench::service {
namespace {

constexpr double measured_of_both = 0.75;  // share of the measurements in a job with pictures

}  // namespace

// A compromise between two scenarios: lookups take most of quickstart, the reference and builds most of smoke_column.
const JobFraction::Stage JobFraction::measuring_stages[] = {
    {"reference", 0.28}, {"spread over seeds", 0.09}, {"capture", 0.03},       {"build", 0.03},
    {"check", 0.06},     {"timing builds", 0.18},     {"timing lookups", 0.33}};
const JobFraction::Stage JobFraction::picturing_stages[] = {
    {"view rays", 0.05}, {"capture", 0.05}, {"build", 0.1}, {"lookup", 0.1}, {"reference", 0.7}};

JobFraction::JobFraction(std::size_t lights, std::size_t pictured)
    : measured_{measuring_stages, std::max<std::size_t>(lights, 1)},
      pictured_{picturing_stages, std::max<std::size_t>(pictured, 1)},
      measured_share_(pictured > 0 ? measured_of_both : 1.0) {}

double JobFraction::Part::done(const bench::Progress& progress) {
    const auto named = [&](const Stage& stage) { return std::string_view(stage.name) == progress.stage; };
    if (std::none_of(stages.begin(), stages.end(), named)) return 0.0;  // such as loading, which is for no light
    // The place names the light; it is empty if there is only one.
    if (begun && progress.place != place) light = std::min(light + 1, lights - 1);
    begun = true;
    place = progress.place;
    double before = 0.0;
    for (const Stage& stage : stages) {
        const double within = static_cast<double>(progress.done) /
                              static_cast<double>(std::max<std::size_t>({progress.total, progress.done, 1}));
        if (named(stage))
            return (static_cast<double>(light) + before + stage.share * within) / static_cast<double>(lights);
        before += stage.share;
    }
    return 0.0;
}

double JobFraction::measuring(const bench::Progress& progress) {
    return fraction_ = std::max(fraction_, measured_share_ * measured_.done(progress));
}

double JobFraction::picturing(const bench::Progress& progress) {
    return fraction_ = std::max(fraction_, measured_share_ + (1.0 - measured_share_) * pictured_.done(progress));
}

}  // namespace shadowbench::service

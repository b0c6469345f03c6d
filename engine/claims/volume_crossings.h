// Deep shadow maps from volumetric data: where in a step a level is crossed, and how many steps there are, over several
// seeds of jittered light rays.
#pragma once

#include <vector>

#include "claims/paper.h"
#include "claims/turns.h"
#include "claims/volume.h"

namespace shadowbench::claims::volume {

inline constexpr int few_steps = 64;

// Of the maps of one data set with so many steps, smooth and bucket; a value for each seed. Lookups are of one texel.
// Errors are against the exact light at the receivers.
struct StepNumbers {
    std::vector<double> smooth, bucket;            // error rms of lookups
    std::vector<double> smooth_mean, bucket_mean;  // mean errors: above 0 too bright
    std::vector<double> apart;                     // rms difference of both maps' lookups
    std::vector<double> light_apart;               // and of their average opacities along view rays
    std::vector<double> smooth_depth, bucket_depth;  // mean distance of the stored depths from the exact ones, steps
};

struct Crossings {
    const char* name;
    StepNumbers all, few;            // with 512 and with 64 steps
    std::vector<double> shadow_map;  // error rms of the lookups of a standard shadow map
    Turns builds;                    // of the smooth map, the bucket map and the capture
};
Crossings measure_crossings(const Context& context, const DataSet& set);

void add_crossings(const std::vector<Crossings>& sets, PaperReport& report);

}  // namespace shadowbench::claims::volume

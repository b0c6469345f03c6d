// What is measured of the data sets of the paper on deep shadow maps from volumetric data, for its tables and claims.
#pragma once

#include <cstddef>
#include <vector>

#include "claims/paper.h"
#include "claims/turns.h"
#include "claims/volume.h"

namespace shadowbench::claims::volume {

// The results of one data set: all techniques with receivers in the volume and on the plane, and some with receivers
// only on the plane. Times are of all techniques.
struct MeasuredSet {
    const char* name;
    results::Result both, plane;
    Turns builds, lookups;  // in ms, in ns
    std::size_t march;      // the place of the capture among the builds

    const results::LightResult& light() const { return light_of(both); }
    const results::LightResult& behind() const { return light_of(plane); }
};
using Sets = std::vector<MeasuredSet>;

MeasuredSet measure_set(const Context& context, const DataSet& set);

const results::Cell& volume_deep(const results::LightResult& light, const char* interpolation, int steps = map_steps,
                                 const char* filter = "footprint");
const results::Cell& avsm(const results::LightResult& light, int nodes);
// The place of a cell among the techniques.
std::size_t place_of(const results::Cell& cell, const results::LightResult& light);
double bytes_a_texel(const results::Cell& cell, const results::LightResult& light);

}  // namespace shadowbench::claims::volume

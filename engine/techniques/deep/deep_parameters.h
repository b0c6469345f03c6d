// The parameters of deep shadow maps, and what their values mean.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "techniques/deep/deep_lookup.h"
#include "techniques/deep/pixel_filter.h"
#include "techniques/deep/pixel_run.h"
#include "techniques/technique.h"

namespace shadowbench::techniques::deep_parameters {

std::span<const Parameter> all();
// What a search over settings varies.
std::vector<Trade> trades();

double tolerance_of(const ParameterValues& values, int samples);  // of a map with so many rays a pixel
Compression::Method method_of(const ParameterValues& values);
PixelFilter filter_of(const ParameterValues& values);
LookupRule rule_of(const ParameterValues& values);
bool has_levels_of_samples(const ParameterValues& values);  // mip_from=samples
std::size_t slots_of(const ParameterValues& values);        // 0: storage=memory

}  // namespace shadowbench::techniques::deep_parameters

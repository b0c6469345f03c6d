// What the result of a light says of its map, its rays and its truth.
#pragma once

#include <span>

#include "bench/queries.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
#include "rays/light_rays.h"
#include "results/result.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// The light, its map and its receivers; the rest is empty.
results::LightResult describe_light(const scene::Scenario& scenario, const scene::Light& light,
                                    const rays::MapLayout& layout, const QuerySet& set);

// Fills in the captured rays and their times. `setup_seconds`: preparing the scene for the light.
void report_capture(const RaySource& source, double setup_seconds, results::LightResult& result);

// The truth of the judged queries. The spread over seeds is absent.
results::ReferenceReport report_reference(const rays::MapLayout& layout, std::span<const techniques::Query> judged,
                                          const Truth& truth);

}  // namespace shadowbench::bench

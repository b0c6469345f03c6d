// The deep shadow map of a data set of the volume paper, for the parts that make pictures of it.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "claims/claim.h"
#include "claims/paper.h"
#include "rays/light_view.h"
#include "render/image.h"
#include "scene/scene.h"

namespace shadowbench::claims::volume {

// The paper's map of a scenario, and what it was made from.
struct VolumeMap {
    const scene::Scenario& scenario;
    const scene::Object& object;    // the volume
    const scene::GridVolume& grid;  // its shape
    const rays::LightView& view;
    const bench::Maps& maps;  // `volume_deep`, whose lookups answer from one texel
};

// The object of a scenario that is a grid volume. Throws Error{internal} if there is none.
const scene::Object& volume_of(const scene::Scenario& scenario);

// Builds the map of scenarios/papers/<name>.json at this resolution, and calls `use`. Notes the scenario in the report.
void with_map(const Context& context, const char* name, int resolution,
              const std::function<void(const VolumeMap&)>& use);

// Pictures of one size, row after row.
Sheet sheet_of(const std::string& name, const std::string& caption, std::span<const render::Image> pictures,
               int columns);

}  // namespace shadowbench::claims::volume

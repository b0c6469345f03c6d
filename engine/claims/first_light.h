// The first light of a document, ready for capture: where every measurement begins that is no run.
#pragma once

#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/contender.h"
#include "bench/load.h"
#include "bench/maps.h"
#include "bench/prepared_light.h"
#include "document/document.h"
#include "rays/light_rays.h"
#include "scene/scenario.h"

namespace shadowbench::claims {

struct FirstLight {
    // The document's first variant counts. Throws what loading it and preparing the light throw.
    FirstLight(const nlohmann::json& document, const scene::SearchPath& data);
    FirstLight(const FirstLight&) = delete;  // maps refer to the view
    FirstLight& operator=(const FirstLight&) = delete;

    techniques::BuildInput input() const { return {light.layout, light.view, nullptr}; }
    // All light rays.
    std::vector<rays::LightRays> tiles() const;
    // The map that one of the contenders makes of these tiles.
    bench::Maps build(const bench::Contender& contender, std::span<const rays::LightRays> tiles) const;

    document::Variant variant;
    bench::ScenarioLoader loader;
    const scene::Scenario& scenario;
    std::vector<bench::Contender> contenders;  // of all techniques, in the document's order; nothing is built
    bench::PreparedLight light;
};

}  // namespace shadowbench::claims

#include "bench/prepared_light.h"

#include <fmt/format.h>

namespace shadowbench::bench {

std::string pointer_of(const scene::Scenario& scenario, std::size_t light) {
    return scenario.scene.deep_image ? "/scene/deep_image" : fmt::format("/lights/{}", light);
}

PreparedLight prepare_light(const scene::Scenario& scenario, std::size_t light, std::span<const Contender> contenders,
                            const MemoryLimits& limits) {
    PreparedLight prepared;
    prepared.view = rays::make_light_view(scenario.lights[light], scenario.scene, scenario.rays.resolution,
                                          pointer_of(scenario, light));
    prepared.layout = rays::make_layout(scenario.scene, prepared.view, scenario.rays);
    prepared.least_bytes = check_memory(scenario, prepared.view, contenders, limits, "/rays");
    ask_for_needs(contenders, prepared.layout);
    return prepared;
}

}  // namespace shadowbench::bench

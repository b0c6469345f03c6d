#include "bench/prepared_light.h"

namespace shadowbench::bench {

PreparedLight prepare_light(const scene::Scenario& scenario, std::size_t light, std::span<const Contender> contenders,
                            const MemoryLimits& limits) {
    PreparedLight prepared;
    prepared.view = rays::make_light_view(scenario.lights[light], scenario.scene, scenario.rays.resolution,
                                          scenario.lights[light].where);
    prepared.layout = rays::make_layout(scenario.scene, prepared.view, scenario.rays);
    prepared.least_bytes = check_memory(scenario, prepared.view, contenders, limits, "/rays");
    ask_for_needs(contenders, prepared.layout);
    return prepared;
}

}  // namespace shadowbench::bench

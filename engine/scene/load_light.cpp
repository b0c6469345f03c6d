#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"

namespace shadowbench::scene {
namespace {

void load_directional(const json& from, const Box3d& casters, const std::string& where, Light& light) {
    light.type = LightType::directional;
    light.target = casters.center();
    read(from, "direction", light.direction);
    read(from, "target", light.target);
    read(from, "extent", light.extent);
    check_direction(light.direction, where + "/direction");
    light.direction.normalize();
}

void load_spot(const json& from, const std::string& where, Light& light) {
    light.type = LightType::spot;
    read(from, "position", light.position);
    read(from, "target", light.target);
    read(from, "angle", light.angle);
    read(from, "near", light.near);
    light.direction = light.target - light.position;
    if (!(light.direction.length() >= min_length))
        refuse(where + "/target", "the light stands at its target; move one of them");
    light.direction.normalize();
}

}  // namespace

bool has_map(const json& light) {
    return light.value("casts_shadow", true);
}

std::string light_name(const json& from, std::size_t index) {
    std::string name = fmt::format("{}_{}", from["type"].get<std::string>(), index);
    read(from, "name", name);
    return name;
}

Light load_light(const json& from, std::size_t index, const Box3d& casters, const std::string& where) {
    Light light;
    light.where = where;
    const std::string type = from["type"].get<std::string>();
    light.name = light_name(from, index);
    read(from, "colour", light.colour);
    read(from, "up", light.up);
    if (from.contains("softness")) light.softness = footprint_width(from["softness"]);
    if (type == "spot")
        load_spot(from, where, light);
    else
        load_directional(from, casters, where, light);
    if (light.up) {
        check_direction(*light.up, where + "/up");
        check_not_parallel(*light.up, light.direction, where + "/up", "up points along the light");
    }
    return light;
}

void load_lights(const json& list, Scenario& scenario) {
    const Box3d casters = bounds(scenario.scene, true);
    std::set<std::string> names;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string where = fmt::format("/lights/{}", i);
        Light light = load_light(list[i], i, casters, where);
        if (!names.insert(light.name).second)
            refuse(where + "/name", fmt::format("two lights are called \"{}\"", light.name));
        (has_map(list[i]) ? scenario.lights : scenario.fills).push_back(std::move(light));
    }
    if (scenario.lights.empty())
        refuse("/lights", "no light casts a shadow; set casts_shadow to true for at least one");
}

}  // namespace shadowbench::scene

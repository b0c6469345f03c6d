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

std::string light_name(const json& from, std::size_t index) {
    std::string name = fmt::format("{}_{}", from["type"].get<std::string>(), index);
    read(from, "name", name);
    return name;
}

Light load_light(const json& from, std::size_t index, const Box3d& casters, const std::string& where) {
    Light light;
    const std::string type = from["type"].get<std::string>();
    light.name = light_name(from, index);
    read(from, "colour", light.colour);
    read(from, "up", light.up);
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

}  // namespace shadowbench::scene

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/cube_face.h"
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

void load_point(const json& from, Light& light) {
    light.type = LightType::spot;
    read(from, "position", light.position);
    read(from, "near", light.near);
    light.border = 0.125;
    read(from, "border", light.border);
}

std::string face_name(const std::string& light, std::size_t face) {
    return fmt::format("{} {}", light, cube_faces[face]);
}

bool has_face(const json& light, std::size_t face) {
    const auto faces = light.find("faces");
    return faces == light.end() || std::count(faces->begin(), faces->end(), cube_faces[face]) > 0;
}

// The distance of the farthest corner of the box.
double reach(const Box3d& box, const Vec3d& place) {
    Vec3d farthest;
    for (int axis = 0; axis < 3; ++axis)
        farthest[axis] = std::max(std::abs(box.min[axis] - place[axis]), std::abs(box.max[axis] - place[axis]));
    return std::max(farthest.length(), min_length);
}

// Six lights in the place of one, whose targets are as far as the casters; those of faces without a map cast no shadow.
void add_faces(const json& from, const Box3d& casters, const Light& light, Scenario& scenario) {
    const double distance = reach(casters, light.position);
    for (std::size_t i = 0; i < cube_faces.size(); ++i) {
        Light face = light;
        face.face = static_cast<int>(i);
        face.name = face_name(light.name, i);
        face.direction = face_direction(*face.face);
        face.target = light.position + face.direction * distance;
        if (!((face.target - light.position).length() >= 0.5 * distance))
            refuse(light.where + "/position",
                   "the light is so far from the origin that double cannot tell its faces apart: bring it nearer");
        (has_face(from, i) ? scenario.lights : scenario.fills).push_back(std::move(face));
    }
}

}  // namespace

std::vector<std::string> map_names(const json& light, std::size_t index) {
    if (!light.value("casts_shadow", true)) return {};
    const std::string name = light_name(light, index);
    if (light.at("type") != "point") return {name};
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cube_faces.size(); ++i)
        if (has_face(light, i)) names.push_back(face_name(name, i));
    return names;
}

std::string light_name(const json& from, std::size_t index) {
    std::string name = fmt::format("{}_{}", from.at("type").get<std::string>(), index);
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
    else if (type == "point")
        load_point(from, light);
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
        const auto claim = [&](const std::string& name) {
            if (!names.insert(name).second) refuse(where + "/name", fmt::format("two lights are called \"{}\"", name));
        };
        claim(light.name);
        const std::vector<std::string> maps = map_names(list[i], i);
        for (const std::string& name : maps)
            if (name != light.name) claim(name);
        if (list[i]["type"] == "point" && !maps.empty())
            add_faces(list[i], casters, light, scenario);
        else
            (maps.empty() ? scenario.fills : scenario.lights).push_back(std::move(light));
    }
    if (scenario.lights.empty())
        refuse("/lights", "no light casts a shadow; set casts_shadow to true for at least one");
}

}  // namespace shadowbench::scene

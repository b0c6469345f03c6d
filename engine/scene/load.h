// The parts of load_scenario. Each takes JSON that has passed the schema; `where` is its JSON pointer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scene/readers/files.h"
#include "scene/scenario.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// The light's own name, or one made from its type and number.
std::string light_name(const nlohmann::json& from, std::size_t index);

// Aims a directional light without "target" at the middle of `casters`.
Light load_light(const nlohmann::json& from, std::size_t index, const Box3d& casters, const std::string& where);

// The names of the maps of a light: none if it casts no shadow, one for each face of a point light, else its own name.
std::vector<std::string> map_names(const nlohmann::json& light, std::size_t index);

// One light for each map of the list, and the others as fills. Throws Error{bad_input} if there is no map.
void load_lights(const nlohmann::json& list, Scenario& scenario);

// The width that an object like {"share": 0.01} gives; that of the receivers; and the receivers.
FilterWidth footprint_width(const nlohmann::json& from);
FilterWidth load_filter_width(const nlohmann::json& from);
Receivers load_receivers(const nlohmann::json& from);

// Throws Error{bad_input}, also if the object holds nothing.
Object load_object(const nlohmann::json& from, std::size_t index, const SearchPath& path, const std::string& where);

// Merges consecutive equal points of a strand into one that keeps the larger radius, and drops strands that are left
// with a single point. A segment without length has no direction, and ray intersectors disagree on whether it is hit.
void merge_equal_points(Hair& hair);

// Loaders of shapes that several object types share.
MeshFile load_mesh(const nlohmann::json& from, const SearchPath& path, const std::string& where);
Mesh load_quad(const nlohmann::json& from, const SearchPath& path, const std::string& where);
Mesh load_layers(const nlohmann::json& from, const std::string& where);
GridVolume load_volume(const nlohmann::json& from, const SearchPath& path, const std::string& where);
GridVolume load_cloud(const nlohmann::json& from, const std::string& where);
GridVolume load_density_box(const nlohmann::json& from, const std::string& where);
GridVolume load_crossed_rods(const nlohmann::json& from, const std::string& where);

// The step of a volume that has its place in the world.
void read_step(const nlohmann::json& from, const std::string& where, GridVolume& volume);

// Reads the keys of an object that has passed the schema: first up, then scale, rotate (around x, then y, then z) and
// translate, or instead of these three the matrix. Empty if the object stays as it is. Throws Error{bad_input} if the
// keys contradict each other, or flatten the object.
std::optional<base::Matrix4d> load_transform(const nlohmann::json& from, const std::string& where);

// Moves all points. Radii and half-widths grow with the cube root of the growth of volumes. A volume keeps its voxels
// and its densities. Throws Error{bad_input} if something leaves the range of coordinates, or if spheres would become
// ellipsoids.
void apply(const base::Matrix4d& transform, Object& object, const std::string& where);

}  // namespace shadowbench::scene

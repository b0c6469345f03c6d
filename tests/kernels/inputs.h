// Procedural scenes and their light rays, the inputs of the kernels. They are the same in every run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "curves/curve.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::kernels {

// hair: translucent strands. mesh: a crumpled sheet of triangles. smoke: overlapping particles. cloud: a grid volume.
// mixed: hair in smoke.
enum class Kind { hair, mesh, smoke, cloud, mixed };
const char* name_of(Kind kind);

scene::Hair make_hair();
scene::Mesh make_mesh(int cells);  // cells per side; two triangles per cell

struct Input {
    scene::Scene scene;
    scene::Light light;
    scene::RaySettings settings;
    rays::LightView view;
    rays::MapLayout layout;
};
using SharedInput = std::shared_ptr<const Input>;

// A scene as one light sees it, in a map of `map` x `map` pixels with this number of rays a pixel.
SharedInput make_input(Kind kind, int map, int samples);

std::vector<rays::LightRays> capture_all(const Input& input);
std::size_t segments_of(const std::vector<rays::LightRays>& tiles);
void append_lines(const std::vector<rays::LightRays>& tiles, std::vector<const void*>& lines);

// The uncompressed function of every pixel that is not lit everywhere.
std::vector<curves::Curve> functions_of(Kind kind, int map, int samples);

// An argument in a kernel's name, as "map:64" or "/samples:16".
std::string argument(const char* name, double value);

}  // namespace shadowbench::kernels

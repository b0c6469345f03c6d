// Which part of what a camera sees lies inside the map of a light, and which part of the map that is, from places of the
// objects, before any ray is traced.
#pragma once

#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// Of some thousand places spread over the object's primitives, of those that the camera's frame holds, the share inside
// the frame of the light's map: 1 if the camera's frame holds none. What hides what is neglected.
double share_in_map(const scene::Object& object, const rays::LightView& camera, const rays::LightView& light);

// The share of the map where such places of any object lie: 1 if too few are known.
double seen_share_of_map(const scene::Scene& scene, const rays::LightView& camera, const rays::LightView& light);

}  // namespace shadowbench::bench

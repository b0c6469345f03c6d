// A scene with a known answer: at depth 1, a layer that transmits 40 % covers the left half of a map of 8 x 8 pixels;
// at depth 3, an opaque floor, which casts shadows too, covers the whole map.
#pragma once

#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

struct HalfCovered {
    scene::Scene scene;
    scene::RaySettings settings;
    rays::LightView view;
};

HalfCovered half_covered(double layer_right_edge = 0.0);  // world x in [-1, 1] spans the map

}  // namespace shadowbench::bench

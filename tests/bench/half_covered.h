// A scene with a known answer: a layer that transmits 40 % at depth 1 covers the left half of a map of 8 x 8 pixels;
// behind it, at depth 3 and over the whole map, an opaque floor that casts shadows too.
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

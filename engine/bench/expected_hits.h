// How often a ray meets a scene on average, from the projected areas of its primitives, before any ray is traced.
#pragma once

#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

struct ExpectedHits {
    double segments = 0.0;  // of a ray of the map, on average: crossings of surfaces, and steps or cells of media
    double seen = 0.0;      // of its crossings, those before almost nothing of the light is left
    double steps = 0.0;     // of its segments, those of media
    double grids = 0.0;     // of its segments, those of grid volumes
    double media = 0.0;     // share of the rays that pass through media
    double inside = 0.0;    // world length of a ray in media, on average
    // Pieces of hair that a tracer tests for a ray: those around whose boxes it passes.
    double hair_tests = 0.0;
};

// For rays spread evenly over the view's map. Of each object at most some ten thousand primitives are looked at, spread
// evenly. `casters_only`: objects without shadows count as absent. `cells`: grid volumes have a segment for each voxel
// cell, else for each step.
ExpectedHits expected_hits(const scene::Scene& scene, const rays::LightView& view, bool casters_only, bool cells);

// Of one object. `least_hair`: pixels of the map that hair is at least wide, where narrower hair is widened and lets the
// more light through (rays::ViewedHair).
ExpectedHits expected_hits(const scene::Object& object, const rays::LightView& view, bool cells, double least_hair);

// The view of a camera, as if it were a light with one ray a pixel.
rays::LightView camera_view(const scene::Camera& camera, base::Vec2i resolution);

}  // namespace shadowbench::bench

// The view of a scenario without a camera.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"

namespace shadowbench::rays {
class Tracer;
}

namespace shadowbench::render {

// A camera that looks from the direction (3, 2.5, 4) at the middle of the casters, far enough away to see all of them.
scene::Camera default_camera(const scene::Scene& scene);

// A camera that sees the casters and where their shadows fall, as large as they fit a picture of this size. It stands
// to the side of the first light, so that the shadow falls beside what casts it and towards the eye. `tracer` sees all
// objects. Shadows further away than three times the size of the casters count as so far away.
scene::Camera camera_of_shadows(const scene::Scenario& scenario, base::Vec2i size, const rays::Tracer& tracer);

}  // namespace shadowbench::render

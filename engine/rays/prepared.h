// An object prepared for one light: its primitives in view space, sorted into the tiles that they may touch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "rays/bins.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "rays/march.h"
#include "rays/primitives.h"
#include "scene/scene.h"

namespace shadowbench::rays {

// One shadow caster, in view space.
struct Prepared {
    const scene::Object* object = nullptr;
    bool moving = false;
    Vec3d motion{0, 0, 0};               // in view space; everything else in the struct is for the object at time 0
    float transmittance[3] = {0, 0, 0};  // of an untextured surface
    std::vector<base::Vec3f> points;     // mesh corners, hair points, sphere centres
    scene::HairSegments segments;        // hair
    Bins bins;
    std::unique_ptr<VolumeMarcher> marcher;

    std::size_t bytes() const {
        return points.capacity() * sizeof(base::Vec3f) + segments.bytes() + bins.bytes() +
               (marcher ? marcher->bytes() : 0);
    }
};

// Keeps a reference to the object. Its bins cover its whole motion.
Prepared prepare(const scene::Object& object, const LightView& view, const MapLayout& layout);

// One segment of a hair object, in view space.
HairSegment hair_segment(const Prepared& prepared, const scene::Hair& hair, std::uint32_t segment);

}  // namespace shadowbench::rays

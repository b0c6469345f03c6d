// An object made ready for one light: its primitives in view space, sorted into the tiles that they may touch.
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

namespace shadowbench::scene {
struct Hair;
struct Object;
}  // namespace shadowbench::scene

namespace shadowbench::rays {

// One object that casts shadows, in view space.
struct Prepared {
    const scene::Object* object = nullptr;
    float transmittance[3] = {0, 0, 0};   // of an untextured surface
    std::vector<base::Vec3f> points;      // mesh corners, hair points, sphere centres
    std::vector<std::uint32_t> segments;  // hair: index of each segment's first point
    std::vector<unsigned char> joined;    // hair: whether the segment continues a strand
    Bins bins;
    std::unique_ptr<VolumeMarcher> marcher;

    std::size_t bytes() const {
        return points.capacity() * sizeof(base::Vec3f) + segments.capacity() * sizeof(std::uint32_t) +
               joined.capacity() + bins.bytes() + (marcher ? marcher->bytes() : 0);
    }
};

// Keeps a reference to the object.
Prepared prepare(const scene::Object& object, const LightView& view, const MapLayout& layout);

// One segment of an object that is hair, in view space.
HairSegment hair_segment(const Prepared& prepared, const scene::Hair& hair, std::uint32_t segment);

}  // namespace shadowbench::rays

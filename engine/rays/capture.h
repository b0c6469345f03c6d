// Scene + light -> light rays, tile by tile: projects the primitives into the light's sample grid and tests exactly
// each sample that they may cover.
//  - Triangles: edge functions with one sign for both triangles of an edge, so that a ray through a shared edge crosses
//    exactly one of them (homogeneous form in perspective: Olano and Greer, Triangle Scan Conversion using 2D
//    Homogeneous Coordinates, 1997).
//  - Hair: ribbons that face the ray with round ends; at a joint the disc around the shared point belongs to the
//    earlier segment, so a ray crosses a strand once there. Only samples near the axis are tested (project_hair.h).
//  - Moving objects: each ray tests them at their position at the ray's time, with edge functions linear in time.
//  - Grid volumes: as the layout says, marched at regular steps, joined by the trapezoid rule (Lokovic and Veach 2000,
//    section 3.2), or cell by cell.
#pragma once

#include <cstddef>
#include <memory>

#include "rays/light_rays.h"
#include "rays/light_view.h"

namespace shadowbench::scene {
struct RaySettings;
struct Scene;
}  // namespace shadowbench::scene

namespace shadowbench::rays {

// The layout that captures `scene` as seen by `view` with these settings. Its tiles are small enough that a few of them
// stay far below memory limits.
MapLayout make_layout(const scene::Scene& scene, const LightView& view, const scene::RaySettings& settings);

// The scene prepared for one light: primitives in view space, sorted into tiles. Keeps references to its arguments.
class Capture {
public:
    // Callers that integrate grids themselves (grid_media.h) leave them out.
    enum class Grids { captured, left_out };
    Capture(const scene::Scene& scene, const LightView& view, const MapLayout& layout, Grids grids = Grids::captured);
    // The same capture with other random places of its rays. It shares what was prepared.
    Capture(const Capture& prepared, std::uint64_t seed);
    ~Capture();
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    // Thread-safe. The rays depend only on the tile. Throws Error{bad_input} if a tile has more than 2^28 segments.
    // `apron`, at most the layout's, is the number of pixels around the tile that are captured too.
    LightRays tile(int index, int apron = 0) const;

    std::size_t bytes() const;  // held for all tiles

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::rays

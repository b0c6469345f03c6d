// Light rays, from which every technique is built. A map is captured tile by tile; a tile holds every sample ray of its
// pixels with all segments that the ray crosses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace shadowbench::rays {

// The rays of a whole map. Sample cell (i, j), i in [0, width * samples_x), holds one ray.
struct MapLayout {
    int width = 1, height = 1;            // pixels
    int samples_x = 1, samples_y = 1;     // sample cells per pixel
    int channels = 1;                     // 1 or 3
    bool media = false;                   // whether any ray may hold a segment with z_front < z_back
    bool jittered = false;                // samples lie anywhere in their cells, else in the middle
    bool multi_jittered = false;          // and those of a pixel are stratified in x and in y too: sample_position()
    std::uint64_t seed = 0;               // for the jitter
    float z_min = 0.0f, z_max = 1.0f;     // bounds of every depth that occurs
    int tile_width = 1, tile_height = 1;  // pixels; tiles at the right and top edge may be smaller
    bool moving = false;                  // a shadow caster moves: each ray has its own time
    int apron = 0;                        // pixels around a tile that a caller may ask for with it
    bool cells = false;                   // grid volumes: one segment for each voxel cell, else for each step
    bool submission = false;              // tiles record the order in which their segments were found

    int samples() const { return samples_x * samples_y; }
    int tiles_x() const { return (width + tile_width - 1) / tile_width; }
    int tiles_y() const { return (height + tile_height - 1) / tile_height; }
    int tiles() const { return tiles_x() * tiles_y(); }
};

// The most square grid samples_x <= samples_y of exactly `samples` cells.
void set_samples(MapLayout& layout, int samples);

// Map position of the ray in sample cell (i, j), in pixels: uniform in its cell if the layout is jittered.
// If it is multi_jittered too, the N rays of a pixel lie one in each of N equal columns and one in each of N equal rows of the
// pixel: correlated multi-jittered samples (Kensler, Correlated Multi-Jittered Sampling, 2013), whose permutations are
// scatter() of shutter.h, so that neighbouring cells have their rays in distant columns and rows.
struct SamplePosition {
    double x, y;
};
SamplePosition sample_position(const MapLayout& layout, int i, int j);

// The pixels of a tile without its apron.
struct TileCore {
    int x0, y0, width, height;
};
TileCore core_of(const MapLayout& layout, int tile);

// The time in the shutter, [0, 1), at which the ray in sample cell (i, j) sees the scene. Each of the samples() equal
// parts of the shutter has one ray of a pixel, dealt out so that positions in the pixel and times are stratified
// together (shutter.h). 0 unless the layout is moving.
double sample_time(const MapLayout& layout, int i, int j);

// A caller may ask for a tile with an apron: then the tile covers a larger rectangle of pixels, clipped to the map, and
// `tile` is still its index.
// Rays are ordered by pixel (row after row of the tile), then by sample cell (row after row of the pixel).
// The segments of a ray are sorted by z_front, then z_back; those of one pixel are contiguous.
// A surface has z_front == z_back. A medium's segment has constant extinction between its ends. Segments may overlap:
// their transmittances multiply. tau(z) includes the surfaces with z_front < z.
struct LightRays {
    int tile = 0;               // row-major index
    int x0 = 0, y0 = 0;         // the tile's first pixel
    int width = 0, height = 0;  // pixels of this tile
    int samples = 1;            // rays per pixel
    int channels = 1;
    std::vector<std::uint32_t> begin;  // rays + 1 offsets into the segments
    std::vector<float> z_front;
    std::vector<float> z_back;         // empty if the tile holds only surfaces
    std::vector<float> transmittance;  // `channels` values for each segment, in [0, 1]
    // If the layout asks for it: the order in which the ray's segments were submitted (object by object, primitive by
    // primitive, each from front to back). Entry k of a ray, counted from begin[ray], is the index of the k-th segment
    // submitted.
    std::vector<std::uint32_t> submission;

    std::size_t rays() const { return begin.empty() ? 0 : begin.size() - 1; }
    std::size_t segments() const { return z_front.size(); }
    float back(std::size_t segment) const { return z_back.empty() ? z_front[segment] : z_back[segment]; }
    std::size_t bytes() const {
        return (begin.capacity() + submission.capacity()) * sizeof(std::uint32_t) +
               (z_front.capacity() + z_back.capacity() + transmittance.capacity()) * sizeof(float);
    }
};

// One channel of the rays, as a set of rays.
LightRays channel(const LightRays& rays, int channel);

// The optical depth of a medium's segment from its front to z, z_front < z < z_back. A transmittance below the smallest
// normal float, also 0, counts as that float: the segment needs a finite extinction.
double optical_depth(const LightRays& rays, std::size_t segment, int channel, double z);

// The oracle: exact transmittance of one ray up to depth z, in double. A surface counts if z_front < z. Products are
// compensated, and optical depths are summed with compensation. For values above 1e-290 the relative error is below
// 2^-51 (1 + D), where D is the optical depth, up to z, of the media that contain z; it does not grow with the number
// of segments. Takes time in proportion to the ray's segments.
double transmittance(const LightRays& rays, std::size_t ray, int channel, double z);

}  // namespace shadowbench::rays

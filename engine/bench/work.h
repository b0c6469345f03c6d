// What a run or its pictures do for a light, counted before any of it is done, and how long each step takes on one
// thread of one machine. See pace.h for others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bench/contender.h"
#include "bench/expected_hits.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

struct LightWork {
    rays::LightView view;
    double rays = 0.0;            // of its map
    double segments = 0.0;        // of a ray
    double steps = 0.0;           // of these, those of media
    double grids = 0.0;           // of these, those of grid volumes
    double in_media = 0.0;        // of these, those of pixels that may hold media: all or none
    double exact = 0.0;           // segments of a ray that is traced, exact in grid volumes
    double media = 1.0;           // share of the rays that pass through media
    double hair_tests = 0.0;      // of a ray that is traced: see ExpectedHits
    double truth_segments = 0.0;  // of a ray of the truth, without grid volumes
    double pixels = 0.0;          // of the map
    double samples = 1.0;         // rays a pixel
    double truth_rays = 0.0;      // captured for the judged queries
    double seen = 1.0;            // share of the map where the camera sees something
    double truth_samples = 0.0;   // rays in the footprint of one query of the truth
    double truth_pixel_rays = 0;  // rays a pixel of the truth
    double truth_sets = 1.0;      // into which these are divided
    double receivers = 0.0, judged = 0.0;
    double compared = 0.0;   // rays of the map that Embree traces too
    double reach = 1.0;      // share of the places of the world that the light may light
    double footprint = 0.0;  // rays of the map in the footprint of one lookup
    double spread_seeds = 0.0;
    double techniques = 0.0, traced = 0.0;  // that build a map; that trace rays for each lookup
    double lookup_rays = 0.0;               // that the latter trace for a lookup, together
    double fine = 0.0;                      // that promise an error that only a fine linearisation of media shows
    bool shared = false;                    // some maps are made of functions or means that they share
    double channels = 1.0;
};

// What a variant asks for.
struct VariantWork {
    const scene::Scenario& scenario;
    std::span<const LightWork> lights;
    std::uint64_t file_bytes = 0;
};

// `light`: its number. `contenders`: none where a caller counts the work of its techniques itself.
LightWork count_work(const scene::Scenario& scenario, std::size_t light, const rays::MapLayout& layout,
                     const rays::LightView& view, std::span<const Contender> contenders);

// Seconds of a tracer's test of a piece of hair.
inline constexpr double hair_test = 0.18e-6;

// What a structure of a capture costs, beside one of a tracer.
inline constexpr double capture_share = 0.2;

// Seconds on one thread.
double structure_seconds(const scene::Scene& scene);            // of the structure for rays of a tracer
double capture_seconds(const LightWork& work, double rays);     // of these rays of the map
double compare_seconds(const LightWork& work);                  // of some of these rays with those that Embree traces
double truth_seconds(const LightWork& work, double rays);       // of the capture of these rays of the truth
double build_seconds(const LightWork& work);                    // of the maps of all techniques, once
double check_seconds(const LightWork& work);                    // of the functions that these maps store
double traced_lookup_seconds(const LightWork& work);            // of one lookup of each that traces its rays
double lookups_seconds(const LightWork& work, double queries);  // of all techniques, to each of these queries
// Of the means over `samples` rays in the footprint of each of these queries, of `rays` that were captured in so many
// sets.
double gather_seconds(const LightWork& work, double queries, double samples, double rays, double sets);

}  // namespace shadowbench::bench

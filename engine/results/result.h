// What a run measured, as plain values. Everything that depends on the clock is a Sample, or stands in a struct named
// ...Times; all else is the same for the same scenario and seed, whatever the machine's speed and thread count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/setting.h"
#include "metrics/statistics.h"
#include "results/program.h"
#include "results/verdict.h"

namespace shadowbench::results {

// Raw timings of one thing and their median with its 95 % bootstrap interval.
struct Sample {
    std::vector<double> raw;
    double median = 0.0;
    metrics::Interval interval{0.0, 0.0};
};
Sample summarise(std::vector<double> raw);

// Lookups in one order, each repetition beside its floor: reading the same cache lines and nothing else.
struct LookupTimes {
    Sample ns;                    // a lookup
    std::optional<Sample> floor;  // ns a lookup; nothing for a technique that reads no map
    std::optional<Sample> ratio;  // lookup / floor of the same repetition
};

struct CellTimes {
    Sample build_ms;        // one thread
    double ns_per_segment;  // of the median build, per segment of the light rays
    LookupTimes image_order, random_order;
    std::size_t lookups = 0;  // in one timed pass: fewer for slow techniques
    bool on_front = false;    // no other technique is both faster (random order) and more accurate
};

struct CurveErrors {
    std::uint64_t cells = 0;       // compared: all, or an even share of very many
    double reference_error = 0.0;  // of the reference curves themselves, where exponentials are joined by lines
    metrics::ErrorNorms norms;     // over the cells, of each cell's largest error
    double mean_l1 = 0.0;          // mean over the cells of the integral of the error over depth
    int worst_x = 0, worst_y = 0;  // cell of the largest error
    double rise = 0.0;             // largest, of a stored function from a depth to a deeper one
    double lowest = 0.0;           // value of a stored function, where one is below 0
};

struct LookupErrors {
    metrics::ErrorNorms norms;
    double signed_mean = 0.0;  // below 0: too dark
};

// Nodes of the stored functions: how many cells (stored functions) there are, and how many nodes they have.
struct NodeCounts {
    std::uint64_t cells = 0;
    std::uint64_t total = 0;
    std::uint32_t max = 0;
    std::vector<std::uint64_t> histogram;  // cells by number of nodes, up to max

    double mean() const { return cells ? static_cast<double>(total) / static_cast<double>(cells) : 0.0; }
};

enum class CellStatus { ok, failed };

// One technique with one set of parameters, on one light.
struct Cell {
    std::string technique;
    int version = 0;
    std::string parameters;       // "tolerance=0.02 filter=point": what sweeps set, and what differs from the defaults
    std::string parameters_json;  // all of them
    bool defaults = false;        // all have their default values
    std::string where;            // JSON pointer into the scenario as written
    CellStatus status = CellStatus::ok;
    std::string reason;            // why it failed
    bool outside_promise = false;  // made for opaque scenes alone, and this one is not
    double error_bound = 0.0;      // the promised largest curve error; infinity: none
    std::size_t bytes = 0, working_bytes = 0;
    NodeCounts nodes;
    std::optional<CurveErrors> curve;
    std::optional<LookupErrors> lookup;
    Verdict verdict = Verdict::kept;
    std::string verdict_why;         // the figures, and the cause of a degraded one
    bool on_bytes_front = false;     // no other technique is both smaller and more accurate
    std::optional<CellTimes> times;  // nothing for a failed cell
};

// "deep tolerance=0.02": the technique and its parameters.
std::string title(const Cell& cell);

struct CaptureTimes {
    double seconds = 0.0;          // all tiles, on all threads
    double setup_seconds = 0.0;    // preparing the scene for the light, before the first tile
    double rays_per_second = 0.0;  // all tiles, on all threads
};

// The captured rays beside the same rays traced with Embree.
struct AgreementTimes {
    double capture_rays_per_second = 0.0;  // one thread, without the setup
    double tracer_rays_per_second = 0.0;   // one thread, Embree's all-hits query, without building its tree
    double ratio = 0.0;
};
struct Agreement {
    std::uint64_t rays = 0;                 // traced
    std::uint64_t other_crossings = 0;      // rays with another number of surface crossings
    std::uint64_t other_transmittance = 0;  // rays whose whole transmittance differs by more than 1e-3
    AgreementTimes times;
};
// Whether no more rays differ, in either way, than grazed edges explain: 3, or 0.1 % of many.
bool agrees(const Agreement& agreement);

struct ReferenceReport {
    std::uint64_t judged = 0;  // receivers compared with the truth
    int samples_per_pixel = 0;
    double error_rms = 0.0, error_max = 0.0;       // standard error of the truth, over the judged receivers
    double noise_tolerance = 0.0;                  // 0.5 / sqrt(samples a pixel of the light rays)
    std::optional<double> spread_rms, spread_max;  // standard deviation over seeds; nothing when it was not measured
};

// The light's map and its rays.
struct MapDescription {
    int width = 0, height = 0;         // pixels
    int samples_x = 0, samples_y = 0;  // rays of a pixel
    bool jittered = false;
    std::uint64_t seed = 0;
    int channels = 1;
    bool media = false;
    float z_min = 0.0f, z_max = 0.0f;  // planar depths of what casts shadows

    int samples() const { return samples_x * samples_y; }
};

struct LightResult {
    std::string name;
    MapDescription layout;
    bool deep_image = false;
    std::uint64_t rays = 0, segments = 0;
    std::uint64_t ray_bytes = 0;
    bool kept = true;                          // all rays stayed in memory; else they were captured anew for each pass
    bool translucent = false;                  // some crossing lets light through, or into a medium
    std::uint64_t receivers = 0, dropped = 0;  // dropped: outside the light's map
    std::optional<Agreement> agreement;
    ReferenceReport reference;
    CaptureTimes times;
    std::vector<Cell> cells;
};

// Whether no ray meets anything that casts a shadow: all is lit, and the map of every technique is empty.
bool sees_nothing(const LightResult& light);

struct VariantResult {
    std::vector<document::Setting> settings;  // what the sweeps set
    std::vector<LightResult> lights;
};

struct Machine {
    std::string cpu;
    int logical_cores = 0;
};

struct RunTimes {
    std::string started;  // UTC, ISO 8601
    double seconds = 0.0;
    int threads = 0;  // of capture and checks; builds and lookups are timed on one
};

struct Result {
    std::string name, purpose;
    std::string document;           // JSON text of the scenario as run
    std::string hash;               // of that text
    std::vector<std::string> only;  // ids of the techniques that the run was kept to; empty: all
    Program program;
    Machine machine;
    RunTimes times;
    std::vector<VariantResult> variants;
};

// Whether any cell has failed.
bool any_failed(const Result& result);

}  // namespace shadowbench::results

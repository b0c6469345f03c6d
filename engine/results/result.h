// The measurements of a run, as plain values. Values that depend on the clock are Samples or members of a struct named
// ...Times. All others are equal for the same scenario and seed, whatever the machine's speed and thread count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/setting.h"
#include "metrics/interval_front.h"
#include "metrics/statistics.h"
#include "results/program.h"
#include "results/verdict.h"

namespace shadowbench::results {

// Raw timings of one operation, and their median with its 95 % interval: metrics::order_interval().
struct Sample {
    std::vector<double> raw;
    double median = 0.0;
    metrics::Interval interval{0.0, 0.0};
};
Sample summarise(std::vector<double> raw);

// Times of lookups in one order. Each repetition also times its floor, which reads the same cache lines and does
// nothing else.
struct LookupTimes {
    Sample ns;                    // per lookup
    std::optional<Sample> floor;  // ns per lookup; absent for a technique that reads no map
    std::optional<Sample> ratio;  // lookup / floor of the same repetition
};

struct CellTimes {
    Sample build_ms;        // one thread
    double ns_per_segment;  // of the median build, per segment of the light rays
    LookupTimes image_order, random_order;
    std::size_t lookups = 0;                           // in one timed pass: fewer for slow techniques
    metrics::OnFront on_front = metrics::OnFront::no;  // of time (random order) and error: see fronts.h
};

struct CurveErrors {
    std::uint64_t cells = 0;       // cells compared: all, or an even share of very many
    double reference_error = 0.0;  // of the reference curves, which approximate exponentials by lines
    metrics::ErrorNorms norms;     // over the cells, of each cell's largest error
    double mean_l1 = 0.0;          // mean over the cells of the integral of the error over depth
    int worst_x = 0, worst_y = 0;  // cell of the largest error
    double rise = 0.0;             // largest rise of a stored function with depth
    double lowest = 0.0;           // lowest value of a stored function, if below 0
};

// 95 % interval of the RMS that is expected over seeds of the light rays against the exact truth: see
// metrics/expected_error.h.
struct RmsInterval {
    double low = 0.0, high = 0.0;
    // False: the rays are random, but their noise was not measured; the interval then covers the truth's uncertainty
    // for these rays only.
    bool covers_rays = true;
};

struct LookupErrors {
    metrics::ErrorNorms norms;
    double signed_mean = 0.0;                  // below 0: too dark
    std::optional<RmsInterval> interval = {};  // absent in results of earlier programs
    double truth_sd = 0.0;                     // square root of metrics::TruthNoise::linear
};

// What another seed of the light rays gave.
struct SeedErrors {
    metrics::ErrorNorms lookup;
    std::size_t bytes = 0;
};

// The nodes of stored functions beside the fewest that do within the same tolerance for the same uncompressed
// functions, if they start at the exact value, do not rise and have nodes only at depths of the input
// (curves/fewest.h). Techniques that break one of these rules may have fewer.
struct FewestNodes {
    std::uint64_t cells = 0;               // compared: all, or an even share of many
    std::uint64_t left_out = 0;            // further cells of the share, whose fewest nodes are not known
    std::uint64_t nodes = 0, fewest = 0;   // that they hold; the fewest, above 0
    metrics::Interval interval{1.0, 1.0};  // 95 %, of the ratio over all cells; without width if all were compared

    double ratio() const { return static_cast<double>(nodes) / static_cast<double>(fewest); }
};

// The number of cells (stored functions) and of their nodes.
struct NodeCounts {
    std::uint64_t cells = 0;
    std::uint64_t total = 0;
    std::uint32_t max = 0;
    std::vector<std::uint64_t> histogram;         // cells by number of nodes, up to max
    std::optional<FewestNodes> over_fewest = {};  // absent for techniques without a tolerance, and if nothing is stored

    double mean() const { return cells ? static_cast<double>(total) / static_cast<double>(cells) : 0.0; }
};

// The timed passes of one kind, and what the scheduler did to them.
struct TimedPasses {
    std::uint64_t passes = 0;
    std::uint64_t interrupted = 0;  // passes in which the thread had to give up its processor, once or more
    std::uint64_t switches = 0;     // how often it had to: involuntary context switches
};

// How the builds and lookups of a light were timed.
struct TimingReport {
    double goal = 0.0;                    // half width, over the median, at which an interval is narrow enough
    double seconds = 0.0;                 // of all rounds of builds and lookups, with their warm-ups
    TimedPasses builds, lookups;          // lookups: in both orders, and their floors
    std::optional<double> steal_seconds;  // that the host took from all processors meanwhile; absent if unknown
};

enum class CellStatus { ok, failed };

// The file of a technique from outside.
struct TechniqueLibrary {
    std::string file;       // its name, without folders
    std::string hash;       // of its content
    bool isolated = false;  // its maps were in processes of their own; times hold the way there and back
    friend bool operator==(const TechniqueLibrary&, const TechniqueLibrary&) = default;
};

// One technique with one set of parameters, on one light.
struct Cell {
    std::string technique;
    int version = 0;
    std::optional<TechniqueLibrary> library = {};  // absent: the technique is part of the program
    std::string parameters;       // "tolerance=0.02 filter=point": what sweeps set, and what differs from the defaults
    std::string parameters_json;  // all of them
    bool defaults = false;        // whether all have their default values
    std::string where;            // JSON pointer into the scenario as written
    CellStatus status = CellStatus::ok;
    std::string reason;            // why it failed
    bool outside_promise = false;  // the technique is for opaque scenes only, and this one is not
    double error_bound = 0.0;      // the promised largest curve error; infinity: none
    std::size_t bytes = 0, working_bytes = 0;
    NodeCounts nodes;
    std::optional<CurveErrors> curve;
    std::optional<LookupErrors> lookup;
    std::vector<SeedErrors> over_seeds;  // of the further seeds, equal for all cells of a light; empty: not measured
    Verdict verdict = Verdict::kept;
    std::string verdict_why;                                 // the figures, and why a degraded cell has no bound
    metrics::OnFront on_bytes_front = metrics::OnFront::no;  // of bytes and error: see fronts.h
    std::optional<CellTimes> times;                          // absent for a failed cell, and if the run took none
};

// "deep tolerance=0.02": a technique and its parameters, which may be empty.
std::string title(const std::string& technique, const std::string& parameters);
std::string title(const Cell& cell);

struct CaptureTimes {
    double seconds = 0.0;          // all tiles, on all threads
    double setup_seconds = 0.0;    // preparing the scene for the light, before the first tile
    double rays_per_second = 0.0;  // all tiles, on all threads
};

// Captured rays compared with the same rays traced by Embree. Rays through an edge do not count as different: see
// compare_with_tracer().
struct AgreementTimes {
    double capture_rays_per_second = 0.0;  // one thread, without the setup
    double tracer_rays_per_second = 0.0;   // one thread, Embree's all-hits query, without building its tree
    double ratio = 0.0;
};
struct Agreement {
    std::uint64_t rays = 0;                 // traced
    std::uint64_t other_crossings = 0;      // rays whose numbers of surface crossings differ
    std::uint64_t other_transmittance = 0;  // rays whose whole transmittance differs by more than 1e-3
    AgreementTimes times;
};
// Whether the rays that differ, in either way, are at most as many as grazed edges explain: 3, or 0.1 % if that is
// more.
bool agrees(const Agreement& agreement);

struct ReferenceReport {
    std::uint64_t judged = 0;                      // receivers compared with the truth
    int samples_per_pixel = 0;                     // rays used for the truth
    double error_rms = 0.0, error_max = 0.0;       // standard error of the truth, over the judged receivers
    int degrees = 0;                               // its degrees of freedom; 0: exact, or an upper bound
    double noise_tolerance = 0.0;                  // 0.5 / sqrt(samples a pixel of the light rays)
    std::optional<double> spread_rms, spread_max;  // standard deviation over seeds; absent if not measured
};

// The light's map and its rays.
struct MapDescription {
    int width = 0, height = 0;         // pixels
    int samples_x = 0, samples_y = 0;  // rays of a pixel along each side
    bool jittered = false;
    std::uint64_t seed = 0;
    int channels = 1;
    bool media = false;
    float z_min = 0.0f, z_max = 0.0f;  // planar depth range of the casters

    int samples() const { return samples_x * samples_y; }
};

struct LightResult {
    std::string name;
    MapDescription layout;
    bool deep_image = false;
    std::uint64_t rays = 0, segments = 0;
    std::uint64_t ray_bytes = 0;
    bool kept = true;          // all rays stayed in memory; otherwise they were captured again for each pass
    bool translucent = false;  // some crossing lets light through, or into a medium
    std::uint64_t receivers = 0, dropped = 0;  // dropped: outside the light's map
    std::optional<Agreement> agreement;
    ReferenceReport reference;
    CaptureTimes times;
    // Absent from portable baselines, from results of earlier programs, and if the run took no times.
    std::optional<TimingReport> timing;
    std::vector<Cell> cells;
};

// Seconds of capturing all rays on one thread, without the setup, at the speed measured on a sample of them. The light
// must have an agreement.
double capture_seconds_on_one_thread(const LightResult& light);

// Whether no ray meets a caster. Then everything is lit, and the map of every technique is empty.
bool sees_nothing(const LightResult& light);

struct VariantResult {
    std::vector<document::Setting> settings;  // what the sweeps set
    std::vector<LightResult> lights;
};

// Empty or 0: the system does not say, or the result is of an earlier version.
struct Machine {
    std::string cpu;
    int logical_cores = 0;
    std::string microcode = {}, kernel = {};  // "0xa101148", "Linux 6.1.0"
    std::string governor = {};                // of the processors' frequency; several: "performance, powersave"
    std::string smt = {};                     // threads that share a core: "on", "off", "notsupported"
    std::uint64_t memory = 0;                 // bytes
    int numa_nodes = 0;
    std::string container = {};  // "docker"
};

struct RunTimes {
    std::string started;  // UTC, ISO 8601
    double seconds = 0.0;
    int threads = 0;                              // of capture and checks; builds and lookups are timed on one
    std::optional<double> load = {};              // at the start: processes that ran or wanted to, over a minute
    std::string slurm_job = {}, slurm_node = {};  // "12_3" of an array; empty: not a job of Slurm
};

struct Result {
    std::string name, purpose;
    std::vector<std::string> notes;  // of the file readers, each once: what they left out or changed
    std::vector<std::string> files;  // the scenario's data files, a line each: see scene::file_lines
    std::string document;            // JSON text of the scenario as run
    std::string hash;                // of that text
    std::vector<std::string> only;   // ids of the techniques that the run was limited to; empty: all
    Program program;
    Machine machine;
    RunTimes times;
    std::vector<VariantResult> variants;
};

// Whether any cell has failed.
bool any_failed(const Result& result);

}  // namespace shadowbench::results

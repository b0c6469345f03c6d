// The contract of a technique: light rays in, a map that answers visibility out. A technique is a row of the registry;
// everything else (CLI lists, schema, report, conformance tests) is read from the row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "curves/curve.h"
#include "curves/weighted_ray.h"
#include "rays/light_rays.h"
#include "techniques/parameters.h"

namespace shadowbench::rays {
class Tracer;
struct LightView;
}  // namespace shadowbench::rays

namespace shadowbench::techniques {

// "How much light reaches light-space point (x, y, z), over a footprint of `width` map pixels?"
//
// Any floats may be asked for, and the answer is always a number:
//   a position outside the map, one that is not a number among them, is lit;
//   a depth that is not a number lies before everything, as -infinity does; infinity lies behind everything;
//   a width that is negative or not a number counts as 0, which asks for the nearest cell; one wider than the map, be
//   it infinite, covers the whole map and takes no longer than that.
struct Query {
    float x, y;   // map pixels
    float z;      // planar depth
    float width;  // of the filter, map pixels
};

// The receiver's own pixel as it lies in the map: a parallelogram around the query's (x, y), its two edges in map
// pixels. All 0: not known; one that is not finite counts as not known too. Beside the queries and not in them: few
// techniques read it, and lookups that do not would pay for the longer query.
struct Footprint {
    float ux = 0, uy = 0, vx = 0, vy = 0;

    bool known() const { return ux != 0 || uy != 0 || vx != 0 || vy != 0; }
};

// Nodes of the stored functions. A cell is one stored function: a pixel, or one sample of a pixel.
struct NodeStats {
    std::uint64_t cells = 0;
    std::uint64_t total = 0;
    std::uint32_t max = 0;
    std::vector<std::uint64_t> histogram;  // cells by number of nodes, up to max

    double mean() const { return cells ? static_cast<double>(total) / static_cast<double>(cells) : 0.0; }
    void add(std::uint32_t nodes);
};

// Which rays one stored function stands for.
enum class Cells {
    pixel,     // all rays of a pixel, averaged
    sample,    // every ray has its own function; the map is samples_x by samples_y times as large
    centre,    // one ray of each pixel, the one in its middle sample cell
    filtered,  // rays of a pixel and of its neighbours, weighted: see Map::weights
    none,      // nothing is stored
};

// What a map needs of the light rays beyond the pixels of each tile.
struct RayNeeds {
    int apron = 0;            // pixels around a tile that its LightRays cover too (clipped to the map)
    bool submission = false;  // LightRays::submission
};

// Where the light rays come from; all of it outlives the map.
struct BuildInput {
    const rays::MapLayout& layout;
    const rays::LightView& view;
    const rays::Tracer* tracer;  // for techniques that trace; null where there is no scene to trace
    int channel = 0;             // which channel of a coloured scene the map holds, of rows that are not `coloured`
};

// A map under construction, then a map. Most techniques see one channel: of a coloured scene a map a channel is made.
// Those whose row says `coloured` are given all channels at once.
class Map {
public:
    virtual ~Map() = default;

    // Asked before begin.
    virtual RayNeeds needs() const { return {}; }

    // Called once, first. Throws Error{bad_input} when the technique cannot serve this layout.
    virtual void begin(const BuildInput& input) = 0;
    // Called once a tile, from several threads at once for different tiles.
    virtual void add(const rays::LightRays& tile) = 0;
    // Called once, last. After it the map does not change.
    virtual void finish() = 0;

    // Values that a lookup answers with: 1, or the channels of the layout that it was begun with.
    virtual int channels() const { return 1; }
    // visibility[c * queries.size() + i] answers queries[i] in channel c; in [0, 1] where Promises::unit_range is
    // promised, else finite. Thread-safe. Outside the map: lit.
    virtual void lookup(std::span<const Query> queries, std::span<float> visibility) const = 0;
    // The same where the footprints of the queries are given, one each: for techniques that can filter over them.
    virtual void lookup_shaped(std::span<const Query> queries, std::span<const Footprint>,
                               std::span<float> visibility) const {
        lookup(queries, visibility);
    }

    // Appends an address in every 64-byte line of the map's memory that this lookup reads: what the floor of the
    // lookup time reads, and nothing else. Techniques without a map append nothing.
    virtual void touched(const Query& query, std::vector<const void*>& lines) const = 0;
    virtual void touched_shaped(const Query& query, const Footprint&, std::vector<const void*>& lines) const {
        touched(query, lines);
    }

    virtual std::size_t bytes() const = 0;          // held by the finished map
    virtual std::size_t working_bytes() const = 0;  // held at most while building, above the rays given
    virtual NodeStats nodes() const = 0;

    virtual Cells cells() const = 0;
    // The function stored in cell (x, y) for a channel (below channels()) as vertices; `out` is replaced. One that is
    // not piecewise linear is sampled at its own nodes and at `depths` (sorted).
    virtual void stored(int x, int y, int channel, std::span<const float> depths, curves::Curve& out) const = 0;
    // Cells::filtered alone: which rays of its tile, given with the apron asked for, cell (x, y) stands for. `out` is
    // replaced; weights are above 0 and sum to 1.
    virtual void weights(int, int, const rays::LightRays&, std::vector<curves::WeightedRay>& out) const { out.clear(); }
};

// What a technique promises of every stored function, whatever the scene (of opaque ones alone if opaque_only).
struct Promises {
    bool monotone = true;      // never rises with depth
    bool unit_range = true;    // stays in [0, 1]
    bool opaque_only = false;  // takes every crossing as opaque: errors are promised for opaque scenes alone
    bool localised = true;     // a lone surface or slab is felt at its own depths; else only before and behind all
    bool approximate = false;  // fits or bounds the function, as variance maps do: see `leak`
    bool early = false;        // may be dark before the first surface, as moments that overestimate are
    // What may be left behind something opaque. Of an approximate technique: how far an answer behind everything may
    // lie from the truth, whatever stands there.
    double leak = 0.0;
};

// A parameter set to a value of its own.
struct ParameterSetting {
    const char* name;
    ParameterValues::Value value;
};

// These values with some of them set otherwise. The settings are of the row that the values are of.
inline ParameterValues with(ParameterValues values, std::span<const ParameterSetting> settings) {
    for (const ParameterSetting& setting : settings) values.values[setting.name] = setting.value;
    return values;
}

// What generic code has to know of a technique beside its promises, so that it never asks for its name. The tests of
// every row say what they make of each.
struct Traits {
    bool traces = false;            // asks the scene: Map::begin refuses to begin without a Tracer; nothing is stored
    bool draws_samples = false;     // a lookup's samples depend on the digits of its query: answers do not compare
    bool beyond_footprint = false;  // a lookup also samples outside of its footprint, however narrow that is
    bool filters = true;            // a lookup as wide as a pixel weighs all rays of the pixel alike, by `whole_pixel`

    double segment_rounding = 0.0;  // share of what lies behind it by which each segment may round
    double lookup_rounding = 0.0;   // by which a lookup of one cell may differ from the stored function

    // Parameters that are lengths added to stored depths; each is at least the one before it.
    std::vector<const char*> biases = {};
    // With these (and no bias) a lookup of width 0 answers the stored function of its cell.
    std::vector<ParameterSetting> pointwise = {};
    // With these an answer does not depend on the order of hits at one depth, but for rounding.
    std::vector<ParameterSetting> order_free = {};
    // With these a lookup as wide as a pixel, in its middle, is over the rays of the pixel and no others.
    std::vector<ParameterSetting> whole_pixel = {};
};

inline double no_bound(const ParameterValues&, const rays::MapLayout&) {
    return std::numeric_limits<double>::infinity();
}
inline std::size_t no_bytes(const ParameterValues&, const rays::MapLayout&) {
    return 0;
}
// For Technique::create.
template <class Made>
std::unique_ptr<Map> create_map(const ParameterValues& values) {
    return std::make_unique<Made>(values);
}

// A row is written with named fields; what is not named has its default.
struct Technique {
    const char* id = "";
    const char* title = "";
    const char* paper = "";
    int version = 1;  // grows when the same rays give other answers or bytes
    Promises promises = {};
    std::span<const Parameter> parameters = {};
    std::unique_ptr<Map> (*create)(const ParameterValues& values) = nullptr;
    // Largest curve error (see metrics) that these values promise for a map of this layout; infinity: none.
    double (*error_bound)(const ParameterValues& values, const rays::MapLayout& layout) = no_bound;
    // A finished map of given functions instead of rays: function i is pixel (i, 0) of a map one pixel high.
    // Null when the technique cannot take any piecewise-linear function.
    std::unique_ptr<Map> (*from_curves)(const ParameterValues& values,
                                        std::span<const curves::Curve> functions) = nullptr;
    // What the finished map of this layout surely holds, in bytes: for refusing what cannot fit before work starts.
    std::size_t (*least_bytes)(const ParameterValues& values, const rays::MapLayout& layout) = no_bytes;
    bool coloured = false;  // one map holds all channels of a coloured scene
    // What these values promise, of rows whose promises depend on them; `promises` is then what the defaults promise.
    Promises (*promises_of)(const ParameterValues& values) = nullptr;
    Traits traits = {};
};

inline Promises promises(const Technique& row, const ParameterValues& values) {
    return row.promises_of ? row.promises_of(values) : row.promises;
}

// The registry: one row a technique, in the order of rows.inc.
std::span<const Technique> all();

// Throws Error{bad_input} that lists the names there are.
const Technique& find(const std::string& id, const std::string& where);

}  // namespace shadowbench::techniques

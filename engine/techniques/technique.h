// The contract of a technique: light rays in, a map that answers visibility out. A technique is a row of the registry;
// everything else (CLI lists, schema, report, conformance tests) reads the row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
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

namespace shadowbench::curves {
class RayFunctions;
}

namespace shadowbench::techniques {

class MeanRays;

// "How much light reaches light-space point (x, y, z), over a footprint of `width` map pixels?"
//
// Any floats are valid, and the answer is always a number:
//   a position outside the map, or NaN, is lit;
//   a depth of NaN lies before everything, as -infinity does; infinity lies behind everything;
//   a width that is negative or NaN counts as 0, which asks for the nearest cell; one wider than the map, even
//   infinite, covers the whole map and takes no longer than that.
struct Query {
    float x, y;   // map pixels
    float z;      // planar depth
    float width;  // of the filter, map pixels
};

// The receiver's own pixel projected into the map: a parallelogram around the query's (x, y), its two edges in map
// pixels. All 0, or not finite: not known. It is kept outside Query: few techniques read it, and a longer query would
// slow down the others.
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

// The fewest nodes that one stored function needs.
struct FewestNodes {
    std::size_t nodes = 0;
    bool known = true;  // false: the search took too long, or the cell's functions share their depths
};

// Which rays one stored function represents.
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
    bool means = false;       // only the mean of each pixel's rays, where it has several: see Map::add_means
    bool functions = false;   // the functions of single rays, where there are media: see Map::add_functions
};

// The source of the light rays; all of it outlives the map.
struct BuildInput {
    const rays::MapLayout& layout;
    const rays::LightView& view;
    const rays::Tracer* tracer;  // for techniques that trace; null if there is no scene to trace
    int channel = 0;             // the channel of a coloured scene that the map holds; for rows that are not `coloured`
};

// A map, first under construction, then finished. Most techniques see one channel: a coloured scene gets a map for each
// channel. Techniques whose row is `coloured` get all channels at once.
class Map {
public:
    virtual ~Map() = default;

    // Called before begin.
    virtual RayNeeds needs() const { return {}; }

    // Called once, first. Throws Error{bad_input} if the technique cannot serve this layout.
    virtual void begin(const BuildInput& input) = 0;
    // Called once for each tile, from several threads at once for different tiles.
    virtual void add(const rays::LightRays& tile) = 0;
    // Called once, last. What the map stores does not change afterwards.
    virtual void finish() = 0;
    // Lookups of the finished map become those of these values. They may differ from the values of the map only in
    // parameters whose trades are `only_lookups`. Not while another thread looks up.
    virtual void set_lookups(const ParameterValues&) {}
    // Why no answer of the map counts; empty: they do. Const functions do not throw, so that they can be timed: what
    // went wrong in one of them stands here. Only maps of techniques from outside have faults.
    virtual std::string fault() const { return {}; }

    // The number of values in a lookup's answer: 1, or the channels of the layout passed to begin.
    virtual int channels() const { return 1; }
    // visibility[c * queries.size() + i] answers queries[i] in channel c; in [0, 1] if Promises::unit_range holds, else
    // finite. Thread-safe. Outside the map: lit.
    virtual void lookup(std::span<const Query> queries, std::span<float> visibility) const = 0;
    // The same with a footprint for each query, for techniques that can filter over footprints.
    virtual void lookup_shaped(std::span<const Query> queries, std::span<const Footprint>,
                               std::span<float> visibility) const {
        lookup(queries, visibility);
    }

    // Appends an address in every 64-byte line of the map's memory that this lookup reads, and no others: the floor of
    // the lookup time reads these. Techniques without a map append nothing.
    virtual void touched(const Query& query, std::vector<const void*>& lines) const = 0;
    virtual void touched_shaped(const Query& query, const Footprint&, std::vector<const void*>& lines) const {
        touched(query, lines);
    }

    virtual std::size_t bytes() const = 0;          // held by the finished map
    virtual std::size_t working_bytes() const = 0;  // the most held while building, besides the given rays
    virtual NodeStats nodes() const = 0;

    virtual Cells cells() const = 0;
    // The function stored in cell (x, y) for a channel (below channels()) as vertices; `out` is replaced. If it is not
    // piecewise linear, it is sampled at its own nodes and at `depths` (sorted).
    virtual void stored(int x, int y, int channel, std::span<const float> depths, curves::Curve& out) const = 0;
    // Only for Cells::filtered: the rays of its tile, including the apron asked for, that cell (x, y) represents. `out`
    // is replaced; weights are above 0 and sum to 1.
    virtual void weights(int, int, const rays::LightRays&, std::vector<curves::WeightedRay>& out) const { out.clear(); }
    // Only for techniques with one cell a pixel that compress its function within a tolerance: the fewest nodes that do
    // within that tolerance, by the rules of curves/fewest.h, for the same uncompressed function. `tile` holds the rays
    // of cell (x, y), with the apron asked for.
    virtual std::optional<FewestNodes> fewest_nodes(int, int, const rays::LightRays&) const { return {}; }

    // Only for maps that need `means`: does what add() does, from the means of a tile with several rays a pixel and the
    // channel of this map. Whoever builds several such maps makes the means of a tile once and hands them to each;
    // add() makes them itself. The time of a build includes that of the means, whoever made them.
    virtual void add_means(const MeanRays&) {}
    // Only for maps that need `functions`: does what add() does, from a tile of one channel and the functions of its
    // rays. They are handed over and charged as means are.
    virtual void add_functions(const rays::LightRays& tile, const curves::RayFunctions&) { add(tile); }
};

// What a technique promises for every stored function in every scene (only in opaque scenes if opaque_only).
struct Promises {
    bool monotone = true;      // never rises with depth
    bool unit_range = true;    // stays in [0, 1]
    bool opaque_only = false;  // counts every crossing as opaque: error bounds hold only for opaque scenes
    bool localised = true;     // a single surface or slab counts at its own depths; else only before and behind all
    bool approximate = false;  // fits or bounds the function, as variance maps do: see `leak`
    bool early = false;        // may be dark before the first surface, as moment methods that overestimate are
    // The light that may be left behind something opaque. For an approximate technique: how far an answer behind
    // everything may lie from the truth, whatever the occluders.
    double leak = 0.0;
};

// A parameter and a value for it.
struct ParameterSetting {
    const char* name;
    ParameterValues::Value value;
};

// The values with some of them replaced. The settings must be parameters of the same row.
inline ParameterValues with(ParameterValues values, std::span<const ParameterSetting> settings) {
    for (const ParameterSetting& setting : settings) values.values[setting.name] = setting.value;
    return values;
}

// A parameter that a search over settings varies, because it trades cost against error.
struct Trade {
    enum class Scale {
        linear,       // equal steps
        logarithmic,  // equal ratios
        choice,       // values without an order
    };
    const char* parameter = "";
    Scale scale = Scale::choice;
    double from = 0.0, to = 0.0;  // linear, logarithmic: the cheapest and the most accurate value
    // choice: at least one value. A single one is set instead of the default.
    std::vector<ParameterValues::Value> choices = {};
    bool only_lookups = false;  // the finished map is the same for all values: see Map::set_lookups
    bool only_layout = false;   // the answers are the same for all values: only bytes and times differ
};

// What generic code must know about a technique besides its promises, so that it never checks the name. The tests of
// every row read these traits.
struct Traits {
    bool traces = false;            // traces the scene: Map::begin fails without a Tracer; nothing is stored
    bool draws_samples = false;     // a lookup's samples depend on the digits of its query: answers vary with rounding
    bool beyond_footprint = false;  // a lookup also samples outside its footprint, however narrow
    bool filters = true;            // with `whole_pixel`, a lookup as wide as a pixel weights all its rays equally

    double segment_rounding = 0.0;  // share of the values behind it by which each segment may round
    double lookup_rounding = 0.0;   // by which a lookup of one cell may differ from the stored function

    // Parameters that are lengths added to stored depths; each is at least the one before it.
    std::vector<const char*> biases = {};
    // With these (and no bias) a lookup of width 0 answers the stored function of its cell.
    std::vector<ParameterSetting> pointwise = {};
    // With these an answer does not depend on the order of hits at one depth, except for rounding.
    std::vector<ParameterSetting> order_free = {};
    // With these a lookup as wide as a pixel, in its middle, covers exactly the rays of the pixel.
    std::vector<ParameterSetting> whole_pixel = {};
    // What a search over settings varies besides the map's resolution and the light rays a pixel; other parameters keep
    // their defaults.
    std::vector<Trade> trades = {};
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

// The file that a technique from outside was loaded from.
struct Library {
    std::string file;        // its name, without folders
    std::string hash;        // of its content
    bool isolated = false;   // its maps live in processes of their own
    std::string fault = {};  // why it cannot be used, so that its maps fail; empty: it can
    friend bool operator==(const Library&, const Library&) = default;
};

// Rows use named fields; fields that are not named have their defaults. Functions may have state: those of a technique
// from outside hold its library.
struct Technique {
    const char* id = "";
    const char* title = "";
    const char* paper = "";
    int version = 1;  // increases when the same rays give other answers or bytes
    Promises promises = {};
    std::span<const Parameter> parameters = {};
    std::function<std::unique_ptr<Map>(const ParameterValues& values)> create = nullptr;
    // The largest curve error (see metrics) that these values promise for a map of this layout; infinity: no promise.
    std::function<double(const ParameterValues& values, const rays::MapLayout& layout)> error_bound = no_bound;
    // Makes a finished map from given functions instead of rays: function i is pixel (i, 0) of a map one pixel high.
    // Null if the technique cannot store every piecewise-linear function.
    std::function<std::unique_ptr<Map>(const ParameterValues& values, std::span<const curves::Curve> functions)>
        from_curves = nullptr;
    // The least number of bytes that the finished map of this layout holds, to refuse what cannot fit before work
    // starts.
    std::function<std::size_t(const ParameterValues& values, const rays::MapLayout& layout)> least_bytes = no_bytes;
    bool coloured = false;  // one map holds all channels of a coloured scene
    // For rows whose promises depend on the values: what these values promise; `promises` is then for the defaults.
    std::function<Promises(const ParameterValues& values)> promises_of = nullptr;
    Traits traits = {};
    Library library = {};  // of a technique from outside; empty: the technique is part of this program
};

inline Promises promises(const Technique& row, const ParameterValues& values) {
    return row.promises_of ? row.promises_of(values) : row.promises;
}

// The registry: one row for each technique, in the order of rows.inc, then those that were added. Rows stay where they
// are.
const std::deque<Technique>& all();

// Adds a row. The program calls it before it reads the registry from several threads. Throws Error{bad_input}, place
// `where`, if a row has this id.
void add(Technique row, const std::string& where);

// Throws Error{bad_input} that lists the known names.
const Technique& find(const std::string& id, const std::string& where);

}  // namespace shadowbench::techniques

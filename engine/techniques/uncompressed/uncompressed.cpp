// Every captured segment, kept and evaluated exactly: the reference of Salvi et al. 2010, and the exact answer of the
// rays.
#include <algorithm>
#include <cmath>

#include "curves/composite.h"
#include "curves/ray_functions.h"
#include "techniques/store/cells.h"
#include "techniques/store/most_bytes.h"
#include "techniques/store/texels.h"

namespace shadowbench::techniques {
namespace {

using Node = curves::Vertex;

// The transmittance functions of one tile's rays, in the order of its rays. Without media a node is a surface: its
// depth and the transmittance behind it. With media, nodes are as in curves/composite.h.
struct TileFunctions {
    int x0 = 0, y0 = 0, width = 0;
    std::vector<std::uint32_t> begin;
    std::vector<Node> nodes;
};

// Values are floats; below the smallest normal float they no longer show how steeply a function falls. If a function
// falls through it between two nodes, the last float depth above gets a node, and the next one, so that neither end of
// the fall is drawn with the slope of the other.
void add_where_floats_end(const curves::Node& a, const curves::Node& b, std::vector<Node>& out) {
    constexpr double floor = std::numeric_limits<float>::min();
    if (!(a.value > floor && b.value < floor && a.z < b.z)) return;
    const double rate = std::log(a.value / b.value) / (b.z - a.z);
    const auto value = [&](float z) { return static_cast<float>(a.value * std::exp(-rate * (z - a.z))); };
    const double end = a.z + std::log(a.value / floor) / rate;
    float above = static_cast<float>(end);
    if (above > end) above = std::nextafter(above, -std::numeric_limits<float>::infinity());
    if (above > a.z) out.push_back({above, value(above)});
    const float below =
        std::nextafter(std::max(above, static_cast<float>(a.z)), std::numeric_limits<float>::infinity());
    if (below < b.z) out.push_back({below, std::min(value(below), out.back().value)});
}

const Parameter parameters[] = {filter_parameter};

class Uncompressed final : public Map {
public:
    explicit Uncompressed(const ParameterValues& values) : filter_(read_filter(values)) {}

    RayNeeds needs() const override { return {.functions = true}; }
    void begin(const BuildInput& input) override {
        layout_ = input.layout;
        cells_ = make_cells(layout_, Cells::sample);
        tiles_.assign(layout_.tiles(), {});
    }

    void add(const rays::LightRays& rays) override { fill(rays, nullptr); }
    void add_functions(const rays::LightRays& rays, const curves::RayFunctions& functions) override {
        fill(rays, &functions);
    }

    void finish() override {}
    void set_lookups(const ParameterValues& values) override { filter_ = read_filter(values); }

    // With the footprint filter, the mean over the rays whose samples lie inside the footprint; the nearest cell's ray
    // if there are none.
    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            double sum = 0.0, weights = 0.0;
            for_each_ray(queries[i], [&](const Place& place, double weight) {
                sum += weight * evaluate(place.nodes(), queries[i].z);
                weights += weight;
            });
            visibility[i] = weights > 0.0 ? static_cast<float>(std::min(sum / weights, 1.0)) : 1.0f;
        }
    }

    void touched(const Query& query, std::vector<const void*>& lines) const override {
        const std::size_t before = lines.size();
        for_each_ray(query, [&](const Place& place, double) {
            const std::span<const Node> ray = place.nodes();
            touch_lines(&place.tile, sizeof(place.tile), lines);
            touch_lines(&place.tile.begin[place.ray], 2 * sizeof(std::uint32_t), lines);
            std::size_t low = 0, high = ray.size();
            while (low < high) {  // the probes of evaluate()'s search
                const std::size_t middle = (low + high) / 2;
                touch_lines(&ray[middle], sizeof(Node), lines);
                if (ray[middle].z < query.z)
                    low = middle + 1;
                else
                    high = middle;
            }
        });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override {
        std::size_t sum = tiles_.capacity() * sizeof(TileFunctions);
        for (const TileFunctions& t : tiles_)
            sum += t.begin.capacity() * sizeof(std::uint32_t) + t.nodes.capacity() * sizeof(Node);
        return sum;
    }
    std::size_t working_bytes() const override { return bytes() + scratch_.value(); }

    NodeStats nodes() const override {
        NodeStats stats;
        for (const TileFunctions& t : tiles_)
            for (std::size_t r = 0; r + 1 < t.begin.size(); ++r) stats.add(t.begin[r + 1] - t.begin[r]);
        return stats;
    }

    Cells cells() const override { return Cells::sample; }

    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        out.clear();
        const std::span<const Node> ray = place_of(x, y).nodes();
        if (!layout_.media) {
            float before = 1.0f;
            for (const Node& n : ray) {
                out.push_back({n.z, before});
                out.push_back({n.z, n.value});
                before = n.value;
            }
            return;
        }
        std::size_t d = 0;
        for (const Node& n : ray) {
            for (; d < depths.size() && depths[d] < n.z; ++d) out.push_back({depths[d], evaluate(ray, depths[d])});
            for (; d < depths.size() && depths[d] == n.z; ++d) {
            }
            out.push_back({n.z, n.value});
        }
    }

private:
    // `made`: the functions of the rays, or null.
    void fill(const rays::LightRays& rays, const curves::RayFunctions* made) {
        TileFunctions& tile = tiles_[rays.tile];
        tile.x0 = rays.x0;
        tile.y0 = rays.y0;
        tile.width = rays.width;
        if (!layout_.media) {
            tile.begin = rays.begin;
            tile.nodes.resize(rays.segments());
            for (std::size_t r = 0; r < rays.rays(); ++r) {
                double through = 1.0;
                for (std::uint32_t s = rays.begin[r]; s < rays.begin[r + 1]; ++s) {
                    through *= rays.transmittance[s];
                    tile.nodes[s] = {rays.z_front[s], static_cast<float>(through)};
                }
            }
            return;
        }
        std::vector<curves::Node> nodes;
        curves::OpenMedia open;
        tile.begin.assign(1, 0);
        for (std::size_t r = 0; r < rays.rays(); ++r) {
            std::span<const curves::Node> ray;
            if (made) ray = made->of(r);
            if (ray.empty()) {
                curves::composite(rays, r, 0, open, nodes);
                ray = nodes;
            }
            for (std::size_t i = 0; i < ray.size(); ++i) {
                if (i > 0) add_where_floats_end(ray[i - 1], ray[i], tile.nodes);
                tile.nodes.push_back({static_cast<float>(ray[i].z), static_cast<float>(ray[i].value)});
            }
            tile.begin.push_back(static_cast<std::uint32_t>(tile.nodes.size()));
        }
        tile.nodes.shrink_to_fit();
        const std::size_t most_nodes = std::max(nodes.capacity(), made ? made->scratch_nodes() : 0);
        scratch_.add(most_nodes * sizeof(curves::Node) + open.bytes() + (made ? made->media_bytes() : 0));
    }

    // The position of a ray's function.
    struct Place {
        const TileFunctions& tile;
        std::size_t ray;
        std::span<const Node> nodes() const {
            return {tile.nodes.data() + tile.begin[ray], tile.nodes.data() + tile.begin[ray + 1]};
        }
    };
    Place place_of(int x, int y) const {
        const int px = x / layout_.samples_x, py = y / layout_.samples_y;
        const TileFunctions& t =
            tiles_[static_cast<std::size_t>(py / layout_.tile_height) * layout_.tiles_x() + px / layout_.tile_width];
        const std::size_t pixel = static_cast<std::size_t>(py - t.y0) * t.width + (px - t.x0);
        const std::size_t ray =
            pixel * layout_.samples() + (y % layout_.samples_y) * layout_.samples_x + x % layout_.samples_x;
        return {t, ray};
    }

    float evaluate(std::span<const Node> ray, float z) const {
        std::size_t low = 0, high = ray.size();
        while (low < high) {  // first node at or behind z
            const std::size_t middle = (low + high) / 2;
            if (ray[middle].z < z)
                low = middle + 1;
            else
                high = middle;
        }
        if (low == 0) return 1.0f;
        const Node& a = ray[low - 1];
        if (!layout_.media || low == ray.size()) return a.value;
        const Node& b = ray[low];
        if (a.value == b.value || z == b.z) return b.value;
        // Constant extinction between nodes: log(value) is linear. A value of 0 counts as the smallest normal float.
        const double floor = std::numeric_limits<float>::min();
        const double from = std::max<double>(a.value, floor), to = std::max<double>(b.value, floor);
        const double u = (static_cast<double>(z) - a.z) / (static_cast<double>(b.z) - a.z);
        return a.value == 0.0f ? 0.0f : std::min(static_cast<float>(from * std::pow(to / from, u)), a.value);
    }

    // Calls visit(place, weight) for the rays of a query's filter; for none outside the map.
    template <class Visit>
    void for_each_ray(const Query& q, const Visit& visit) const {
        int cx, cy;
        if (!cells_.find(q.x, q.y, cx, cy)) return;
        if (filter_ == Filter::point) return visit(place_of(cx, cy), 1.0);
        if (filter_ == Filter::bilinear)
            return for_each_of_four(cells_, q, [&](int x, int y, float weight) { visit(place_of(x, y), weight); });
        const double half = 0.5 * width_of(q);
        const auto clamp = [](double cell, int count) {
            return cell <= 0 ? 0 : cell >= count ? count - 1 : static_cast<int>(cell);
        };
        const int x0 = clamp((q.x - half) * layout_.samples_x, cells_.width);
        const int x1 = clamp((q.x + half) * layout_.samples_x, cells_.width);
        const int y0 = clamp((q.y - half) * layout_.samples_y, cells_.height);
        const int y1 = clamp((q.y + half) * layout_.samples_y, cells_.height);
        bool any = false;
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const rays::SamplePosition p = rays::sample_position(layout_, x, y);
                if (std::abs(p.x - q.x) > half || std::abs(p.y - q.y) > half) continue;
                visit(place_of(x, y), 1.0);
                any = true;
            }
        if (!any) visit(place_of(cx, cy), 1.0);
    }

    Filter filter_;
    rays::MapLayout layout_;
    CellGrid cells_;
    std::vector<TileFunctions> tiles_;
    MostBytes scratch_;
};

}  // namespace

Technique uncompressed() {
    return {.id = "uncompressed",
            .title = "every segment of every ray, evaluated exactly",
            .paper = "Salvi et al. 2010 (reference)",
            .version = 2,
            .parameters = parameters,
            .create = create_map<Uncompressed>,
            .error_bound = [](const ParameterValues&, const rays::MapLayout&) { return 1e-6; },
            .least_bytes =
                [](const ParameterValues&, const rays::MapLayout& layout) {
                    return make_cells(layout, Cells::sample).count() * sizeof(std::uint32_t);
                },
            .traits = {.pointwise = {{"filter", "point"}},
                       .whole_pixel = {{"filter", "footprint"}},
                       .trades = {filter_trade}}};
}

}  // namespace shadowbench::techniques

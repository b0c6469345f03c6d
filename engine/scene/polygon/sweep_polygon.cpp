#include "scene/polygon/sweep_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace shadowbench::scene {
namespace {

constexpr int most_detours = 64;

// Runs from one point to a later one. `winding` is how often the outline passes it forward minus how often backward.
struct Segment {
    std::uint32_t from = 0, to = 0;
    int winding = 0;
    std::uint32_t source = 0;  // the segment of the outline that it lies on
};

constexpr std::size_t none = static_cast<std::size_t>(-1);

// The area between two neighbouring edges: one monotone polygon, or two that met at their last point until the next
// point parts them.
struct Region {
    std::size_t lower = none, upper = none;
};

struct Edge {
    Segment segment;
    int winding_above = 0;
    Region above;
};

class Sweeper {
public:
    // `points` must be in the order of the sweep.
    Sweeper(const std::vector<GridPoint>& points, const std::vector<Segment>& segments)
        : points_(points), begins_(points.size()), status_(Below{this}) {
        for (const Segment& segment : segments) begins_[segment.from].push_back(segment);
    }

    // Returns false if two segments cross; crossing() names them.
    bool run() {
        for (std::uint32_t point = 0; point < points_.size() && !crossing_; ++point) pass(point);
        return !crossing_;
    }

    const std::pair<Segment, Segment>& crossing() const { return *crossing_; }
    const std::vector<Triple>& triangles() const { return triangles_; }
    double overlap() const { return overlap_; }

private:
    struct At {
        std::uint32_t point;
    };
    // The order of the edges that the sweep line meets, from below.
    struct Below {
        using is_transparent = void;
        const Sweeper* sweeper;
        bool operator()(std::size_t a, std::size_t b) const { return sweeper->below(a, b); }
        bool operator()(std::size_t edge, At at) const { return sweeper->side(edge, at.point) > 0; }
        bool operator()(At at, std::size_t edge) const { return sweeper->side(edge, at.point) < 0; }
    };
    using Status = std::set<std::size_t, Below>;

    std::int64_t turn_at(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return turn(points_[a], points_[b], points_[c]);
    }
    // Positive if the point lies above the edge.
    std::int64_t side(std::size_t edge, std::uint32_t point) const {
        return turn_at(edges_[edge].segment.from, edges_[edge].segment.to, point);
    }
    bool below(std::size_t a, std::size_t b) const {
        const std::uint32_t from_a = edges_[a].segment.from, from_b = edges_[b].segment.from;
        if (from_a == from_b) return side(a, edges_[b].segment.to) > 0;
        return from_a < from_b ? side(a, from_b) > 0 : side(b, from_a) < 0;
    }

    void pass(std::uint32_t point) {
        auto [first, last] = status_.equal_range(At{point});
        Edge* under = first == status_.begin() ? nullptr : &edges_[*std::prev(first)];
        const int winding = under ? under->winding_above : 0;
        const bool ends = first != last;
        Region above;  // above all edges that end here
        for (auto it = first; it != last; ++it) {
            const Edge& edge = edges_[*it];
            if (edge.segment.to != point)
                begins_[point].push_back({point, edge.segment.to, edge.segment.winding, edge.segment.source});
            if (std::next(it) == last)
                above = edge.above;
            else
                close(edge.above, point);
        }
        const Status::iterator next = status_.erase(first, last);
        const std::vector<Segment> starts = starting_at(point);
        if (!ends && starts.empty()) return;
        if (winding != 0 || ends) {
            if (!ends) {
                above = split(under->above, point);
            } else {
                if (winding != 0) touch_from_below(under->above, point);
                touch_from_above(above, point);
                if (starts.empty() && winding != 0) under->above.upper = above.lower;
            }
        }
        std::size_t previous = first_of(next);
        int sum = winding;
        for (std::size_t i = 0; i < starts.size(); ++i) {
            sum += starts[i].winding;
            Region region;
            if (i + 1 == starts.size())
                region = above;
            else if (sum != 0)
                region.lower = begin(point, sum);
            edges_.push_back({starts[i], sum, region});
            status_.insert(next, edges_.size() - 1);
            check_crossing(previous, edges_.size() - 1);
            previous = edges_.size() - 1;
        }
        check_crossing(previous, next == status_.end() ? none : *next);
    }

    std::size_t first_of(Status::iterator next) const { return next == status_.begin() ? none : *std::prev(next); }

    // The segments that begin at a point, from below, one for each direction. Where several overlap, they become one up
    // to the nearest end; the rest of the others begins there.
    std::vector<Segment> starting_at(std::uint32_t point) {
        std::vector<Segment> list = std::move(begins_[point]);
        std::sort(list.begin(), list.end(), [&](const Segment& a, const Segment& b) {
            const std::int64_t bend = turn_at(point, a.to, b.to);
            return bend != 0 ? bend > 0 : a.to < b.to;
        });
        std::vector<Segment> starts;
        for (std::size_t i = 0, end = 0; i < list.size(); i = end) {
            int winding = 0;
            for (end = i; end < list.size() && turn_at(point, list[i].to, list[end].to) == 0; ++end)
                winding += list[end].winding;
            const std::uint32_t source = list[end - 1].source;  // the longest
            if (winding != 0) starts.push_back({point, list[i].to, winding, source});
            for (std::size_t k = i; k + 1 < end; ++k) {
                winding -= list[k].winding;
                const std::uint32_t from = list[k].to, to = list[k + 1].to;
                if (from != to && winding != 0) begins_[from].push_back({from, to, winding, source});
            }
        }
        return starts;
    }

    std::size_t begin(std::uint32_t point, int winding) {
        polygons_.emplace_back(point);
        windings_.push_back(winding);
        return polygons_.size() - 1;
    }

    void add(std::size_t polygon, std::uint32_t point, Side side) {
        const std::size_t before = triangles_.size();
        polygons_[polygon].add(point, side, points_, triangles_);
        weigh(polygon, before);
    }

    void finish(std::size_t polygon, std::uint32_t point) {
        if (polygon == none) return;
        const std::size_t before = triangles_.size();
        polygons_[polygon].finish(point, points_, triangles_);
        weigh(polygon, before);
    }

    void weigh(std::size_t polygon, std::size_t before) {
        if (windings_[polygon] == 1) return;
        for (std::size_t i = before; i < triangles_.size(); ++i)
            overlap_ += static_cast<double>(turn_at(triangles_[i][0], triangles_[i][1], triangles_[i][2]));
    }

    void close(const Region& region, std::uint32_t point) {
        finish(region.lower, point);
        finish(region.upper, point);
    }

    // Adds a point of the region's upper edge.
    void touch_from_below(Region& region, std::uint32_t point) {
        finish(region.upper, point);
        region.upper = none;
        add(region.lower, point, Side::upper);
    }

    // Adds a point of the region's lower edge.
    void touch_from_above(Region& region, std::uint32_t point) {
        if (region.lower == none) return;
        if (region.upper != none) {
            finish(region.lower, point);
            region = {region.upper, none};
        }
        add(region.lower, point, Side::lower);
    }

    // Splits the region at a point inside it: the part below stays in `region`, the part above is returned.
    Region split(Region& region, std::uint32_t point) {
        if (region.upper == none) {
            // A new side runs from the region's last point to this one.
            const std::size_t old = region.lower;
            const std::size_t fresh = begin(polygons_[old].last(), windings_[old]);
            region = polygons_[old].last_side() == Side::upper ? Region{old, fresh} : Region{fresh, old};
        }
        const std::size_t upper = region.upper;
        add(region.lower, point, Side::upper);
        add(upper, point, Side::lower);
        region.upper = none;
        return {upper, none};
    }

    void check_crossing(std::size_t a, std::size_t b) {
        if (a == none || b == none || crossing_) return;
        const Segment& s = edges_[a].segment;
        const Segment& t = edges_[b].segment;
        const auto parts = [&](const Segment& by, const Segment& ends) {
            const std::int64_t from = turn_at(by.from, by.to, ends.from), to = turn_at(by.from, by.to, ends.to);
            return (from < 0 && to > 0) || (from > 0 && to < 0);
        };
        if (parts(s, t) && parts(t, s)) crossing_ = {s, t};
    }

    const std::vector<GridPoint>& points_;
    std::vector<std::vector<Segment>> begins_;  // one list a point
    std::vector<Edge> edges_;
    Status status_;
    std::vector<MonotonePolygon> polygons_;
    std::vector<int> windings_;  // one a polygon
    std::vector<Triple> triangles_;
    double overlap_ = 0.0;
    std::optional<std::pair<Segment, Segment>> crossing_;
};

// The distance of a point from a segment if the foot of its perpendicular lies inside the segment; otherwise infinite.
double distance(const GridPoint& point, const GridPoint& from, const GridPoint& to) {
    const double x = static_cast<double>(to.x - from.x), y = static_cast<double>(to.y - from.y);
    const double along = x * static_cast<double>(point.x - from.x) + y * static_cast<double>(point.y - from.y);
    const double square = x * x + y * y;
    if (!(along > 0.0 && along < square)) return std::numeric_limits<double>::infinity();
    return std::abs(static_cast<double>(turn(from, to, point))) / std::sqrt(square);
}

// The points of an outline, each once, in the order of the sweep.
struct Points {
    std::vector<GridPoint> at;
    std::vector<std::uint32_t> corner;     // the first corner at the point
    std::vector<std::uint32_t> of_corner;  // the point of each corner
};

Points distinct(const std::vector<GridPoint>& outline) {
    std::vector<std::uint32_t> order(outline.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return outline[a] < outline[b]; });
    Points points;
    points.of_corner.resize(outline.size());
    for (const std::uint32_t corner : order) {
        if (points.at.empty() || points.at.back() != outline[corner]) {
            points.at.push_back(outline[corner]);
            points.corner.push_back(corner);
        }
        points.of_corner[corner] = static_cast<std::uint32_t>(points.at.size() - 1);
    }
    return points;
}

// An edge of the outline, or a part of one that was led through a corner.
struct Path {
    std::uint32_t from = 0, to = 0, corner = 0;
};

std::vector<Segment> segments_of(const std::vector<Path>& paths) {
    std::vector<Segment> segments;
    segments.reserve(paths.size());
    for (std::uint32_t i = 0; i < paths.size(); ++i) {
        if (paths[i].from < paths[i].to) segments.push_back({paths[i].from, paths[i].to, 1, i});
        if (paths[i].to < paths[i].from) segments.push_back({paths[i].to, paths[i].from, -1, i});
    }
    return segments;
}

// Leads one of two crossing edges through an end of the other one, if an end is near enough.
bool detour(const std::pair<Segment, Segment>& crossing, const std::vector<GridPoint>& points, double tolerance,
            std::vector<Path>& paths) {
    const auto& [a, b] = crossing;
    double nearest = tolerance;
    const Segment* bent = nullptr;
    std::uint32_t through = 0;
    const auto consider = [&](const Segment& segment, std::uint32_t point) {
        const double away = distance(points[point], points[segment.from], points[segment.to]);
        if (!(away <= nearest)) return;
        nearest = away;
        bent = &segment;
        through = point;
    };
    for (const std::uint32_t point : {b.from, b.to}) consider(a, point);
    for (const std::uint32_t point : {a.from, a.to}) consider(b, point);
    if (!bent) return false;
    const Path path = paths[bent->source];
    paths[bent->source].to = through;
    paths.push_back({through, path.to, path.corner});
    return true;
}

}  // namespace

Sweep sweep_polygon(const std::vector<GridPoint>& outline, double tolerance) {
    const Points points = distinct(outline);
    std::vector<Path> paths;
    paths.reserve(outline.size());
    for (std::uint32_t i = 0; i < outline.size(); ++i)
        paths.push_back({points.of_corner[i], points.of_corner[(i + 1) % outline.size()], i});
    Sweep result;
    for (int detours = 0;; ++detours) {
        Sweeper sweeper(points.at, segments_of(paths));
        if (sweeper.run()) {
            result.triangles = sweeper.triangles();
            result.overlap = sweeper.overlap();
            break;
        }
        const auto& [a, b] = sweeper.crossing();
        if (detours < most_detours && detour(sweeper.crossing(), points.at, tolerance, paths)) continue;
        result.crossing = {paths[a.source].corner, paths[b.source].corner};
        return result;
    }
    for (Triple& triangle : result.triangles)
        for (std::uint32_t& point : triangle) point = points.corner[point];
    return result;
}

}  // namespace shadowbench::scene

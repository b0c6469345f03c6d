#include "curves/sweep.h"

#include <algorithm>

#include "curves/depth_sort.h"
#include "curves/ray_functions.h"
#include "curves/sweep_surfaces.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

// The published update adds and subtracts slopes throughout, and its rounding errors drift. Here a binary tree holds at
// its leaves the current line of each term, and at each inner node the sum of its two children. An event replaces a
// leaf and sums again along the path to the root, so a line that has ended leaves no trace: there is no drift, however
// many events there are and however steep a line was. Cost: log2(terms) additions per event, beside a sort of O(n log
// n).
//
// The remaining error comes from cancellation in slope * (z - origin) + offset: at most 2^-53 (z - origin) / dz of a
// term's fall over dz. Different floats have dz >= 2^-24 z, and the origin is the depth nearest to 0, so the error
// stays below 2^-29 of the fall.

namespace {

using Line = SweepScratch::Line;

struct Extent {
    double low = 0.0, high = 0.0;
    bool empty = true;

    void add(float z) {
        low = empty ? z : std::min<double>(low, z);
        high = empty ? z : std::max<double>(high, z);
        empty = false;
    }
    double origin() const { return std::clamp(0.0, low, high); }
};

class Sweep {
public:
    Sweep(std::size_t terms, double origin, SweepScratch& scratch) : scratch_(scratch), terms_(terms), origin_(origin) {
        scratch_.order.clear();
        scratch_.events.clear();
        scratch_.sums.assign(2 * terms, Line{});
    }

    void add_term(std::size_t term, CurveView curve, double weight) {
        scratch_.sums[terms_ + term].offset = weight * (curve.empty() ? 1.0f : curve.front().value);
        for (std::size_t i = 0; i < curve.size();) {
            const Vertex first = curve[i];
            Vertex last = first;
            for (; i < curve.size() && curve[i].z == first.z; ++i) {
                falls_ = falls_ && curve[i].value <= last.value;
                last = curve[i];
            }
            Line line{0.0, weight * last.value};
            if (i < curve.size()) {
                falls_ = falls_ && curve[i].value <= last.value;
                line.slope = weight * (static_cast<double>(curve[i].value) - last.value) /
                             (static_cast<double>(curve[i].z) - last.z);
                line.offset -= line.slope * (last.z - origin_);
            }
            scratch_.order.push_back(depth_item(first.z, static_cast<std::uint32_t>(scratch_.events.size())));
            scratch_.events.push_back({line, static_cast<std::uint32_t>(term), first.value != last.value});
        }
        falls_ = falls_ && weight >= 0.0;
    }

    void run(Curve& out) {
        for (std::size_t node = terms_; node-- > 1;) sum_children(node);
        sort_by_depth(scratch_.order, scratch_.sorting);
        const auto& order = scratch_.order;
        bound_ = 1.0;
        for (std::size_t i = 0; i < order.size();) {
            const auto key = static_cast<std::uint32_t>(order[i] >> 32);
            const float z = key_depth(key);
            const double before = total(z);
            bool step = false;
            for (; i < order.size() && order[i] >> 32 == key; ++i) {
                const SweepScratch::Event& event = scratch_.events[static_cast<std::uint32_t>(order[i])];
                step = step || event.step;
                replace(event.term, event.line);
            }
            const float front = step ? to_value(before) : 0.0f;
            const float behind = to_value(total(z));
            if (step && front != behind) out.push_back({z, front});
            out.push_back({z, behind});
        }
    }

private:
    void sum_children(std::size_t node) {
        const Line &a = scratch_.sums[2 * node], &b = scratch_.sums[2 * node + 1];
        scratch_.sums[node] = {a.slope + b.slope, a.offset + b.offset};
    }
    void replace(std::size_t term, const Line& line) {
        std::size_t node = terms_ + term;
        scratch_.sums[node] = line;
        while ((node >>= 1) != 0) sum_children(node);
    }
    double total(float z) const { return scratch_.sums[1].slope * (z - origin_) + scratch_.sums[1].offset; }

    float to_value(double sum) {
        sum = std::clamp(sum, 0.0, bound_);
        if (falls_) bound_ = sum;
        return static_cast<float>(sum);
    }

    SweepScratch& scratch_;
    std::size_t terms_;
    double origin_;
    double bound_ = 1.0;
    bool falls_ = true;  // no term rises: rounding must not make the sum rise
};

}  // namespace

std::size_t SweepScratch::bytes() const {
    return (order.capacity() + sorting.capacity()) * sizeof(std::uint64_t) + drops.capacity() * sizeof(std::int64_t) +
           events.capacity() * sizeof(Event) + sums.capacity() * sizeof(Line) + nodes.capacity() * sizeof(Node) +
           media.bytes() + ray.capacity() * sizeof(Vertex);
}

void weighted_sum(std::span<const WeightedCurve> terms, SweepScratch& scratch, Curve& out) {
    out.clear();
    if (terms.empty()) return;
    Extent extent;
    for (const WeightedCurve& term : terms) {
        if (term.curve.empty()) continue;
        extent.add(term.curve.front().z);
        extent.add(term.curve.back().z);
    }
    Sweep sweep(terms.size(), extent.origin(), scratch);
    for (std::size_t i = 0; i < terms.size(); ++i) sweep.add_term(i, terms[i].curve, terms[i].weight);
    sweep.run(out);
}

namespace {

// The function of the rays ray(0) to ray(count - 1), with weights weight(i). nodes_of(ray) is the function of one ray.
template <class Ray, class Weight, class NodesOf>
void sweep_rays(const rays::LightRays& rays, std::size_t count, const Ray& ray, const Weight& weight,
                const NodesOf& nodes_of, double linearisation, SweepScratch& scratch, Curve& out) {
    Extent extent;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t s = rays.begin[ray(i)]; s < rays.begin[ray(i) + 1]; ++s) extent.add(rays.z_front[s]);
    Sweep sweep(count, extent.origin(), scratch);
    for (std::size_t i = 0; i < count; ++i) {
        scratch.ray.clear();
        linearise(nodes_of(ray(i)), linearisation, scratch.ray);
        sweep.add_term(i, scratch.ray, weight(i));
    }
    sweep.run(out);
}

auto composited(const rays::LightRays& rays, int channel, SweepScratch& scratch) {
    return [&rays, channel, &scratch](std::size_t ray) {
        composite(rays, ray, channel, scratch.media, scratch.nodes);
        return std::span<const Node>(scratch.nodes);
    };
}

template <class NodesOf>
void sweep_equal(const rays::LightRays& rays, std::size_t first, std::size_t count, const NodesOf& nodes_of,
                 double linearisation, SweepScratch& scratch, Curve& out) {
    sweep_rays(
        rays, count, [&](std::size_t i) { return first + i; },
        [&](std::size_t) { return 1.0 / static_cast<double>(count); }, nodes_of, linearisation, scratch, out);
}

}  // namespace

void visibility(const rays::LightRays& rays, std::size_t first, std::size_t count, double linearisation,
                SweepScratch& scratch, Curve& out, int channel) {
    out.clear();
    if (count == 0) return;
    if (surfaces_only(rays, first, count)) return visibility_of_surfaces(rays, first, count, channel, scratch, out);
    sweep_equal(rays, first, count, composited(rays, channel, scratch), linearisation, scratch, out);
}

void visibility(const rays::LightRays& rays, const RayFunctions& functions, std::size_t first, std::size_t count,
                double linearisation, SweepScratch& scratch, Curve& out) {
    out.clear();
    if (count == 0) return;
    if (surfaces_only(rays, first, count)) return visibility_of_surfaces(rays, first, count, 0, scratch, out);
    sweep_equal(
        rays, first, count, [&](std::size_t ray) { return functions.of(ray); }, linearisation, scratch, out);
}

void visibility(const rays::LightRays& rays, std::span<const WeightedRay> chosen, double linearisation,
                SweepScratch& scratch, Curve& out, int channel) {
    out.clear();
    if (chosen.empty()) return;
    if (surfaces_only(rays, chosen)) return visibility_of_surfaces(rays, chosen, channel, scratch, out);
    sweep_rays(
        rays, chosen.size(), [&](std::size_t i) { return chosen[i].ray; },
        [&](std::size_t i) { return chosen[i].weight; }, composited(rays, channel, scratch), linearisation, scratch,
        out);
}

}  // namespace shadowbench::curves

#include "curves/compress_published.h"

#include <cmath>

#include "curves/compress_parts.h"

namespace shadowbench::curves {

namespace {

using namespace compression;

template <int channels>
struct Point {
    double z = 0.0;
    Values<channels> value{};
};

struct OnePoints {
    CurveView curve;
    std::size_t next = 0;

    bool more() const { return next < curve.size(); }
    Point<1> read() {
        const Vertex vertex = curve[next++];
        return {vertex.z, {vertex.value}};
    }
};

// Reads both sides of every depth of the three functions.
struct ColourPoints {
    ColourReader groups;
    Group<3> group{};
    bool behind = false;  // the far side of `group` comes next

    bool more() const { return behind || groups.more(); }
    Point<3> read() {
        if (behind) {
            behind = false;
            return {group.z, group.after};
        }
        group = groups.read();
        behind = group.after != group.before;
        return {group.z, group.before};
    }
};

template <int channels, class Points, class OutVertex>
class Published {
public:
    Published(const Points& in, float tolerance, OutVertex* vertices)
        : in_(in), epsilon_(tolerance > 0.0f ? tolerance : 0.0), vertices_(vertices) {}

    std::size_t run() {
        emit(in_.read());
        while (in_.more()) {
            const Point<channels> point = in_.read();
            if (!pass(point)) {
                end_segment();
                pass(point);
            }
        }
        end_segment();
        return count_;
    }

private:
    // Narrows the slopes to those that pass the point's window. Returns false and changes nothing if there are none.
    bool pass(const Point<channels>& point) {
        const double dz = point.z - origin_.z;
        Slopes low = low_, high = high_;
        bool vertical = vertical_, passes = dz == 0.0 || !vertical_;
        for (int c = 0; c < channels; ++c) {
            const double rise = point.value[c] - origin_.value[c];
            if (dz == 0.0) {
                vertical = vertical || std::abs(rise) > epsilon_;
            } else {
                low[c] = std::max(low[c], (rise - epsilon_) / dz);
                high[c] = std::min(high[c], (rise + epsilon_) / dz);
                passes = passes && low[c] <= high[c];
            }
        }
        if (!passes) return false;
        low_ = low;
        high_ = high;
        vertical_ = vertical;
        last_ = point;
        return true;
    }

    void end_segment() {
        if (!vertical_ && last_.z == origin_.z) return;  // no length
        Point<channels> end = last_;
        for (int c = 0; c < channels && !vertical_; ++c)
            end.value[c] = origin_.value[c] + 0.5 * (low_[c] + high_[c]) * (last_.z - origin_.z);
        emit(end);
    }

    void emit(const Point<channels>& point) {
        std::array<float, channels> rounded;
        for (int c = 0; c < channels; ++c) rounded[c] = to_float<channels>(point.value[c]);
        write(vertices_[count_++], static_cast<float>(point.z), rounded);
        origin_.z = point.z;
        for (int c = 0; c < channels; ++c) origin_.value[c] = rounded[c];
        last_ = origin_;
        low_.fill(-kInfinity);
        high_.fill(kInfinity);
        vertical_ = false;
    }

    using Slopes = Values<channels>;

    Points in_;
    double epsilon_;
    OutVertex* vertices_;
    std::size_t count_ = 0;
    Point<channels> origin_, last_;  // the origin of the current segment; the last point that it passes
    Slopes low_, high_;
    bool vertical_ = false;  // a step at the origin's own depth
};

}  // namespace

std::size_t compress_published(CurveView curve, float tolerance, Vertex* out) {
    if (curve.empty()) return 0;
    return Published<1, OnePoints, Vertex>({curve}, tolerance, out).run();
}

Curve compress_published(CurveView curve, float tolerance) {
    Curve out(curve.size());
    out.resize(compress_published(curve, tolerance, out.data()));
    return out;
}

std::size_t compress_published(const std::array<CurveView, 3>& curves, float tolerance, ColourVertex* out) {
    if (curves[0].empty() && curves[1].empty() && curves[2].empty()) return 0;
    return Published<3, ColourPoints, ColourVertex>({ColourReader(curves)}, tolerance, out).run();
}

}  // namespace shadowbench::curves

#include "curves/compress.h"

#include <algorithm>
#include <limits>

namespace shadowbench::curves {

namespace {

// All vertices at one z: the values on both sides.
struct Group {
    double z = 0.0;
    double before = 1.0, after = 1.0;
};

Group read_group(CurveView curve, std::size_t& next) {
    const Vertex first = curve[next++];
    float after = first.value;
    while (next < curve.size() && curve[next].z == first.z) after = curve[next++].value;
    return {first.z, first.value, after};
}

// Vertices written so far. The last one written is the origin of the segment that is being drawn; its value is the
// rounded one, so that rounding does not add up.
struct Output {
    Vertex* vertices;
    std::size_t count = 0;
    double z = 0.0, value = 1.0;

    void emit(double at, double aim) {
        const Vertex vertex{static_cast<float>(at), static_cast<float>(aim)};
        // In front of the first vertex the function is constant anyway.
        if (count == 1 && vertices[0].value == vertex.value) count = 0;
        vertices[count++] = vertex;
        z = vertex.z;
        value = vertex.value;
    }
};

}  // namespace

std::size_t compress(CurveView curve, float tolerance, Vertex* vertices) {
    if (curve.empty()) return 0;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double epsilon = tolerance > 0.0f ? tolerance : 0.0;
    Output out{vertices};

    // The function starts at its exact first value: what lies in front of every occluder is not darkened.
    std::size_t next = 0;
    Group last = read_group(curve, next);
    out.emit(last.z, last.before);
    if (last.before - last.after > epsilon) out.emit(last.z, last.after);

    // Slopes from the origin that pass within epsilon of all groups up to `last`. `high` may be above 0: the middle is
    // then still unbiased on flat stretches; only what is written is kept from rising.
    double low = -kInfinity, high = kInfinity;
    const auto end_segment = [&](const Group& group, double floor, double ceiling) {
        const double aim = out.value + 0.5 * (low + high) * (group.z - out.z);
        out.emit(group.z, std::min(std::clamp(aim, floor, std::max(floor, ceiling)), out.value));
        low = -kInfinity;
        high = kInfinity;
    };

    while (next < curve.size()) {
        const Group group = read_group(curve, next);
        const double floor = std::max(group.before - epsilon, 0.0);  // the segment passes both sides of the step
        const double ceiling = group.after + epsilon;
        while (true) {
            const double inverse = 1.0 / (group.z - out.z);  // off the critical path: it needs neither low nor high
            const double new_low = std::max(low, (floor - out.value) * inverse);
            const double new_high = std::min(high, (ceiling - out.value) * inverse);
            if (new_low <= new_high) {
                low = new_low;
                high = new_high;
                break;
            }
            if (floor > ceiling) {  // no segment passes this step: reach its front side if possible, then step
                const double front_high = std::min(high, (group.before + epsilon - out.value) * inverse);
                if (new_low <= front_high) {
                    low = new_low;
                    high = front_high;
                    end_segment(group, floor, group.before + epsilon);
                    out.emit(group.z, group.after);
                    break;
                }
            }
            // A fresh segment always reaches this group: its origin is within epsilon of last.after >= group.before.
            end_segment(last, std::max(last.before - epsilon, 0.0), last.after + epsilon);
        }
        last = group;
    }

    // The function stays at its last value for ever, so the last segment aims at it instead of at the middle.
    double aim = last.after;
    if (out.z < last.z) {
        constexpr double kSlack = 0x1p-48;  // slope * length rounds; without it 0 becomes 1e-16
        const double length = last.z - out.z;
        const double floor = out.value + low * length - kSlack;
        const double ceiling = out.value + std::min(high, 0.0) * length + kSlack;
        aim = std::clamp(std::clamp(aim, floor, std::max(floor, ceiling)), 0.0, out.value);
    }
    if (static_cast<float>(aim) != static_cast<float>(out.value)) out.emit(last.z, aim);
    if (out.count == 1 && out.vertices[0].value == 1.0f) return 0;
    return out.count;
}

Curve compress(CurveView curve, float tolerance) {
    Curve out(curve.size());
    out.resize(compress(curve, tolerance, out.data()));
    return out;
}

}  // namespace shadowbench::curves

#include "curves/compress.h"

#include <algorithm>
#include <limits>

#include "curves/compress_parts.h"
#include "curves/slope_windows.h"

namespace shadowbench::curves {

namespace {

using namespace compression;

float value_of(const Vertex& vertex, int) {
    return vertex.value;
}
float value_of(const ColourVertex& vertex, int c) {
    return vertex.value[c];
}

// The vertices written so far. The last one is the origin of the current segment, with its rounded value, so that
// rounding does not add up.
template <int channels, class OutVertex>
struct Output {
    OutVertex* vertices;
    std::size_t count = 0;
    double z = 0.0;
    Values<channels> value{};

    void emit(double at, const Values<channels>& aim) {
        std::array<float, channels> rounded;
        for (int c = 0; c < channels; ++c) rounded[c] = to_float<channels>(aim[c]);
        OutVertex vertex;
        write(vertex, static_cast<float>(at), rounded);
        // Before the first vertex the function is constant anyway.
        if (count == 1 && same_values(vertices[0], vertex)) count = 0;
        vertices[count++] = vertex;
        z = vertex.z;
        for (int c = 0; c < channels; ++c) value[c] = rounded[c];
    }
    static bool same_values(const OutVertex& a, const OutVertex& b) {
        for (int c = 0; c < channels; ++c)
            if (value_of(a, c) != value_of(b, c)) return false;
        return true;
    }
};

template <int channels, class Reader, class OutVertex>
class Compressor {
public:
    Compressor(const Reader& in, float tolerance, OutVertex* vertices)
        : in_(in), epsilon_(tolerance > 0.0f ? tolerance : 0.0), out_{vertices} {}

    std::size_t run() {
        // The function starts at its exact first value, so nothing before the first occluder is darkened.
        last_ = in_.read();
        out_.emit(last_.z, last_.before);
        if (exceeds(last_.before, last_.after)) out_.emit(last_.z, last_.after);
        while (in_.more()) {
            const Group<channels> group = in_.read();
            take(group);
            last_ = group;
            if constexpr (channels == 1)
                if (in_.next >= slow_until_) take_blocks();
        }
        return finish();
    }

private:
    // Vertices of a segment before the first block is tried, and after each block that failed.
    static constexpr std::size_t kShort = 4;
    using Step = Group<channels>;

    bool exceeds(const Values<channels>& before, const Values<channels>& after) const {
        for (int c = 0; c < channels; ++c)
            if (before[c] - after[c] > epsilon_) return true;
        return false;
    }

    // Takes many groups at once while the segment passes them. Short segments would only lose by it.
    void take_blocks() {
        Slopes slopes{low_[0], high_[0]};
        const std::size_t first = in_.next;
        in_.next += narrow_by_blocks(in_.curve, first, out_.z, out_.value[0], epsilon_, slopes);
        slow_until_ = in_.next + kShort;
        if (in_.next == first) return;
        low_[0] = slopes.low;
        high_[0] = slopes.high;
        const Vertex end = in_.curve[in_.next - 1];
        float before = end.value;
        for (std::size_t i = in_.next - 1; i > first && in_.curve[i - 1].z == end.z; --i)
            before = in_.curve[i - 1].value;
        last_ = {end.z, {before}, {end.value}};
    }

    void take(const Step& group) {
        // The segment passes both sides of the step.
        Values<channels> floor, ceiling;
        bool torn = false;  // no segment passes this step
        for (int c = 0; c < channels; ++c) {
            floor[c] = std::max(group.before[c] - epsilon_, 0.0);
            ceiling[c] = group.after[c] + epsilon_;
            torn = torn || floor[c] > ceiling[c];
        }
        while (!narrow(group.z, floor, ceiling)) {
            if (torn) {  // reach its front side if possible, then step
                Values<channels> front;
                for (int c = 0; c < channels; ++c) front[c] = group.before[c] + epsilon_;
                if (narrow(group.z, floor, front)) {
                    end_segment(group.z, floor, front);
                    Values<channels> behind;  // a channel that is not torn may have come out lower in front
                    for (int c = 0; c < channels; ++c) behind[c] = std::min(group.after[c], out_.value[c]);
                    out_.emit(group.z, behind);
                    return;
                }
            }
            // A fresh segment always reaches this group: its origin is within epsilon of last.after >= group.before.
            Values<channels> last_floor, last_ceiling;
            for (int c = 0; c < channels; ++c) {
                last_floor[c] = std::max(last_.before[c] - epsilon_, 0.0);
                last_ceiling[c] = last_.after[c] + epsilon_;
            }
            end_segment(last_.z, last_floor, last_ceiling);
        }
    }

    // Keeps the slopes that pass between floor and ceiling at z. Returns false and changes nothing if there are none.
    bool narrow(double z, const Values<channels>& floor, const Values<channels>& ceiling) {
        const double inverse = 1.0 / (z - out_.z);  // off the critical path: needs neither low nor high
        Values<channels> low, high;
        bool passes = true;
        for (int c = 0; c < channels; ++c) {
            low[c] = std::max(low_[c], (floor[c] - out_.value[c]) * inverse);
            high[c] = std::min(high_[c], (ceiling[c] - out_.value[c]) * inverse);
            passes = passes && low[c] <= high[c];
        }
        if (!passes) return false;
        low_ = low;
        high_ = high;
        return true;
    }

    void end_segment(double z, const Values<channels>& floor, const Values<channels>& ceiling) {
        Values<channels> value;
        for (int c = 0; c < channels; ++c) {
            const double aim = out_.value[c] + 0.5 * (low_[c] + high_[c]) * (z - out_.z);
            value[c] = std::min(std::clamp(aim, floor[c], std::max(floor[c], ceiling[c])), out_.value[c]);
        }
        out_.emit(z, value);
        low_ = all(-kInfinity);
        high_ = all(kInfinity);
        if constexpr (channels == 1) slow_until_ = in_.next + kShort;
    }

    // The functions keep their last values from here on, so the last segment aims at them instead of at the middle.
    std::size_t finish() {
        Values<channels> aim;
        bool moves = false;
        for (int c = 0; c < channels; ++c) {
            aim[c] = std::min(last_.after[c], out_.value[c]);
            if (out_.z < last_.z) {
                constexpr double kSlack = 0x1p-48;  // slope * length rounds; without it 0 becomes 1e-16
                const double length = last_.z - out_.z;
                const double floor = out_.value[c] + low_[c] * length - kSlack;
                const double ceiling = out_.value[c] + std::min(high_[c], 0.0) * length + kSlack;
                aim[c] = std::clamp(std::clamp(aim[c], floor, std::max(floor, ceiling)), 0.0, out_.value[c]);
            }
            moves = moves || static_cast<float>(aim[c]) != static_cast<float>(out_.value[c]);
        }
        if (moves) out_.emit(last_.z, aim);
        bool lit = out_.count == 1;
        for (int c = 0; c < channels; ++c) lit = lit && value_of(out_.vertices[0], c) == 1.0f;
        return lit ? 0 : out_.count;
    }

    static Values<channels> all(double value) {
        Values<channels> values;
        values.fill(value);
        return values;
    }

    Reader in_;
    double epsilon_;
    Output<channels, OutVertex> out_;
    Step last_;
    // Slopes from the origin that pass within epsilon of all groups up to `last`. `high` may be above 0, which keeps
    // the middle unbiased on flat parts; only what is written is kept from rising.
    Values<channels> low_ = all(-kInfinity), high_ = all(kInfinity);
    std::size_t slow_until_ = kShort;  // no block is tried before this vertex
};

}  // namespace

std::size_t compress(CurveView curve, float tolerance, Vertex* out) {
    if (curve.empty()) return 0;
    return Compressor<1, OneReader, Vertex>({curve}, tolerance, out).run();
}

Curve compress(CurveView curve, float tolerance) {
    Curve out(curve.size());
    out.resize(compress(curve, tolerance, out.data()));
    return out;
}

std::size_t compress(const std::array<CurveView, 3>& curves, float tolerance, ColourVertex* out) {
    if (curves[0].empty() && curves[1].empty() && curves[2].empty()) return 0;
    return Compressor<3, ColourReader, ColourVertex>(ColourReader(curves), tolerance, out).run();
}

}  // namespace shadowbench::curves

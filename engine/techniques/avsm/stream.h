// The streaming compression of one texel (section 3.2): insert a segment, then drop the nodes that change the area under
// the curve least until no more than the texel's number are left.
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace shadowbench::techniques {

// A transmittance curve of at most `capacity` nodes, 2 to 64, linear between them. The last one is always at the far
// plane; depths do not decrease, values neither increase nor leave [0, 1]; the value before the first node is 1.
class TransmittanceStream {
public:
    static constexpr int max_capacity = 64;

    TransmittanceStream(int capacity, float far_plane) : capacity_(capacity) { clear(far_plane); }

    void clear(float far_plane) {
        size_ = 1;
        depth_[0] = far_plane;
        value_[0] = 1.0f;
    }

    // A segment with constant extinction from front to back (front == back: a surface) that transmits `through`. All of
    // it lies before the far plane.
    void insert(float front, float back, float through) {
        // Where a zero curve is multiplied nothing changes, and where everything passes neither.
        int at = 0;
        while (at < size_ - 1 && depth_[at] < front) ++at;
        const float before = value_at(at, front);
        if (before <= 0.0f || through >= 1.0f) return;

        int end = at;  // first node behind the segment
        while (end < size_ && depth_[end] <= back) ++end;
        const float after = end < size_ ? value_at(end, back) * through : value_[size_ - 1] * through;
        // Nodes at the segment's own ends serve as its ends. The first node at `front` holds the value before it.
        const bool has_front = depth_[at] == front;
        if (front == back) {
            for (int i = at + 1; i < end; ++i) value_[i] *= through;
            for (int i = end; i < size_; ++i) value_[i] *= through;
            const bool has_back = end - at >= 2;
            open(end, has_back ? 0 : 1, back, after);
            open(at, has_front ? 0 : 1, front, before);
        } else {
            const float log_through = std::log(through > 0.0f ? through : std::numeric_limits<float>::min());
            for (int i = at; i < end; ++i)  // inside: the medium's own curve
                value_[i] *= depth_[i] == back ? through : std::exp(log_through * ((depth_[i] - front) / (back - front)));
            for (int i = end; i < size_; ++i) value_[i] *= through;
            open(end, depth_[end - (end > 0)] == back && end > at ? 0 : 1, back, after);
            open(at, has_front ? 0 : 1, front, before);
        }
        while (size_ > capacity_) remove_least();
    }

    // Appends a node behind all others; the far plane follows it. For curves that are given node by node.
    void append(float depth, float value) {
        open(size_ - 1, 1, depth, value);
        value_[size_ - 1] = value;
        while (size_ > capacity_) remove_least();
    }

    int size() const { return size_; }
    float depth(int i) const { return depth_[i]; }
    float value(int i) const { return value_[i]; }

private:
    // Value at z, where `next` is the first node not before z.
    float value_at(int next, float z) const {
        if (next == 0) return 1.0f;
        if (depth_[next] == z) return value_[next];
        const float u = (z - depth_[next - 1]) / (depth_[next] - depth_[next - 1]);
        return value_[next - 1] + u * (value_[next] - value_[next - 1]);
    }

    void open(int at, int count, float depth, float value) {
        if (count == 0) return;
        for (int i = size_; i > at; --i) {
            depth_[i] = depth_[i - 1];
            value_[i] = value_[i - 1];
        }
        depth_[at] = depth;
        value_[at] = value;
        ++size_;
    }

    // Section 3.2.1: twice the area of the triangle of a node and its neighbours.
    float area(int i) const {
        return std::abs((depth_[i + 1] - depth_[i - 1]) * (value_[i + 1] - value_[i]) -
                        (depth_[i + 1] - depth_[i]) * (value_[i + 1] - value_[i - 1]));
    }

    void remove_least() {
        int least = 1;
        float smallest = std::numeric_limits<float>::infinity();
        for (int i = 1; i < size_ - 1; ++i)
            if (const float a = area(i); a < smallest) {
                smallest = a;
                least = i;
            }
        --size_;
        for (int i = least; i < size_; ++i) {
            depth_[i] = depth_[i + 1];
            value_[i] = value_[i + 1];
        }
    }

    int capacity_;
    int size_ = 0;
    std::array<float, max_capacity + 4> depth_;
    std::array<float, max_capacity + 4> value_;
};

}  // namespace shadowbench::techniques

#include "curves/composite.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/compensated.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

namespace {

// Below this a double product is soon denormal, and its logarithm is no longer an accurate optical depth.
constexpr double kFaintest = 1e-300;

struct Medium {
    double front, back;
    double through;            // transmittance of the whole segment
    double extinction = -1.0;  // per unit of z; computed when first needed: most media never overlap another segment
    bool counted = false;      // included in the sums of OpenMedia
    bool ended = false;

    double through_inside() const { return std::max(through, double{std::numeric_limits<float>::min()}); }
    double per_depth() {
        if (extinction < 0.0) extinction = -std::log(through_inside()) / (back - front);
        return extinction;
    }
};

// The media that a ray is inside of. Keeps their optical depths as two sums, of extinctions and of extinctions times
// fronts, in twice the precision: adding and taking away again leaves nothing, and each of thousands of nested media
// costs no more than each of two.
class OpenMedia {
public:
    bool empty() const { return by_back_.empty(); }
    double first_back() const { return by_back_.front().back; }

    void open(const Medium& medium) {
        if (empty()) {  // a fresh start: no rounding error outlives the media that caused it
            origin_ = medium.front;
            extinction_ = extinction_front_ = base::CompensatedSum();
        }
        by_back_.push_back({medium.back, media_.size()});
        std::push_heap(by_back_.begin(), by_back_.end(), std::greater<>());
        fresh_.push_back(media_.size());
        media_.push_back(medium);
    }

    // Removes all media that end at or before z; ended() lists them until the next call.
    void close(double z) {
        ended_.clear();
        double steepest = 0.0;
        while (!empty() && first_back() <= z) {
            const std::size_t number = by_back_.front().number;
            std::pop_heap(by_back_.begin(), by_back_.end(), std::greater<>());
            by_back_.pop_back();
            ended_.push_back(number);
            media_[number].ended = true;
            if (media_[number].counted) count(media_[number], -1.0);
            steepest = std::max(steepest, media_[number].extinction);
        }
        if (extinction_.value() < kLost * steepest) count_again();
        for (const std::size_t number : fresh_)
            if (!media_[number].ended) {
                count(media_[number], 1.0);
                media_[number].counted = true;
            }
        fresh_.clear();
        if (empty()) extinction_ = extinction_front_ = base::CompensatedSum();
    }
    const std::vector<std::size_t>& ended() const { return ended_; }
    Medium& medium(std::size_t number) { return media_[number]; }

    // The sum over all open media, each from its front to z.
    double optical_depth(double z) const {
        return empty() ? 0.0 : std::max(extinction_.value() * (z - origin_) - extinction_front_.value(), 0.0);
    }
    double extinction() const { return extinction_.value(); }

    void clear() {
        media_.clear();
        by_back_.clear();
        fresh_.clear();
    }

private:
    struct End {
        double back;
        std::size_t number;
        bool operator>(const End& other) const { return back > other.back; }
    };
    void count(Medium& medium, double sign) {
        extinction_.add(sign * medium.per_depth());
        extinction_front_.add(sign * (medium.per_depth() * (medium.front - origin_)));
    }

    // Computes the sums again: a medium more than 2^80 times as dense as all that stay has left too few digits.
    void count_again() {
        extinction_ = extinction_front_ = base::CompensatedSum();
        for (const End& end : by_back_)
            if (media_[end.number].counted) count(media_[end.number], 1.0);
    }

    static constexpr double kLost = 0x1p-80;

    std::vector<Medium> media_;
    std::vector<End> by_back_;        // a heap, the first end on top
    std::vector<std::size_t> fresh_;  // opened at the last event, not in the sums yet
    std::vector<std::size_t> ended_;
    double origin_ = 0.0;
    base::CompensatedSum extinction_, extinction_front_;
};

void composite_surfaces(const rays::LightRays& rays, std::size_t ray, int channel, std::vector<Node>& out) {
    double value = 1.0;
    for (std::size_t s = rays.begin[ray], end = rays.begin[ray + 1]; s < end && value > 0.0;) {
        const float z = rays.z_front[s];
        const double before = value;
        for (; s < end && rays.z_front[s] == z; ++s) value *= rays.transmittance[s * rays.channels + channel];
        if (value == before) continue;
        out.push_back({z, before});
        out.push_back({z, value});
    }
}

// Many overlapping media can reach optical depths whose transmittance is 0 in double. The node (z, 0) would hide how
// steeply the function fell, so a node goes where the value is still above 0, at a depth that a float can hold.
void add_faintest(OpenMedia& open, double z, std::vector<Node>& out) {
    const Node last = out.back();
    double extinction = open.extinction();
    for (const std::size_t number : open.ended()) extinction += open.medium(number).per_depth();
    const float low = static_cast<float>(last.z), high = std::numeric_limits<float>::infinity();
    float at = static_cast<float>(last.z + std::log(last.value / kFaintest) / extinction);
    if (at > last.z + std::log(last.value / kFaintest) / extinction) at = std::nextafter(at, low);
    if (!(at > low)) at = std::nextafter(low, high);
    if (at < z) out.push_back({at, last.value * std::exp(-extinction * (at - last.z))});
}

}  // namespace

void composite(const rays::LightRays& rays, std::size_t ray, int channel, std::vector<Node>& out) {
    out.clear();
    if (rays.z_back.empty()) return composite_surfaces(rays, ray, channel, out);

    thread_local OpenMedia open;  // keeps its memory from ray to ray
    open.clear();
    double closed = 1.0;  // product of all segments wholly in front
    const std::size_t end = rays.begin[ray + 1];
    std::size_t s = rays.begin[ray];
    const auto through = [&] { return double{rays.transmittance[s * rays.channels + channel]}; };
    while (true) {
        while (s < end && through() >= 1.0) ++s;
        if (s == end && open.empty()) return;
        double z = s < end ? double{rays.z_front[s]} : std::numeric_limits<double>::infinity();
        if (!open.empty()) z = std::min(z, open.first_back());

        open.close(z);
        double before = closed, after = closed;
        for (const std::size_t number : open.ended()) {
            before *= open.medium(number).through_inside();
            after *= open.medium(number).through;
        }
        const double optical_depth = open.optical_depth(z);
        for (; s < end && rays.z_front[s] == z && (rays.z_back[s] <= z || through() >= 1.0); ++s) after *= through();
        // Sorted by z_back at equal z_front: surfaces come first, and a medium ends behind its front.
        closed = after;
        if (optical_depth > 0.0) {
            const double faded = std::exp(-optical_depth);
            before *= faded;
            after *= faded;
        }
        if (!out.empty()) {
            if (before < kFaintest && out.back().value > kFaintest && z > out.back().z) add_faintest(open, z, out);
            before = std::min(before, out.back().value);  // the exponential's last digit may be off
            after = std::min(after, before);
        }
        out.push_back({z, before});
        if (after < before) out.push_back({z, after});
        if (after == 0.0) return;

        for (; s < end && rays.z_front[s] == z; ++s)
            if (through() < 1.0) open.open({z, rays.z_back[s], through()});
    }
}

}  // namespace shadowbench::curves

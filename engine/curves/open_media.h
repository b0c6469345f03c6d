// The media that a ray is inside of, while its transmittance function is made: scratch memory of composite().
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "base/compensated.h"

namespace shadowbench::curves {

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

    std::size_t bytes() const {
        return media_.capacity() * sizeof(Medium) + by_back_.capacity() * sizeof(End) +
               (fresh_.capacity() + ended_.capacity()) * sizeof(std::size_t);
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

}  // namespace shadowbench::curves

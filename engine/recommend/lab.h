// What a search over settings asks and learns. The search sees only this; bench measures behind it, and tests put laws
// of their own behind it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metrics/statistics.h"

namespace shadowbench::recommend {

enum class Cost {
    lookup,  // ns of one lookup, random order, one thread
    bytes,   // of the finished map
    build,   // ms: capturing the light rays and building the map, one thread
};
inline constexpr std::size_t costs = 3;

// The steps of one quantity that trades cost against error, from the cheapest to the most accurate. The search takes it
// that along an axis costs rise and errors fall, apart from noise and plateaus. It begins with every `stride`-th step,
// and tries the steps between later.
struct Axis {
    std::string name;                 // as a scenario has it
    std::vector<std::string> values;  // one a step, as a scenario has them; at least one
    int stride = 1;

    int steps() const { return static_cast<int>(values.size()); }
};

// One technique with one choice of its words (a filter, a kernel): words have no order, so each choice is a family of
// its own. Axis 0 is the map's resolution and axis 1 the number of light rays a pixel, equal for all families: points
// that agree in both share their light rays. The technique's own parameters follow. A family that needs no light rays
// has one step on axes 0 and 1, and its points share none.
struct Family {
    // A parameter that is the same for all points, and its value as JSON.
    struct Word {
        std::string name, value;
    };
    std::string technique;  // a runner-up is the best family of another technique
    std::string name;       // the technique and its words: "deep kernel=box"
    std::vector<Axis> axes;
    std::vector<Word> words = {};
    // It can store any function as exactly as its own axes allow, so that with their last steps it errs by its light
    // rays and its filter only.
    bool faithful = false;
    // An earlier family of the same technique whose words differ only in how the same map is laid out: their settings
    // err alike.
    std::optional<std::size_t> answers_as = {};
    // It stores no map: its bytes and its builds cost nothing, and so answer nothing. Only its lookups compete.
    bool mapless = false;
};

struct Point {
    std::size_t family = 0;
    std::vector<int> step;  // one per axis of the family

    bool operator==(const Point&) const = default;
};

// One measurement, with one seed and short times.
struct Trial {
    std::string failed;  // why the technique broke a promise or cannot serve this scene; empty: it did not
    double error = 0.0;
    std::array<double, costs> cost{};
};

// A measurement that answers: several seeds, and times interleaved with those of the other points of the same call.
struct Confirmed {
    std::string failed;
    bool cut = false;  // time ran out: its intervals rest on fewer seeds or repetitions than planned
    metrics::Interval error{0.0, 0.0};  // 95 %
    double mean_error = 0.0;
    std::array<double, costs> cost{};  // medians
    std::array<metrics::Interval, costs> interval{};
    std::vector<double> lookup_rounds = {};  // ns a lookup in each round; a round times all points of the same call
};

struct Confirming {
    double error;  // what the points are judged by; those that clearly err more or less need fewer seeds
    bool builds_asked = true;  // whether build times answer something, or are only shown
    // It takes about so many seconds at most, but never less than the least that an interval rests on.
    double most_seconds = std::numeric_limits<double>::infinity();
    double lookups_share = 0.1;  // of these seconds, for rounds of lookups after the least ones
};

class Lab {
public:
    virtual ~Lab() = default;
    virtual std::span<const Family> families() const = 0;
    // The family that loses nothing of its light rays (the uncompressed map): the others err at least about as much at
    // the same resolution and samples. Nothing if there is none.
    virtual std::optional<std::size_t> scout() const = 0;
    // About how many seconds measure() would take now, to order the work: the light rays, unless they are there
    // already, and the rest. Above 0.
    virtual double effort(const Point& point) const = 0;
    // No point takes less. Above 0.
    virtual double least_effort() const = 0;
    // About how many seconds more confirm() would take for this point, if it also confirms `others`: light rays that
    // points share are captured once.
    virtual double confirm_effort(const Point& point, std::span<const Point> others) const = 0;
    // A lower bound of a cost that is known without measuring; 0 if nothing is known.
    virtual double at_least(const Point& point, Cost cost) const = 0;
    virtual Trial measure(const Point& point) = 0;
    // The lookup times of measured points again, in turns, so that a disturbance hits all alike: their ratios hold better
    // than those of trials. Nothing for a point that cannot be timed now.
    virtual std::vector<std::optional<double>> time_again(std::span<const Point> points) = 0;
    virtual std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) = 0;
};

}  // namespace shadowbench::recommend

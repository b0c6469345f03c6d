// The answer of an exploration: per cost the cheapest setting at an error, the runner-up, and what cannot reach the
// error and why. It needs only the points of the exploration, so a finished one can be asked for another error.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "metrics/statistics.h"
#include "recommend/exploration.h"

namespace shadowbench::recommend {

// A measured setting. If it is not confirmed, its error is that of one trial, scaled by what confirming adds elsewhere,
// and the intervals of its times are the noise of a short measurement.
struct Choice {
    Point point;
    bool confirmed = false;
    metrics::Interval error{0.0, 0.0};
    std::array<double, costs> cost{};
    std::array<metrics::Interval, costs> interval{};
};

struct Cheapest {
    Choice best;
    std::optional<Choice> runner_up;  // the best of another technique
    double behind = 0.0;              // how much more the runner-up costs, as a share of the best's cost
    bool tie = false;                 // their intervals overlap
    std::optional<Choice> perhaps;    // certainly cheaper than the best, but its error is not confirmed
};

// What keeps a technique above the error.
enum class Held {
    rays,            // the scout errs too much as well, or there is none and the technique's own parameters do not end
    representation,  // the scout's error is low enough, or the technique's own parameters end
    bias,            // two rungs of the climb (ladder.h) lower the error by less than a tenth
    budget,          // the exploration ended before that was known
    dear,            // not followed further: the closest setting costs more than the answers in every cost asked
    given,           // none of the run's settings reaches it; nothing is known of others
    at_most,         // settings reach the error, but cost more than allowed
};

const char* to_string(Held held);  // in words: "rays too few"

struct Missed {
    std::string technique;
    Held held = Held::rays;
    std::optional<Choice> closest;  // the least error of the technique; nothing if none of its settings was measured
};

// Settings that broke a promise. They are left out.
struct Broken {
    std::string technique;
    std::size_t settings = 0;  // that failed
    std::size_t measured = 0;
    std::string reason;  // of the first
    Point first;
};

struct Answer {
    Goal goal;
    // Of the costs asked. Bytes and builds are those of a map: techniques without one do not compete for them.
    std::array<std::optional<Cheapest>, costs> cheapest;
    std::optional<Choice> without_map;  // the least lookup time without a map
    bool reached = false;               // some setting is good enough; if not, the exit code is 2
    std::optional<Choice> closest;      // the least error within the limits, if none is
    std::vector<Missed> missed;
    std::vector<Broken> broken;
    std::size_t measured = 0, confirmed = 0;
    bool cut = false;  // the time to confirm ran out: intervals are wider than planned
    End end = End::complete;
    std::optional<double> steal = {};  // see Exploration
    std::optional<NextStep> next = {};
    double budget = std::numeric_limits<double>::infinity();  // seconds, of the exploration
    // Techniques that did not fail, and those of them of which the budget's end leaves open what they cost at the
    // error.
    std::size_t techniques = 0, open = 0;

    // Whether the budget ended so early that the cheapest settings are those of the few techniques that were followed.
    bool too_early() const { return end == End::budget && open > 0 && 2 * open >= techniques; }
};
// `goal` may ask for another error, other costs and other limits than the exploration's.
Answer answer(const Exploration& found, const Goal& goal);

// Seconds that a search should have which so many did not suffice for: whole minutes.
double longer_budget(double seconds);

// Seconds as a budget is written: "90s", "5min".
std::string budget_text(double seconds);

// A cost (as Cost) with its unit: "10.5 ns", "1.23 µs", "128 KiB", "24.1 ms", "1.8 s".
std::string cost_text(double value, std::size_t cost);

// "deep kernel=box tolerance=0.01, resolution=512 samples=16"
std::string setting_text(const std::vector<Family>& families, const Point& point);

inline constexpr std::size_t text_lines = 20, text_columns = 100;  // of the answer
struct Wording {
    std::string measure;                             // of the error, as "rms"
    std::function<std::string(const Point&)> paste;  // the line of a scenario; may be empty
    std::size_t width = text_columns;                // characters of a line, at least 60
    std::optional<double> truth = {};                // its standard error, if the error is against one
    // The command for the same question with a budget of so many seconds; empty: there is no command.
    std::function<std::string(double)> again = {};
};
// Lines of this width, but for those to paste; what does not fit goes on in the next line. About `text_lines`, unless
// the width is below `text_columns`: where these do not do, reasons are shortened, then lines without a setting are
// cut.
std::string to_text(const Answer& answer, const std::vector<Family>& families, const Wording& wording);

// What one technique costs at every error: its measured settings that no other of its settings beats in both, from the
// largest error to the least.
struct Curve {
    std::string technique;
    std::vector<Choice> points;
};
std::vector<Curve> curves(const Exploration& found, Cost cost);

}  // namespace shadowbench::recommend

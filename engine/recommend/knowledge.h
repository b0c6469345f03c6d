// What the measurements of one family say about its other points.
//
// Two kinds of statements are kept apart. Bounds follow from measured points, since costs rise and errors fall along
// every axis; each has a margin for noise. Beliefs come from a model that is fitted to the measured points.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "recommend/exploration.h"
#include "recommend/floors.h"
#include "recommend/lattice.h"
#include "recommend/model.h"

namespace shadowbench::recommend {

// A point that errs by more than this times the error asked rules out all points that are less accurate on every axis.
inline constexpr double clear_error = 1.1;
// What a short measurement of a cost may be off by, as a factor.
inline constexpr std::array<double, costs> cost_noise{1.15, 1.0, 1.15};
// What the models expect of logarithms before anything is measured. A coarse step is about a factor of 2 in a parameter.
inline constexpr Prior error_prior{-0.3, 0.4, 0.03};
inline constexpr Prior bytes_prior{0.4, 0.5, 0.01};
inline constexpr Prior time_prior{0.3, 0.4, 0.07};
// Families with at most so many points have no coarse ones: they are modelled fast enough for all to count from the
// start, which misses less.
inline constexpr std::size_t small_lattice = 10000;
// A family is left out if this many points fail and none succeeds.
inline constexpr std::size_t failures_to_leave = 3;

struct Record {
    std::size_t index = 0;  // in the lattice
    std::vector<int> step;
    std::string failed;
    double error = 0.0;               // the upper end of its interval, if it is confirmed; else of the trial
    std::array<double, costs> cost{};  // short measurements are smoothed by the model
    bool confirmed = false;
    bool timed_again = false;  // its lookups: their time is not smoothed
    std::array<double, costs> upper_cost{};  // for limits: the upper ends of intervals, if it is confirmed; else as cost
};

// What makes a setting acceptable.
struct Wanted {
    double error = 0.0;        // of confirmed points
    double trial_error = 0.0;  // of trials: less, if confirmed errors are found to be larger than those of trials
    std::array<double, costs> at_most{};
};

class Knowledge {
public:
    Knowledge(const Family& family, std::size_t number, const Lab& lab);

    const Lattice& lattice() const { return lattice_; }
    std::span<const Record> records() const { return records_; }
    void add(const Point& point, const Trial& trial);
    void confirm(const Point& point, const Confirmed& confirmed);
    void time_again(const Point& point, double lookup_ns);
    // The error of this setting, measured with a family that answers alike. Its costs there say nothing of those here.
    void add_answer(const std::vector<int>& step, double error) { answers_.push_back({step, error}); }
    // What light rays leave of any function counts for this family too.
    void bound_by(const std::vector<Floor>& floors) { floors_ = floors; }
    // What other families reached with light rays that this one was not built from tells about its error there.
    void borrow(std::vector<Floor> floors) { others_ = std::move(floors); }

    bool borrowed_at(const Point& point) const;

    // Brings everything below up to date with what was added. Unless `fine`, only coarse points have chances. Points
    // that cost at least as much as `limits` in every cost have none either.
    void update(const Wanted& wanted, bool fine, const std::array<double, costs>& limits);

    // Only what is acceptable.
    void want(const Wanted& wanted) { wanted_ = wanted; }

    bool measured(std::size_t index) const { return measured_[index]; }
    // The error over the one wanted; infinite if the point fails or costs more than allowed.
    double excess(const Record& record) const;
    bool acceptable(const Record& record) const { return excess(record) <= 1.0; }
    bool left_out() const { return left_out_; }
    // No measurement is needed: the point cannot be acceptable, or another acceptable one costs no more.
    bool ruled_out(std::size_t index) const { return ruled_out_[index]; }
    // At least this, from measured points.
    double least(std::size_t index, Cost cost) const { return least_[static_cast<std::size_t>(cost)][index]; }
    // The chance that the point is acceptable, and what the model says about the logarithms of its costs. Of points
    // that are neither measured nor ruled out.
    double chance(std::size_t index) const { return chance_[index]; }
    // What the model says of any point, whatever rules it out. At least one point must have been measured.
    double chance_there(std::size_t index) const;
    const Estimate& cost(std::size_t index, Cost cost) const {
        return estimates_[static_cast<std::size_t>(cost)][index];
    }

private:
    std::vector<double> position(const std::vector<int>& step) const;
    void bound();
    void rule_out_failures();
    void fit();
    void smooth_costs();
    std::vector<Estimate> errors_at(std::span<const std::size_t> indices) const;
    std::array<std::vector<Estimate>, costs> costs_at(std::span<const std::size_t> indices) const;
    struct Values {
        std::vector<std::vector<double>> positions;
        std::vector<double> logarithms, doubts;
    };
    struct Answer {
        std::vector<int> step;
        double error;
    };
    std::vector<Answer> own_answers() const;
    std::vector<double> flat_positions(std::span<const std::size_t> indices) const;
    void add_borrowed(Values& errors, std::span<const Answer> known) const;
    void drop_hopeless(std::vector<std::size_t>& candidates, const std::vector<std::size_t>& better);
    void drop_hopeless_rays(std::vector<std::size_t>& candidates);
    void drop_hopeless_blocks(std::vector<std::size_t>& candidates);
    std::vector<std::size_t> candidates();
    double chance_of(const Estimate& error) const;
    void believe();

    Lattice lattice_;
    bool faithful_;
    std::vector<double> stride_;
    Wanted wanted_;
    std::vector<Record> records_;
    std::vector<Trial> trials_;  // of the records
    std::vector<Answer> answers_;  // of families that answer alike
    std::vector<Floor> floors_, others_;
    std::vector<char> coarse_, measured_, ruled_out_;
    bool fine_ = true;
    std::array<double, costs> limits_{};
    bool left_out_ = false;
    std::array<std::vector<double>, costs> known_, least_;
    std::vector<double> chance_;
    std::array<std::vector<Estimate>, costs> estimates_;
    Model error_model_;
    std::array<Model, costs> cost_models_;
};

// The chance that a normal variable is at most `x` standard deviations above its mean.
double normal_below(double x);

}  // namespace shadowbench::recommend

#include "recommend/knowledge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::recommend {

double normal_below(double x) {
    return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

Knowledge::Knowledge(const Family& family, std::size_t number, const Lab& lab)
    : lattice_(family, number),
      faithful_(family.faithful),
      measured_(lattice_.size(), 0),
      ruled_out_(lattice_.size(), 0),
      chance_(lattice_.size(), 0.0),
      error_model_(error_prior),
      cost_models_{Model(time_prior), Model(bytes_prior), Model(time_prior)} {
    for (const Axis& axis : family.axes) stride_.push_back(axis.stride);
    for (std::size_t k = 0; k < costs; ++k) {
        estimates_[k].resize(lattice_.size());
        known_[k].resize(lattice_.size());
        for (std::size_t i = 0; i < lattice_.size(); ++i) known_[k][i] = lab.at_least(lattice_.point(i), static_cast<Cost>(k));
    }
    least_ = known_;
    // Every stride-th step of every axis, and the last.
    for (std::size_t i = 0; i < lattice_.size(); ++i) {
        const std::vector<int>& step = lattice_.point(i).step;
        bool coarse = true;
        for (std::size_t a = 0; a < step.size(); ++a)
            coarse = coarse && (step[a] % family.axes[a].stride == 0 || step[a] + 1 == family.axes[a].steps());
        coarse_.push_back(coarse || lattice_.size() <= small_lattice);
    }
}

std::vector<double> Knowledge::position(const std::vector<int>& step) const {
    std::vector<double> result(step.size());
    for (std::size_t i = 0; i < step.size(); ++i) result[i] = step[i] / stride_[i];
    return result;
}

void Knowledge::add(const Point& point, const Trial& trial) {
    const std::size_t index = lattice_.index(point.step);
    measured_[index] = 1;
    records_.push_back({index, point.step, trial.failed, trial.error, trial.cost, false, false, trial.cost});
    trials_.push_back(trial);
}

void Knowledge::confirm(const Point& point, const Confirmed& confirmed) {
    const std::size_t index = lattice_.index(point.step);
    for (Record& record : records_) {
        if (record.index != index) continue;
        record.confirmed = true;
        record.failed = confirmed.failed;
        record.error = confirmed.error.high;
        record.cost = confirmed.cost;
        for (std::size_t k = 0; k < costs; ++k) record.upper_cost[k] = confirmed.interval[k].high;
    }
}

void Knowledge::time_again(const Point& point, double lookup_ns) {
    constexpr std::size_t k = static_cast<std::size_t>(Cost::lookup);
    const std::size_t index = lattice_.index(point.step);
    for (std::size_t i = 0; i < records_.size(); ++i) {
        if (records_[i].index != index) continue;
        records_[i].timed_again = true;
        records_[i].cost[k] = records_[i].upper_cost[k] = trials_[i].cost[k] = lookup_ns;
    }
}

double Knowledge::excess(const Record& record) const {
    for (std::size_t k = 0; k < costs; ++k)
        if (record.upper_cost[k] > wanted_.at_most[k]) return std::numeric_limits<double>::infinity();
    if (!record.failed.empty()) return std::numeric_limits<double>::infinity();
    return record.error / (record.confirmed ? wanted_.error : wanted_.trial_error);
}

void Knowledge::update(const Wanted& wanted, bool fine, const std::array<double, costs>& limits) {
    wanted_ = wanted;
    fine_ = fine;
    limits_ = limits;
    fit();
    bound();
    rule_out_failures();
    believe();
}

void Knowledge::bound() {
    least_ = known_;
    std::fill(ruled_out_.begin(), ruled_out_.end(), 0);
    for (std::size_t i = 0; i < lattice_.size(); ++i) {
        const std::vector<int>& step = lattice_.point(i).step;
        for (const Floor& floor : floors_)
            if (floor.rules_out(step, wanted_.error)) ruled_out_[i] = 1;
        for (const Record& record : records_) {
            if (!record.failed.empty()) continue;
            const double limit = record.confirmed ? wanted_.error : wanted_.trial_error;
            if (record.error > limit * clear_error && at_most(step, record.step)) ruled_out_[i] = 1;
            if (!at_most(record.step, step)) continue;
            if (acceptable(record)) ruled_out_[i] = 1;
            for (std::size_t k = 0; k < costs; ++k)
                least_[k][i] = std::max(least_[k][i], record.cost[k] / cost_noise[k]);
        }
        for (const Answer& answer : answers_)
            if (answer.error > wanted_.trial_error * clear_error && at_most(step, answer.step)) ruled_out_[i] = 1;
        for (std::size_t k = 0; k < costs; ++k)
            if (least_[k][i] > wanted_.at_most[k]) ruled_out_[i] = 1;
    }
}

// Where a technique fails is not known to follow from anything. If some axis separates failures from successes, the
// points beyond all failures on every such axis are taken to fail too.
void Knowledge::rule_out_failures() {
    std::vector<const Record*> failures, successes;
    for (const Record& record : records_) (record.failed.empty() ? successes : failures).push_back(&record);
    left_out_ = successes.empty() && (failures.size() >= failures_to_leave || failures.size() == lattice_.size());
    if (left_out_) {
        std::fill(ruled_out_.begin(), ruled_out_.end(), 1);
        return;
    }
    if (failures.size() < failures_to_leave || successes.empty()) return;
    std::vector<int> from(lattice_.axes(), 0), to(lattice_.axes());
    bool separated = false;
    for (std::size_t axis = 0; axis < lattice_.axes(); ++axis) {
        to[axis] = lattice_.steps(axis) - 1;
        const auto by_step = [axis](const Record* a, const Record* b) { return a->step[axis] < b->step[axis]; };
        const auto [first_failure, last_failure] = std::minmax_element(failures.begin(), failures.end(), by_step);
        const auto [first_success, last_success] = std::minmax_element(successes.begin(), successes.end(), by_step);
        if ((*first_failure)->step[axis] > (*last_success)->step[axis]) {
            from[axis] = (*first_failure)->step[axis];
            separated = true;
        } else if ((*last_failure)->step[axis] < (*first_success)->step[axis]) {
            to[axis] = (*last_failure)->step[axis];
            separated = true;
        }
    }
    if (!separated) return;
    for (std::size_t i = 0; i < lattice_.size(); ++i) {
        const std::vector<int>& step = lattice_.point(i).step;
        if (at_most(from, step) && at_most(step, to)) ruled_out_[i] = 1;
    }
}

}  // namespace shadowbench::recommend

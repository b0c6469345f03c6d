#include "recommend/knowledge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::recommend {
namespace {

constexpr std::array<Cost, costs> all_costs{Cost::lookup, Cost::bytes, Cost::build};
constexpr double least_value = 1e-12;  // values below count as this: their logarithm is modelled

constexpr std::size_t most_borrowed = 8;  // floors: each slows the model down
constexpr double most_excess = 0.5;       // of the logarithm: what filters of faithful families differ by
constexpr double borrowed_doubt = 0.2;    // of the logarithm of an error derived from a floor
constexpr double nearly_none = 0.02;
constexpr double hopeless = 1e-4;       // the costs of points with a smaller chance are not modelled

// Of logarithms. A coarse step is about a factor of 2 in a parameter.
constexpr Prior error_prior{-0.3, 0.4, 0.03};
constexpr Prior bytes_prior{0.4, 0.5, 0.01};
constexpr Prior time_prior{0.3, 0.4, 0.07};

double log_of(double value) {
    return std::log(std::max(value, least_value));
}

}  // namespace

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
        for (std::size_t i = 0; i < lattice_.size(); ++i) known_[k][i] = lab.at_least(lattice_.point(i), all_costs[k]);
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

// A floor, and how much more this family errs than the floors of the light rays that it was built from, make values at
// the accurate ends of its own axes. Only the floors nearest to the error wanted: they decide which light rays suffice.
void Knowledge::add_borrowed(Values& errors, std::span<const Answer> known) const {
    const std::vector<int>& steps = lattice_.steps();
    std::vector<double> excess;
    std::vector<Floor> borrowed;
    for (const Floor& floor : others_) {
        if (floor.resolution >= steps[0] || floor.samples >= steps[1]) continue;
        double least = std::numeric_limits<double>::infinity();
        bool exact = false;
        for (const Answer& answer : known) {
            if (!floor.is_of(answer.step)) continue;
            least = std::min(least, answer.error);
            exact = exact || accurate(answer.step, steps);
        }
        if (!std::isfinite(least)) {
            borrowed.push_back(floor);
            continue;
        }
        // Coarse settings of a faithful family say little of what it would reach with accurate ones.
        const double more = log_of(least) - log_of(floor.error);
        excess.push_back(faithful_ && !exact ? std::min(more, most_excess) : more);
    }
    if (excess.empty()) return;
    std::sort(borrowed.begin(), borrowed.end(), [&](const Floor& a, const Floor& b) {
        const double wanted = log_of(wanted_.error);
        return std::abs(log_of(a.error) - wanted) < std::abs(log_of(b.error) - wanted);
    });
    if (borrowed.size() > most_borrowed) borrowed.resize(most_borrowed);
    for (const Floor& floor : borrowed) {
        std::vector<int> step = steps;
        for (int& last : step) --last;
        step[0] = floor.resolution;
        step[1] = floor.samples;
        errors.positions.push_back(position(step));
        errors.logarithms.push_back(log_of(floor.error) + metrics::median(excess));
        errors.doubts.push_back(borrowed_doubt);
    }
}

// The trials that succeeded.
std::vector<Knowledge::Answer> Knowledge::own_answers() const {
    std::vector<Answer> answers;
    for (std::size_t i = 0; i < records_.size(); ++i)
        if (trials_[i].failed.empty()) answers.push_back({records_[i].step, trials_[i].error});
    return answers;
}

void Knowledge::fit() {
    Values errors;
    std::vector<std::vector<double>>& positions = errors.positions;
    std::array<std::vector<double>, costs> values;
    std::vector<Answer> known = own_answers();
    const auto add = [&](const std::vector<int>& step, double error) {
        positions.push_back(position(step));
        errors.logarithms.push_back(log_of(std::max(error, wanted_.error * 1e-3)));
        errors.doubts.push_back(0.0);
    };
    for (std::size_t i = 0; i < records_.size(); ++i) {
        if (!trials_[i].failed.empty()) continue;
        // In the terms of a trial.
        add(records_[i].step, records_[i].confirmed && records_[i].failed.empty()
                                  ? records_[i].error * wanted_.trial_error / wanted_.error
                                  : trials_[i].error);
        for (std::size_t k = 0; k < costs; ++k) values[k].push_back(log_of(trials_[i].cost[k]));
    }
    if (!positions.empty())
        for (std::size_t k = 0; k < costs; ++k) cost_models_[k].fit(positions, values[k]);
    for (const Answer& answer : answers_) {
        if (measured_[lattice_.index(answer.step)]) continue;
        add(answer.step, answer.error);
        known.push_back(answer);
    }
    if (positions.empty()) return;
    add_borrowed(errors, known);
    error_model_.fit(positions, errors.logarithms, errors.doubts);
    smooth_costs();
}

// Short measurements are noisy: what the model makes of them is not.
void Knowledge::smooth_costs() {
    std::vector<Record*> unsure;
    std::vector<std::size_t> indices;
    for (Record& record : records_) {
        if (record.confirmed || !record.failed.empty()) continue;
        unsure.push_back(&record);
        indices.push_back(record.index);
    }
    const std::array<std::vector<Estimate>, costs> estimates = costs_at(indices);
    for (std::size_t i = 0; i < unsure.size(); ++i)
        for (std::size_t k = 0; k < costs; ++k)
            if (cost_noise[k] > 1.0 && !(unsure[i]->timed_again && all_costs[k] == Cost::lookup))
                unsure[i]->cost[k] = unsure[i]->upper_cost[k] = std::exp(estimates[k][i].mean);
}

// What the models say of these points. Of each cost, one estimate a point.
std::array<std::vector<Estimate>, costs> Knowledge::costs_at(std::span<const std::size_t> indices) const {
    std::array<const Model*, costs> models;
    for (std::size_t k = 0; k < costs; ++k) models[k] = &cost_models_[k];
    std::array<std::vector<Estimate>, costs> estimates;
    Model::at_all(models, flat_positions(indices), lattice_.axes(), estimates);
    return estimates;
}

std::vector<Estimate> Knowledge::errors_at(std::span<const std::size_t> indices) const {
    std::vector<Estimate> errors;
    const Model* const model = &error_model_;
    Model::at_all({&model, 1}, flat_positions(indices), lattice_.axes(), {&errors, 1});
    return errors;
}

bool Knowledge::borrowed_at(const Point& point) const {
    return std::any_of(others_.begin(), others_.end(), [&](const Floor& floor) { return floor.is_of(point.step); });
}

double Knowledge::chance_of(const Estimate& error) const {
    return normal_below((std::log(wanted_.trial_error) - error.mean) / std::hypot(error.sd, error_prior.noise));
}

double Knowledge::chance_there(std::size_t index) const {
    return chance_of(error_model_.at(position(lattice_.point(index).step)));
}

// The positions of these points, one after the other.
std::vector<double> Knowledge::flat_positions(std::span<const std::size_t> indices) const {
    std::vector<double> flat;
    flat.reserve(indices.size() * lattice_.axes());
    for (const std::size_t i : indices) {
        const std::vector<int>& step = lattice_.point(i).step;
        for (std::size_t a = 0; a < step.size(); ++a) flat.push_back(step[a] / stride_[a]);
    }
    return flat;
}

// The points that may matter: they get a chance that says nothing yet, and unknown costs; all others have none.
std::vector<std::size_t> Knowledge::candidates() {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < lattice_.size(); ++i) {
        if (measured_[i] || ruled_out_[i]) continue;
        chance_[i] = 0.0;
        if (!fine_ && !coarse_[i]) continue;
        bool dear = true;
        for (std::size_t k = 0; k < costs; ++k) dear = dear && least_[k][i] >= limits_[k];
        if (dear) continue;
        chance_[i] = 0.5;
        for (std::size_t k = 0; k < costs; ++k) estimates_[k][i] = {0.0, std::numeric_limits<double>::infinity()};
        found.push_back(i);
    }
    return found;
}

// The model does not know that errors fall along every axis: where a `better` point, one for each candidate, has nearly no
// chance, the candidate has none. Equal ones stand together.
void Knowledge::drop_hopeless(std::vector<std::size_t>& candidates, const std::vector<std::size_t>& better) {
    std::vector<std::size_t> unique = better;
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    const std::vector<Estimate> errors = errors_at(unique);
    std::size_t at = 0, kept = 0;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (unique[at] != better[c]) ++at;
        if (chance_of(errors[at]) < nearly_none)
            chance_[candidates[c]] = 0.0;
        else
            candidates[kept++] = candidates[c];
    }
    candidates.resize(kept);
}

// What others reached bounds the most accurate setting for each choice of light rays, which is the last.
void Knowledge::drop_hopeless_rays(std::vector<std::size_t>& candidates) {
    std::size_t settings = 1;  // of the family's own axes, for each choice of light rays
    for (std::size_t axis = 2; axis < lattice_.axes(); ++axis) settings *= static_cast<std::size_t>(lattice_.steps(axis));
    std::vector<std::size_t> last;
    for (const std::size_t i : candidates) last.push_back((i / settings + 1) * settings - 1);
    drop_hopeless(candidates, last);
}

// The coarse steps cut the lattice into blocks; the last point of each is its most accurate one.
void Knowledge::drop_hopeless_blocks(std::vector<std::size_t>& candidates) {
    std::vector<std::pair<std::size_t, std::size_t>> by_block;  // the last point of its block, the candidate
    for (const std::size_t i : candidates) {
        std::vector<int> last = lattice_.point(i).step;
        for (std::size_t a = 0; a < last.size(); ++a) {
            const int stride = static_cast<int>(stride_[a]);
            last[a] = std::min((last[a] + stride - 1) / stride * stride, lattice_.steps(a) - 1);
        }
        by_block.emplace_back(lattice_.index(last), i);
    }
    std::sort(by_block.begin(), by_block.end());
    std::vector<std::size_t> last;
    for (std::size_t c = 0; c < by_block.size(); ++c) {
        last.push_back(by_block[c].first);
        candidates[c] = by_block[c].second;
    }
    drop_hopeless(candidates, last);
}

void Knowledge::believe() {
    std::vector<std::size_t> open = candidates();
    const bool no_costs = std::all_of(records_.begin(), records_.end(), [](const Record& r) { return !r.failed.empty(); });
    if (open.empty() || (no_costs && answers_.empty())) return;
    if (!others_.empty()) drop_hopeless_rays(open);
    if (fine_ && lattice_.size() > small_lattice) drop_hopeless_blocks(open);
    const std::vector<Estimate> errors = errors_at(open);
    for (std::size_t p = 0; p < open.size(); ++p) chance_[open[p]] = chance_of(errors[p]);
    if (no_costs) return;
    std::erase_if(open, [&](std::size_t i) { return chance_[i] < hopeless; });
    const std::array<std::vector<Estimate>, costs> estimates = costs_at(open);
    for (std::size_t p = 0; p < open.size(); ++p) {
        const std::size_t i = open[p];
        for (std::size_t k = 0; k < costs; ++k) {
            estimates_[k][i] = estimates[k][p];
            if (std::isfinite(wanted_.at_most[k]))
                chance_[i] *= normal_below((log_of(wanted_.at_most[k]) - estimates_[k][i].mean) / (estimates_[k][i].sd + 1e-3));
        }
    }
}

}  // namespace shadowbench::recommend

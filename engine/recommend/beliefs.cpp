// What the models of a family say of its other points: see knowledge.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "recommend/knowledge.h"

namespace shadowbench::recommend {
namespace {

constexpr double least_value = 1e-12;  // values below count as this: their logarithm is modelled

constexpr std::size_t most_borrowed = 8;  // floors: each slows the model down
constexpr double most_excess = 0.5;       // of the logarithm: what filters of faithful families differ by
constexpr double borrowed_doubt = 0.2;    // of the logarithm of an error derived from a floor
constexpr double nearly_none = 0.02;
constexpr double hopeless = 1e-4;  // the costs of points with a smaller chance are not modelled

double log_of(double value) {
    return std::log(std::max(value, least_value));
}

}  // namespace

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
            if (cost_noise[k] > 1.0 && !(unsure[i]->timed_again && static_cast<Cost>(k) == Cost::lookup))
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

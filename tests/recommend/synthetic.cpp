#include "recommend/synthetic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"

namespace shadowbench::recommend::test {
namespace {

double normal(base::Random& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(2.0 * std::numbers::pi * random.uniform());
}

constexpr double seconds_of_trial = 0.1;  // apart from what grows with the map

}  // namespace

SyntheticLab::SyntheticLab(std::vector<Law> laws, Noise noise, std::uint64_t seed, std::optional<std::size_t> scout)
    : laws_(std::move(laws)), noise_(noise), seed_(seed), scout_(scout) {
    for (const Law& law : laws_) families_.push_back(law.family);
}

// Resolution steps are factors of sqrt(2) in width, sample steps factors of 2. The largest map here, 1024^2 with 64 rays
// a pixel, takes about 20 s.
double SyntheticLab::rays(const std::vector<int>& step) const {
    return 0.005 * std::exp2(static_cast<double>(step[0] + step[1] - 2));
}

double SyntheticLab::effort(const Point& point) const {
    const double captured = captured_.count({point.step[0], point.step[1]}) ? 0.0 : rays(point.step);
    return captured + 0.1 * rays(point.step) + seconds_of_trial;
}

double SyntheticLab::least_effort() const {
    return seconds_of_trial;
}

double SyntheticLab::confirm_effort(const Point& point, std::span<const Point> others) const {
    const bool shared = std::any_of(others.begin(), others.end(), [&](const Point& other) {
        return other.step[0] == point.step[0] && other.step[1] == point.step[1];
    });
    return 5.0 * ((shared ? 0.1 : 1.1) * rays(point.step) + seconds_of_trial);
}

double SyntheticLab::at_least(const Point& point, Cost cost) const {
    const Law& law = laws_[point.family];
    return cost == Cost::bytes && law.least_bytes ? law.least_bytes(point.step) : 0.0;
}

Trial SyntheticLab::measure(const Point& point) {
    const Law& law = laws_[point.family];
    seconds_ += effort(point);
    captured_.insert({point.step[0], point.step[1]});
    base::Random random(base::hash(seed_, ++trials_));
    Trial trial;
    if (law.failed) trial.failed = law.failed(point.step);
    if (!trial.failed.empty()) return trial;
    trial.error = law.error(point.step) * std::exp(noise_.error * normal(random));
    for (std::size_t k = 0; k < costs; ++k) {
        const double noise = static_cast<Cost>(k) == Cost::bytes ? 0.0 : noise_.time * normal(random);
        trial.cost[k] = cost(point, static_cast<Cost>(k)) * std::exp(noise);
    }
    return trial;
}

std::vector<std::optional<double>> SyntheticLab::time_again(std::span<const Point> points) {
    std::vector<std::optional<double>> times;
    for (const Point& point : points) {
        base::Random random(base::hash(seed_, ++timed_again_, 2));
        seconds_ += effort(point);
        times.push_back(cost(point, Cost::lookup) * std::exp(0.2 * noise_.time * normal(random)));
    }
    return times;
}

std::vector<Confirmed> SyntheticLab::confirm(std::span<const Point> points, const Confirming&) {
    std::vector<Confirmed> answers;
    for (const Point& point : points) {
        ++confirmed_;
        base::Random random(base::hash(seed_, confirmed_, 1));
        const Law& law = laws_[point.family];
        Confirmed answer;
        if (law.failed) answer.failed = law.failed(point.step);
        answer.mean_error = law.error(point.step);
        answer.error = {answer.mean_error * (1.0 - noise_.interval), upper_error(point)};
        for (std::size_t k = 0; k < costs; ++k) {
            const bool bytes = static_cast<Cost>(k) == Cost::bytes;
            const double width = bytes ? 0.0 : noise_.interval / 3.0;
            answer.cost[k] = cost(point, static_cast<Cost>(k)) * std::exp(0.5 * width * normal(random));
            answer.interval[k] = {answer.cost[k] * (1.0 - width), answer.cost[k] * (1.0 + width)};
        }
        answers.push_back(answer);
    }
    return answers;
}

double SyntheticLab::upper_error(const Point& point) const {
    return laws_[point.family].error(point.step) * (1.0 + noise_.interval);
}

double SyntheticLab::cost(const Point& point, Cost cost) const {
    return laws_[point.family].cost(point.step, cost);
}

bool SyntheticLab::fails(const Point& point) const {
    const Law& law = laws_[point.family];
    return law.failed && !law.failed(point.step).empty();
}

std::vector<Point> SyntheticLab::points() const {
    std::vector<Point> points;
    for (std::size_t f = 0; f < families_.size(); ++f) {
        Point point{f, std::vector<int>(families_[f].axes.size(), 0)};
        for (std::size_t axis = 0; axis < point.step.size();) {
            if (axis == 0) points.push_back(point);
            if (++point.step[axis] < families_[f].axes[axis].steps()) {
                axis = 0;
            } else {
                point.step[axis++] = 0;
            }
        }
    }
    return points;
}

Axis axis(const std::string& name, int steps, int stride) {
    Axis axis{name, {}, stride};
    for (int i = 0; i < steps; ++i) axis.values.push_back(std::to_string(i));
    return axis;
}

std::function<double(const std::vector<int>&)> error_law(std::vector<Term> terms, double floor) {
    return [terms = std::move(terms), floor](const std::vector<int>& step) {
        double squares = floor * floor;
        for (std::size_t i = 0; i < terms.size(); ++i) {
            const double term = terms[i].scale * std::exp(-terms[i].power * step[i]);
            squares += term * term;
        }
        return std::sqrt(squares);
    };
}

double product_law(double scale, const std::vector<double>& powers, const std::vector<int>& step) {
    double logarithm = 0.0;
    for (std::size_t i = 0; i < powers.size(); ++i) logarithm += powers[i] * step[i];
    return scale * std::exp(logarithm);
}

double lattice_effort(const std::vector<Law>& laws) {
    return sweep_effort(laws, std::numeric_limits<std::size_t>::max());
}

double sweep_effort(const std::vector<Law>& laws, std::size_t count) {
    SyntheticLab lab(laws, {}, 1);
    const std::vector<Point> points = lab.points();
    count = std::min(count, points.size());
    for (std::size_t i = 0; i < count; ++i) lab.measure(points[(2 * i + 1) * points.size() / (2 * count)]);
    return lab.seconds();
}

double cheapest(const SyntheticLab& lab, const Goal& goal, Cost cost) {
    double least = std::numeric_limits<double>::infinity();
    for (const Point& point : lab.points()) {
        if (lab.fails(point) || lab.upper_error(point) > goal.error) continue;
        bool within = true;
        for (std::size_t k = 0; k < costs; ++k) within = within && lab.cost(point, static_cast<Cost>(k)) <= goal.at_most[k];
        if (within) least = std::min(least, lab.cost(point, cost));
    }
    return least;
}

RandomCase random_case(std::uint64_t seed) {
    base::Random random(base::hash(seed, 0x5eed));
    const Axis resolution = axis("resolution", 7 + static_cast<int>(random.below(4)), 2);
    const Axis samples = axis("samples", 4 + static_cast<int>(random.below(4)), 2);
    RandomCase result;
    const std::size_t techniques = 2 + random.below(5);
    const double rays_error = random.uniform(0.1, 0.5), rays_power = random.uniform(0.2, 0.5) * std::numbers::ln2;
    for (std::size_t t = 0; t < techniques; ++t) {
        Law law;
        law.family = {"t" + std::to_string(t), "t" + std::to_string(t), {resolution, samples}};
        std::vector<Term> terms{{random.uniform(0.05, 0.5), random.uniform(0.15, 0.45)},
                                {rays_error * random.uniform(0.7, 1.0), rays_power}};
        std::array<std::vector<double>, costs> powers;
        std::array<double, costs> scale{random.uniform(5.0, 20.0), random.uniform(500.0, 4000.0), random.uniform(1.0, 4.0)};
        // Bytes and build time grow with the area, lookups hardly; samples matter to the build, or to all.
        const bool filtered = random.uniform() < 0.5;
        powers[0] = {random.uniform(0.0, 0.15), filtered ? 0.0 : random.uniform(0.0, 0.4)};
        powers[1] = {std::numbers::ln2, filtered ? random.uniform(0.0, 0.05) : random.uniform(0.2, 0.7)};
        powers[2] = {std::numbers::ln2, random.uniform(0.5, 0.7)};
        const std::size_t own = random.below(3);
        for (std::size_t i = 0; i < own; ++i) {
            law.family.axes.push_back(axis("own" + std::to_string(i), 4 + static_cast<int>(random.below(8)), 2));
            terms.push_back({random.uniform(0.05, 0.5), random.uniform(0.2, 0.5)});
            powers[0].push_back(random.uniform(0.0, 0.3));
            powers[1].push_back(random.uniform(0.1, 0.4));
            powers[2].push_back(random.uniform(0.0, 0.3));
        }
        law.error = error_law(terms, random.uniform() < 0.3 ? random.uniform(0.005, 0.05) : 0.0);
        law.cost = [powers, scale](const std::vector<int>& step, Cost cost) {
            const std::size_t k = static_cast<std::size_t>(cost);
            return product_law(scale[k], powers[k], step);
        };
        result.laws.push_back(std::move(law));
    }
    const SyntheticLab lab(result.laws, {}, 1);
    const std::vector<Point> points = lab.points();
    result.error = 1.05 * lab.upper_error(points[random.below(points.size())]);
    return result;
}

}  // namespace shadowbench::recommend::test

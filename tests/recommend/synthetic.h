// Techniques that are laws: their errors and costs are known functions of the steps, so that the best setting is known.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "recommend/exploration.h"
#include "recommend/lab.h"

namespace shadowbench::recommend::test {

struct Law {
    Family family;
    std::function<double(const std::vector<int>&)> error;
    std::function<double(const std::vector<int>&, Cost)> cost;
    std::function<std::string(const std::vector<int>&)> failed;  // empty: it never fails
    std::function<double(const std::vector<int>&)> least_bytes;  // known without measuring; empty: nothing is
};

struct Noise {
    double time = 0.0;      // standard deviation of the logarithm of a trial's times; of those timed again a fifth
    double error = 0.0;     // of a trial's error
    double interval = 0.0;  // half the width of confirmed intervals, as a share; times are confirmed to within a third
};

class SyntheticLab : public Lab {
public:
    SyntheticLab(std::vector<Law> laws, Noise noise, std::uint64_t seed, std::optional<std::size_t> scout = {});

    std::span<const Family> families() const override { return families_; }
    std::optional<std::size_t> scout() const override { return scout_; }
    double effort(const Point& point) const override;
    double least_effort() const override;
    double confirm_effort(const Point& point, std::span<const Point> others) const override;
    double at_least(const Point& point, Cost cost) const override;
    Trial measure(const Point& point) override;
    std::vector<std::optional<double>> time_again(std::span<const Point> points) override;
    std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) override;

    // What the answer rests on: errors without noise, with the upper end of their interval.
    double upper_error(const Point& point) const;
    double cost(const Point& point, Cost cost) const;
    bool fails(const Point& point) const;

    std::vector<Point> points() const;  // of all families
    double seconds() const { return seconds_; }
    std::size_t trials() const { return trials_; }
    std::size_t confirmed() const { return confirmed_; }

private:
    double rays(const std::vector<int>& step) const;

    std::vector<Law> laws_;
    std::vector<Family> families_;
    Noise noise_;
    std::uint64_t seed_;
    std::optional<std::size_t> scout_;
    std::set<std::pair<int, int>> captured_;
    double seconds_ = 0.0;
    std::size_t trials_ = 0, confirmed_ = 0, timed_again_ = 0;
};

Axis axis(const std::string& name, int steps, int stride);

// error^2 = floor^2 + sum of (scale_i ratio_i^-(power_i step_i))^2; cost = scale * product of ratio_i^(power_i step_i).
struct Term {
    double scale, power;  // the power is per step, as a logarithm
};
std::function<double(const std::vector<int>&)> error_law(std::vector<Term> terms, double floor);
double product_law(double scale, const std::vector<double>& powers, const std::vector<int>& step);

// Seconds that measuring all points would take: all light rays once, and every trial.
double lattice_effort(const std::vector<Law>& laws);
// Seconds of a sweep over `count` points spread evenly over all points.
double sweep_effort(const std::vector<Law>& laws, std::size_t count);

// The least cost of all points that are acceptable; infinite if there are none.
double cheapest(const SyntheticLab& lab, const Goal& goal, Cost cost);

// Several techniques with random laws over the same resolutions and samples, and an error that some of them reach.
struct RandomCase {
    std::vector<Law> laws;
    double error;
};
RandomCase random_case(std::uint64_t seed);

}  // namespace shadowbench::recommend::test

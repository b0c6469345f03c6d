// Kriging: a smooth function of a family's steps through noisy values (Gaussian process regression: Rasmussen and
// Williams 2006, algorithm 2.1; a linear trend with uncertain slopes as in their section 2.7).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace shadowbench::recommend {

// Of a quantity's logarithm, before anything is measured. Lengths are in coarse steps.
struct Prior {
    double slope;     // along every axis
    double slope_sd;  // how far a slope may be off
    double noise;     // the most that the standard deviation of one measurement may be
};

struct Estimate {
    double mean = 0.0;
    double sd = 0.0;  // of the function, without the noise of a measurement
};

class Model {
public:
    explicit Model(Prior prior) : prior_(prior) {}

    // One position and one value a measurement; at least one. `doubts`: standard deviations of the values besides the
    // noise, one each, or none. How far the function bends away from its trend, and
    // how much noise there is, are chosen from the values by their likelihood.
    void fit(const std::vector<std::vector<double>>& positions, std::span<const double> values,
             std::span<const double> doubts = {});
    Estimate at(std::span<const double> position) const;
    // The estimates of models of the same positions at many points: out[m][p] is that of model m at point p, whose
    // coordinates are from p * axes on. On several threads.
    static void at_all(std::span<const Model* const> models, std::span<const double> points, std::size_t axes,
                       std::span<std::vector<Estimate>> out);

private:
    // What the covariances of some points with one position are made of. They are estimated side by side.
    static constexpr std::size_t side_by_side = 8;
    using Lanes = std::array<double, side_by_side>;
    struct Relation {
        Lanes product, correlation;
    };
    struct Covariance {
        double trend, correlation;
        double with(double bend) const { return trend + bend * bend * correlation; }
    };
    Covariance covariance(std::span<const double> a, std::span<const double> b) const;
    double trend(std::span<const double> position) const;
    void at_some(const std::vector<Relation>& relations, const Lanes& sums, const Lanes& squares, Lanes& mean,
                 Lanes& variance) const;
    double factorise();  // logarithm of the likelihood, but for a constant

    Prior prior_;
    double bend_ = 0.0, noise_ = 0.0;  // standard deviations
    double level_ = 0.0;
    std::vector<std::vector<double>> positions_;
    std::vector<Covariance> covariances_;  // of the positions, lower, row by row
    std::vector<double> residuals_;  // from the trend
    std::vector<double> doubts_;     // variances, one a value
    std::vector<double> factor_;     // Cholesky factor, lower, row by row
    std::vector<double> weights_;
};

}  // namespace shadowbench::recommend

#include "recommend/model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace shadowbench::recommend {
namespace {

constexpr double level_sd = 2.0;
constexpr double range = 3.0;                                // how far a bend reaches, coarse steps
constexpr double bends[] = {0.05, 0.1, 0.2, 0.4, 0.8, 1.6};  // those tried
constexpr double noises[] = {1.0, 0.25};                     // likewise, as shares of the most

// Matern's correlation of smoothness 5/2.
double correlation(double distance) {
    const double r = std::sqrt(5.0) * distance / range;
    return (1.0 + r + r * r / 3.0) * std::exp(-r);
}

}  // namespace

Model::Covariance Model::covariance(std::span<const double> a, std::span<const double> b) const {
    double squares = 0.0, product = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        squares += (a[i] - b[i]) * (a[i] - b[i]);
        product += a[i] * b[i];
    }
    return {level_sd * level_sd + prior_.slope_sd * prior_.slope_sd * product, correlation(std::sqrt(squares))};
}

double Model::trend(std::span<const double> position) const {
    return level_ + prior_.slope * std::accumulate(position.begin(), position.end(), 0.0);
}

double Model::factorise() {
    const std::size_t n = positions_.size();
    factor_.assign(n * n, 0.0);
    double likelihood = 0.0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = covariances_[i * n + j].with(bend_);
            for (std::size_t k = 0; k < j; ++k) sum -= factor_[i * n + k] * factor_[j * n + k];
            if (i != j) {
                factor_[i * n + j] = sum / factor_[j * n + j];
            } else {
                factor_[i * n + i] = std::sqrt(std::max(sum, 0.0) + noise_ * noise_ + doubts_[i]);
                likelihood -= std::log(factor_[i * n + i]);
            }
        }
    weights_ = residuals_;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) weights_[i] -= factor_[i * n + k] * weights_[k];
        weights_[i] /= factor_[i * n + i];
        likelihood -= 0.5 * weights_[i] * weights_[i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) weights_[i] -= factor_[k * n + i] * weights_[k];
        weights_[i] /= factor_[i * n + i];
    }
    return likelihood;
}

void Model::fit(const std::vector<std::vector<double>>& positions, std::span<const double> values,
                std::span<const double> doubts) {
    positions_ = positions;
    doubts_.assign(values.size(), 0.0);
    for (std::size_t i = 0; i < doubts.size(); ++i) doubts_[i] = doubts[i] * doubts[i];
    level_ = 0.0;
    double mean = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double weight = 1.0 / (1.0 + doubts_[i] / (prior_.noise * prior_.noise));
        mean += weight * (values[i] - trend(positions_[i]));
        weights += weight;
    }
    level_ = mean / weights;
    residuals_.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) residuals_[i] = values[i] - trend(positions_[i]);
    const std::size_t n = positions_.size();
    covariances_.resize(n * n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) covariances_[i * n + j] = covariance(positions_[i], positions_[j]);
    double best = -std::numeric_limits<double>::infinity(), bend = bends[0], noise = prior_.noise;
    for (const double share : noises)
        for (const double tried : bends) {
            bend_ = tried;
            noise_ = share * prior_.noise;
            // A weak belief in bends of about 0.3, for the first few values.
            const double belief = std::log(bend_ / 0.3);
            const double likelihood = factorise() - 0.5 * belief * belief;
            if (likelihood <= best) continue;
            best = likelihood;
            bend = bend_;
            noise = noise_;
        }
    bend_ = bend;
    noise_ = noise;
    factorise();
}

Estimate Model::at(std::span<const double> position) const {
    const std::size_t n = positions_.size();
    Estimate estimate{trend(position), 0.0};
    std::vector<double> half(n);
    double variance = covariance(position, position).with(bend_);
    for (std::size_t i = 0; i < n; ++i) {
        half[i] = covariance(position, positions_[i]).with(bend_);
        estimate.mean += half[i] * weights_[i];
        for (std::size_t k = 0; k < i; ++k) half[i] -= factor_[i * n + k] * half[k];
        half[i] /= factor_[i * n + i];
        variance -= half[i] * half[i];
    }
    estimate.sd = std::sqrt(std::max(variance, 0.0));
    return estimate;
}

}  // namespace shadowbench::recommend

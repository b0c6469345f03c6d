#include "recommend/model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "base/parallel.h"

namespace shadowbench::recommend {
namespace {

constexpr double level_sd = 2.0;
constexpr double range = 3.0;                                // how far a bend reaches, coarse steps
constexpr double bends[] = {0.05, 0.1, 0.2, 0.4, 0.8, 1.6};  // those tried
constexpr double noises[] = {1.0, 0.25};                     // likewise, as shares of the most

constexpr std::size_t chunk = 32;  // blocks of points that a thread takes at once

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
    std::vector<Estimate> estimate;
    const Model* const self = this;
    at_all({&self, 1}, position, position.size(), {&estimate, 1});
    return estimate.front();
}

// `sums` of the coordinates of each point, and of their squares.
void Model::at_some(const std::vector<Relation>& relations, const Lanes& sums, const Lanes& squares, Lanes& mean,
                    Lanes& variance) const {
    const std::size_t n = positions_.size();
    const double level = level_sd * level_sd, slope = prior_.slope_sd * prior_.slope_sd, bend = bend_ * bend_;
    for (std::size_t p = 0; p < side_by_side; ++p) {
        mean[p] = level_ + prior_.slope * sums[p];
        variance[p] = level + slope * squares[p] + bend;
    }
    std::vector<Lanes> half(n);
    for (std::size_t i = 0; i < n; ++i) {
        Lanes sum;
        for (std::size_t p = 0; p < side_by_side; ++p) {
            sum[p] = level + slope * relations[i].product[p] + bend * relations[i].correlation[p];
            mean[p] += sum[p] * weights_[i];
        }
        for (std::size_t k = 0; k < i; ++k) {
            const double factor = factor_[i * n + k];
            for (std::size_t p = 0; p < side_by_side; ++p) sum[p] -= factor * half[k][p];
        }
        const double pivot = factor_[i * n + i];
        for (std::size_t p = 0; p < side_by_side; ++p) {
            half[i][p] = sum[p] / pivot;
            variance[p] -= half[i][p] * half[i][p];
        }
    }
}

void Model::at_all(std::span<const Model* const> models, std::span<const double> points, std::size_t axes,
                   std::span<std::vector<Estimate>> out) {
    const std::size_t count = points.size() / axes;
    for (std::vector<Estimate>& estimates : out) estimates.resize(count);
    const std::vector<std::vector<double>>& positions = models.front()->positions_;
    const auto estimate = [&](std::size_t block) {
        const std::size_t first = block * side_by_side, used = std::min(side_by_side, count - first);
        std::vector<Lanes> at(axes);  // lanes beyond those used repeat the first point
        Lanes sums{}, squares{}, mean, variance;
        for (std::size_t p = 0; p < side_by_side; ++p)
            for (std::size_t a = 0; a < axes; ++a) {
                at[a][p] = points[(first + (p < used ? p : 0)) * axes + a];
                sums[p] += at[a][p];
                squares[p] += at[a][p] * at[a][p];
            }
        std::vector<Relation> relations(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            Lanes product{}, distance{};
            for (std::size_t a = 0; a < axes; ++a) {
                const double of = positions[i][a];
                for (std::size_t p = 0; p < side_by_side; ++p) {
                    product[p] += at[a][p] * of;
                    distance[p] += (at[a][p] - of) * (at[a][p] - of);
                }
            }
            relations[i].product = product;
            for (std::size_t p = 0; p < side_by_side; ++p)
                relations[i].correlation[p] = correlation(std::sqrt(distance[p]));
        }
        for (std::size_t m = 0; m < models.size(); ++m) {
            models[m]->at_some(relations, sums, squares, mean, variance);
            for (std::size_t p = 0; p < used; ++p)
                out[m][first + p] = {mean[p], std::sqrt(std::max(variance[p], 0.0))};
        }
    };
    const std::size_t blocks = (count + side_by_side - 1) / side_by_side, chunks = (blocks + chunk - 1) / chunk;
    if (chunks <= 1) {
        for (std::size_t block = 0; block < blocks; ++block) estimate(block);
        return;
    }
    base::parallel_for(chunks, [&](std::size_t c) {
        for (std::size_t block = c * chunk; block < std::min((c + 1) * chunk, blocks); ++block) estimate(block);
    });
}

}  // namespace shadowbench::recommend

// How a number grows over a setting, measured with one or more seeds of the light rays.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "claims/value.h"

namespace shadowbench::claims {

class Growth {
public:
    // Values of one x follow each other, in the order of their seeds.
    void add(double x, double value);

    std::size_t size() const { return x_.size(); }
    double x(std::size_t i) const { return x_[i]; }
    Value at(std::size_t i) const;  // the mean over seeds, with its interval; exact for one seed
    std::vector<std::pair<double, double>> means() const;

    // Of the power law through the means: fitted_exponent(). Different x have different rays, so what a seed changes
    // makes the means leave the law, and is in this interval too.
    Value exponent() const;
    // The mean over seeds of each seed's exponent, over the x that have all seeds; there must be at least two of both.
    Value exponent_over_seeds() const;
    std::size_t with_all_seeds() const;  // the number of these x, which come first

private:
    std::vector<double> x_;
    std::vector<std::vector<double>> values_;  // [x][seed]
};

}  // namespace shadowbench::claims

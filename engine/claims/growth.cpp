#include "claims/growth.h"

#include "claims/fit.h"
#include "claims/intervals.h"

namespace shadowbench::claims {

void Growth::add(double x, double value) {
    if (x_.empty() || x_.back() != x) {
        x_.push_back(x);
        values_.emplace_back();
    }
    values_.back().push_back(value);
}

Value Growth::at(std::size_t i) const {
    return values_[i].size() > 1 ? mean_of(values_[i]) : exactly(values_[i].front());
}

std::vector<std::pair<double, double>> Growth::means() const {
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < size(); ++i) points.emplace_back(x_[i], at(i).value);
    return points;
}

Value Growth::exponent() const {
    return fitted_exponent(means());
}

std::size_t Growth::with_all_seeds() const {
    std::size_t count = 0;
    while (count < size() && values_[count].size() == values_.front().size()) ++count;
    return count;
}

Value Growth::exponent_over_seeds() const {
    std::vector<double> exponents;
    for (std::size_t seed = 0; seed < values_.front().size(); ++seed) {
        std::vector<std::pair<double, double>> points;
        for (std::size_t i = 0; i < with_all_seeds(); ++i) points.emplace_back(x_[i], values_[i][seed]);
        exponents.push_back(fit_power(points).exponent);
    }
    return mean_of(exponents);
}

}  // namespace shadowbench::claims

// Fits of laws to measured points.
#pragma once

#include <span>
#include <utility>

namespace shadowbench::claims {

// Fits a power law by least squares: log y = log c + exponent * log x over points with x, y > 0. Needs at least two
// different x.
struct PowerLaw {
    double exponent, factor;
    double standard_error;  // of the exponent; 0 for two points
};
PowerLaw fit_power(std::span<const std::pair<double, double>> points);

}  // namespace shadowbench::claims

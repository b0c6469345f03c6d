#include "claims/fit.h"

#include <cmath>

namespace shadowbench::claims {

PowerLaw fit_power(std::span<const std::pair<double, double>> points) {
    const double n = static_cast<double>(points.size());
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (const auto& [x, y] : points) {
        const double u = std::log(x), v = std::log(y);
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    const double spread = sxx - sx * sx / n;
    PowerLaw law{(sxy - sx * sy / n) / spread, 0.0, 0.0};
    const double offset = (sy - law.exponent * sx) / n;
    law.factor = std::exp(offset);
    double residuals = 0.0;
    for (const auto& [x, y] : points) {
        const double r = std::log(y) - offset - law.exponent * std::log(x);
        residuals += r * r;
    }
    if (n > 2.0) law.standard_error = std::sqrt(residuals / (n - 2.0) / spread);
    return law;
}

}  // namespace shadowbench::claims

#include "claims/profile.h"

#include <cstddef>

namespace shadowbench::claims {

double first_reached(std::span<const double> values, double level) {
    for (std::size_t i = 1; i < values.size(); ++i)
        if (values[i] >= level)
            return static_cast<double>(i - 1) + (level - values[i - 1]) / (values[i] - values[i - 1]);
    return static_cast<double>(values.size());
}

}  // namespace shadowbench::claims

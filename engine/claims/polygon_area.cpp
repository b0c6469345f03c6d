#include "claims/polygon_area.h"

#include <cmath>

namespace shadowbench::claims {
namespace {

// The part where sign * (p[axis] - limit) <= 0.
Polygon cut(const Polygon& polygon, std::size_t axis, double limit, double sign) {
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double of_a = sign * (a[axis] - limit), of_b = sign * (b[axis] - limit);
        if (of_a <= 0.0) part.push_back(a);
        if ((of_a < 0.0 && of_b > 0.0) || (of_a > 0.0 && of_b < 0.0)) {
            const double share = of_a / (of_a - of_b);
            part.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])});
        }
    }
    return part;
}

}  // namespace

double area_inside(const Polygon& polygon, double x, double y) {
    Polygon part = cut(polygon, 0, x, -1.0);
    part = cut(part, 0, x + 1.0, 1.0);
    part = cut(part, 1, y, -1.0);
    part = cut(part, 1, y + 1.0, 1.0);
    double twice = 0.0;
    for (std::size_t i = 0; i < part.size(); ++i) {  // about (x, y): small numbers
        const auto &a = part[i], &b = part[(i + 1) % part.size()];
        twice += (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
    }
    return 0.5 * std::abs(twice);
}

}  // namespace shadowbench::claims

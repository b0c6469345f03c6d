#include "metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

#include "base/compensated.h"
#include "base/parallel.h"
#include "metrics/flip_colour.h"

namespace shadowbench::metrics {
namespace {

constexpr double pi = std::numbers::pi;

using Plane = std::vector<float>;
using Kernel = std::vector<double>;  // 2 radius + 1 weights

struct Size {
    int width, height;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

void for_each_row(const Size& size, const std::function<void(int)>& body) {
    base::parallel_for(static_cast<std::size_t>(size.height), [&](std::size_t y) { body(static_cast<int>(y)); });
}

Plane filter_rows(const Plane& in, const Size& size, const Kernel& kernel) {
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane out(in.size());
    for_each_row(size, [&](int y) {
        const float* row = in.data() + static_cast<std::size_t>(y) * size.width;
        for (int x = 0; x < size.width; ++x) {
            double sum = 0.0;
            for (int k = -radius; k <= radius; ++k)
                sum += kernel[k + radius] * row[std::clamp(x + k, 0, size.width - 1)];
            out[static_cast<std::size_t>(y) * size.width + x] = static_cast<float>(sum);
        }
    });
    return out;
}

Plane filter_columns(const Plane& in, const Size& size, const Kernel& kernel) {
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane out(in.size());
    for_each_row(size, [&](int y) {
        std::vector<double> sum(static_cast<std::size_t>(size.width), 0.0);
        for (int k = -radius; k <= radius; ++k) {
            const float* row = in.data() + static_cast<std::size_t>(std::clamp(y + k, 0, size.height - 1)) * size.width;
            for (int x = 0; x < size.width; ++x) sum[x] += kernel[k + radius] * row[x];
        }
        for (int x = 0; x < size.width; ++x)
            out[static_cast<std::size_t>(y) * size.width + x] = static_cast<float>(sum[x]);
    });
    return out;
}

Kernel gaussian(int radius, double exponent) {  // exp(-exponent * x^2), not normalised
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-exponent * x * x));
    return kernel;
}

double sum_of(const Kernel& kernel) {
    double sum = 0.0;
    for (const double w : kernel) sum += w;
    return sum;
}

// Positive weights scaled to sum to 1, negative ones to -1.
Kernel normalised(Kernel kernel) {
    double positive = 0.0, negative = 0.0;
    for (const double w : kernel) (w > 0.0 ? positive : negative) += std::abs(w);
    for (double& w : kernel) w /= w > 0.0 ? positive : negative > 0.0 ? negative : 1.0;
    return kernel;
}

// --- colour pipeline -------------------------------------------------------------------------------------------------

// Contrast sensitivity as a sum of Gaussians a sqrt(pi / b) exp(-(pi x)^2 / b), x in degrees
// (spatial filtering; the constants are fits to those of Johnson and Fairchild).
struct Term {
    double a, b;
};
constexpr Term achromatic{1.0, 0.0047}, red_green{1.0, 0.0053}, blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

// Radius of all filters: three standard deviations of the widest one.
int csf_radius(double pixels_per_degree) {
    return static_cast<int>(std::ceil(3.0 * std::sqrt(blue_yellow[0].b / (2.0 * pi * pi)) * pixels_per_degree));
}

Kernel csf(const Term& term, double pixels_per_degree) {
    return gaussian(csf_radius(pixels_per_degree), pi * pi / (term.b * pixels_per_degree * pixels_per_degree));
}

Plane blur(const Plane& in, const Size& size, const Kernel& kernel) {
    const Kernel unit = normalised(kernel);
    return filter_columns(filter_rows(in, size, unit), size, unit);
}

Plane blur_blue_yellow(const Plane& in, const Size& size, double pixels_per_degree) {
    double weight[2];
    Plane part[2];
    for (int i = 0; i < 2; ++i) {
        const Kernel kernel = csf(blue_yellow[i], pixels_per_degree);
        const double sum = sum_of(kernel);
        weight[i] = blue_yellow[i].a * std::sqrt(pi / blue_yellow[i].b) * sum * sum;
        part[i] = blur(in, size, kernel);
    }
    const double all = weight[0] + weight[1];
    for (std::size_t p = 0; p < in.size(); ++p)
        part[0][p] = static_cast<float>((weight[0] * part[0][p] + weight[1] * part[1][p]) / all);
    return part[0];
}

double unit(double value) {
    return value > 0.0 ? std::min(value, 1.0) : 0.0;  // NaN: 0
}

struct Opponent {
    Plane channel[3];
};

Opponent to_opponent(std::span<const float> rgb, const Size& size) {
    Opponent result;
    for (Plane& plane : result.channel) plane.resize(size.pixels());
    for (std::size_t p = 0; p < size.pixels(); ++p) {
        const Triple value = ycxcz({unit(rgb[3 * p]), unit(rgb[3 * p + 1]), unit(rgb[3 * p + 2])});
        for (int c = 0; c < 3; ++c) result.channel[c][p] = static_cast<float>(value[c]);
    }
    return result;
}

Opponent blurred(const Opponent& picture, const Size& size, double pixels_per_degree) {
    return {blur(picture.channel[0], size, csf(achromatic, pixels_per_degree)),
            blur(picture.channel[1], size, csf(red_green, pixels_per_degree)),
            blur_blue_yellow(picture.channel[2], size, pixels_per_degree)};
}

Triple seen_colour(const Opponent& picture, std::size_t p) {
    Triple rgb = rgb_of_ycxcz({picture.channel[0][p], picture.channel[1][p], picture.channel[2][p]});
    for (double& c : rgb) c = unit(c);
    return hunt_lab(rgb);
}

// Error redistribution: takes the power 0.7 of the distance, maps the first 0.4 of its range to [0, 0.95] and the rest
// to [0.95, 1].
double spread_error(double distance) {
    constexpr double power = 0.7, knee = 0.4, at_knee = 0.95;
    static const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), power);
    const double e = std::pow(distance, power), knee_error = knee * largest;
    if (e < knee_error) return at_knee * e / knee_error;
    return std::min(at_knee + (1.0 - at_knee) * (e - knee_error) / (largest - knee_error), 1.0);
}

// --- feature pipeline ------------------------------------------------------------------------------------------------

// First (edges) and second (points) derivatives of a Gaussian in x and y, of Y scaled to [0, 1].
struct Features {
    Plane edge, point;  // magnitudes
};

Plane magnitude(const Plane& x, const Plane& y) {
    Plane result(x.size());
    for (std::size_t p = 0; p < x.size(); ++p) result[p] = std::hypot(x[p], y[p]);
    return result;
}

Features detect(const Plane& opponent_y, const Size& size, double pixels_per_degree) {
    constexpr double width = 0.082;  // degrees from the detector's peak to its trough, two standard deviations
    const double sigma = 0.5 * width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const Kernel bell = gaussian(radius, 0.5 / (sigma * sigma));
    Kernel slope = bell, bend = bell;
    for (int x = -radius; x <= radius; ++x) {
        slope[x + radius] *= -x;
        bend[x + radius] *= x * x / (sigma * sigma) - 1.0;
    }
    const Kernel across = normalised(bell);
    slope = normalised(slope);
    bend = normalised(bend);
    Plane y(opponent_y.size());
    for (std::size_t p = 0; p < y.size(); ++p) y[p] = (opponent_y[p] + 16.0f) / 116.0f;
    const Plane smooth_x = filter_rows(y, size, across), smooth_y = filter_columns(y, size, across);
    return {magnitude(filter_rows(smooth_y, size, slope), filter_columns(smooth_x, size, slope)),
            magnitude(filter_rows(smooth_y, size, bend), filter_columns(smooth_x, size, bend))};
}

double feature_difference(const Features& a, const Features& b, std::size_t p) {
    const double edge = std::abs(a.edge[p] - b.edge[p]), point = std::abs(a.point[p] - b.point[p]);
    return std::min(std::sqrt(std::max(edge, point) / std::numbers::sqrt2), 1.0);
}

void pool(Flip& result) {
    if (result.map.empty()) return;
    base::CompensatedSum total;
    for (const float d : result.map) total.add(d);
    result.mean = total.value() / static_cast<double>(result.map.size());
    std::vector<float> sorted = result.map;
    std::sort(sorted.begin(), sorted.end());
    result.max = sorted.back();
    double below = 0.0;
    for (const float d : sorted) {
        below += d;
        result.weighted_median = d;
        if (below >= 0.5 * total.value()) break;
    }
}

}  // namespace

Flip flip(std::span<const float> reference, std::span<const float> test, int width, int height,
          double pixels_per_degree) {
    const Size size{width, height};
    const Opponent sharp_reference = to_opponent(reference, size), sharp_test = to_opponent(test, size);
    const Features reference_features = detect(sharp_reference.channel[0], size, pixels_per_degree);
    const Features test_features = detect(sharp_test.channel[0], size, pixels_per_degree);
    const Opponent seen_reference = blurred(sharp_reference, size, pixels_per_degree);
    const Opponent seen_test = blurred(sharp_test, size, pixels_per_degree);
    Flip result;
    result.map.resize(size.pixels());
    for_each_row(size, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t p = static_cast<std::size_t>(y) * width + x;
            const double colour = spread_error(hyab(seen_colour(seen_reference, p), seen_colour(seen_test, p)));
            result.map[p] =
                static_cast<float>(std::pow(colour, 1.0 - feature_difference(reference_features, test_features, p)));
        }
    });
    pool(result);
    return result;
}

}  // namespace shadowbench::metrics

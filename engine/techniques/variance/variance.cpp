// Variance shadow maps: Donnelly and Lauritzen, Variance Shadow Maps, 2006.
//
// A texel holds the first two moments, E(c) and E(c^2), of the depth c at which light is absorbed. Moments can be
// averaged over any footprint, and then Chebyshev's inequality (section 4, equation 5) bounds the light that passes a
// depth:
//   P(c >= t) <= variance / (variance + (t - mean)^2)   for t > mean, and 1 before.
// The answer is this bound. It is exact if all light is absorbed at one depth, or at two and the query is at the deeper
// one; elsewhere it is too light, which is the method's light bleeding, and never darker than the truth.
//
// The paper's surfaces are opaque. Here a ray's light is absorbed in parts: a surface absorbs its opacity of what
// arrives, at its depth; a medium absorbs along its depths; light that passes everything is absorbed at the far end.
// P(c >= t) is then the transmittance up to t, and opaque surfaces give the paper's own moments, with its cleared depth
// as the far end.
//
// c is -1 at the map's first depth, 0 at its last and 1 at the far end, which stands for all receivers behind the last
// depth. So squares stay below 1, and the difference E(c^2) - E(c)^2 keeps as many digits as a float allows.
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "curves/composite.h"
#include "techniques/store/texel_map.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"min_variance", ParameterKind::number,
     "least variance of a footprint, in squares of the map's range of depths; hides the rounding of the moments, 1e-7, "
     "and blurs each step by about its root",
     1e-6, 0, 1},
    filter_parameter,
    averaged_cells_parameter,
};

constexpr double far_end = 1.0;

struct Moments {
    double first = 0.0, second = 0.0;

    // Adds `taken`, the light absorbed at one depth, c = at.
    void add(double taken, double at) {
        first += taken * at;
        second += taken * at * at;
    }

    // Adds `taken`, the light absorbed from a to b by a constant extinction of optical depth `depth`: the moments of a
    // truncated exponential. With s the share of the way, and the light falling as exp(-depth s), E(s) = 1/depth -
    // 1/(exp(depth) - 1) and E(s^2) = 2/depth^2 - (1 + 2/depth)/(exp(depth) - 1); for thin media their series.
    void add(double taken, double a, double b, double depth) {
        double s = 0.5 - depth / 12.0, s2 = 1.0 / 3.0 - depth / 12.0 + depth * depth / 360.0;
        if (depth > 1e-3) {
            const double rest = 1.0 / std::expm1(depth);
            s = 1.0 / depth - rest;
            s2 = 2.0 / (depth * depth) - (1.0 + 2.0 / depth) * rest;
        }
        const double length = b - a;
        first += taken * (a + length * s);
        second += taken * (a * a + 2.0 * a * length * s + length * length * s2);
    }
};

// Chebyshev's bound for E(c) and E(c^2), floats or doubles.
template <class Value>
double variance_of(const Value* texel, double least) {
    const double mean = texel[0];
    return std::max(static_cast<double>(texel[1]) - mean * mean, least);
}

class Variance final : public TexelMap<Variance> {
public:
    explicit Variance(const ParameterValues& values) : TexelMap(values), least_(values.number("min_variance")) {}
    static int floats_a_texel(const ParameterValues&) { return 2; }

    static constexpr bool sums_rays = true;
    void fill(const rays::LightRays& rays) {
        const std::size_t count = rays_a_texel(rays);
        std::vector<curves::Node> nodes;
        curves::OpenMedia open;
        for_each_texel(rays, [&](float* texel, std::size_t, std::size_t first) {
            Moments sum;
            for (std::size_t ray = first; ray < first + count; ++ray) add_ray(rays, ray, open, nodes, sum);
            texel[0] = static_cast<float>(sum.first / static_cast<double>(count));
            texel[1] = static_cast<float>(sum.second / static_cast<double>(count));
        });
        scratch_.add(nodes.capacity() * sizeof(curves::Node) + open.bytes());
    }

    static constexpr int filtered_floats = 2;
    float prepare(float z) const { return static_cast<float>(z > layout_.z_max ? far_end : place(z)); }
    template <class Value>
    float evaluate(const Value* texel, float t) const {
        const double beyond = t - static_cast<double>(texel[0]);
        if (!(beyond > 0.0)) return 1.0f;
        const double variance = variance_of(texel, least_);
        return static_cast<float>(variance / (variance + beyond * beyond));
    }

    int nodes_of(const float* texel) const { return texel[0] == 1.0f ? 0 : 2; }
    // At t = mean + deviation * tan(angle) the bound is cos(angle)^2, so equal angles sample it evenly.
    static constexpr int most_own_depths = 67;
    int own_depths(const float* texel, float* out) const {
        const double deviation = std::sqrt(variance_of(texel, least_));
        const double range = static_cast<double>(layout_.z_max) - layout_.z_min;
        int count = 0;
        out[count++] = layout_.z_min;
        for (int i = 0; i < 64; ++i) {
            const double t = texel[0] + deviation * std::tan(i * (0.5 * std::numbers::pi / 64));
            if (t < 0.0) out[count++] = std::max(static_cast<float>(layout_.z_max + t * range), layout_.z_min);
        }
        out[count++] = layout_.z_max;
        out[count++] = std::nextafter(layout_.z_max, std::numeric_limits<float>::infinity());
        return count;
    }

private:
    // c of a depth up to the last one: in [-1, 0], rising with it.
    double place(double z) const {
        if (!(z > layout_.z_min)) return -1.0;
        if (z >= layout_.z_max) return 0.0;
        return (z - layout_.z_min) / (static_cast<double>(layout_.z_max) - layout_.z_min) - 1.0;
    }

    void add_ray(const rays::LightRays& rays, std::size_t ray, curves::OpenMedia& open,
                 std::vector<curves::Node>& nodes, Moments& sum) const {
        double left = 1.0;
        if (layout_.media) {
            curves::composite(rays, ray, 0, open, nodes);
            for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
                const curves::Node &from = nodes[i], &to = nodes[i + 1];
                if (from.z == to.z)
                    sum.add(from.value - to.value, place(from.z));
                else
                    sum.add(from.value - to.value, place(from.z), place(to.z),
                            std::log(from.value / std::max(to.value, 1e-300)));
            }
            if (!nodes.empty()) left = nodes.back().value;
        } else {
            for (std::uint32_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s) {
                sum.add(left * (1.0 - rays.transmittance[s]), place(rays.z_front[s]));
                left *= rays.transmittance[s];
            }
        }
        sum.add(left, far_end);
    }

    double least_;
};

// Behind everything, a distribution on [-1, 0] with a part at 1 is off by at most r / (1 + r), where r is the largest
// ratio of its variance to its squared distance from the far end: 1/8, at a mean of -1/3; or the least variance, at a
// mean of 0.
Promises promised(const ParameterValues& values) {
    const double ratio = std::max(1.0 / 8.0, values.number("min_variance"));
    return {.localised = false, .approximate = true, .leak = ratio / (1.0 + ratio)};
}

}  // namespace

Technique variance() {
    Traits traits = texel_traits();
    // Not traded: `min_variance`, which costs nothing; `cells`, since one function a sample is a finer map of one
    // sample.
    traits.trades = {filter_trade};
    return {.id = "variance",
            .title = "variance shadow map: two moments of depth, and Chebyshev's bound",
            .paper = "Donnelly, Lauritzen 2006",
            .version = 1,
            .promises = {.localised = false, .approximate = true, .leak = 1.0 / 9.0},
            .parameters = parameters,
            .create = create_map<Variance>,
            .least_bytes = Variance::least_bytes,
            .promises_of = promised,
            .traits = traits};
}

}  // namespace shadowbench::techniques

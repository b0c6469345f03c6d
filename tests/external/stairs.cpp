// A technique outside the tree: the visibility of a pixel as stairs of equal height. A step is placed where the exact
// function crosses the middle between two stairs, so no stored value is off by more than half a stair.
#include <shadowbench_technique.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using shadowbench::CellRays;
using shadowbench::Curve;
using shadowbench::Ray;
using shadowbench::Values;

constexpr int pieces = 128;  // of a medium, whose light is taken away in as many falls

struct Fall {
    float z;
    double light;  // that is lost there, as a share of the pixel's
};

// Where the light of one ray is lost. A medium takes it along its way, here at the ends of short pieces.
void add_falls(const Ray& ray, double share, std::vector<Fall>& falls) {
    struct Part {
        float z;
        double transmittance;
    };
    std::vector<Part> parts;
    for (std::uint32_t s = ray.first; s < ray.last; ++s) {
        const float front = ray.front(s), back = ray.back(s);
        const int count = front < back ? pieces : 1;
        for (int i = 1; i <= count; ++i)
            parts.push_back({front + (back - front) * (static_cast<float>(i) - 0.5f * static_cast<float>(count > 1)) /
                                         static_cast<float>(count),
                             std::pow(static_cast<double>(ray.transmittance(s)), 1.0 / count)});
    }
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.z < b.z; });
    double left = share;
    for (const Part& part : parts) {
        const double passed = left * part.transmittance;
        falls.push_back({part.z, left - passed});
        left = passed;
    }
}

Curve stairs(const CellRays& rays, const Values& values) {
    const double height = 1.0 / values[0].number;
    std::vector<Fall> falls;
    for (std::size_t r = 0; r < rays.size(); ++r) add_falls(rays[r], 1.0 / static_cast<double>(rays.size()), falls);
    std::sort(falls.begin(), falls.end(), [](const Fall& a, const Fall& b) { return a.z < b.z; });
    Curve curve;
    double visible = 1.0, stair = 1.0;
    for (std::size_t i = 0; i < falls.size(); ++i) {
        visible -= falls[i].light;
        if (i + 1 < falls.size() && falls[i + 1].z == falls[i].z) continue;  // the whole fall at this depth
        const double next = std::max(0.0, std::round(visible / height) * height);
        if (next >= stair) continue;
        curve.push_back({falls[i].z, static_cast<float>(stair)});
        curve.push_back({falls[i].z, static_cast<float>(next)});
        stair = next;
    }
    return curve;
}

// Half a stair; in media also what a piece of one takes at once, so nothing is promised there.
double bound(const shadowbench_value* values, std::size_t, const shadowbench_layout* layout) {
    return layout->media ? HUGE_VAL : 0.5 / values[0].number;
}

}  // namespace

SHADOWBENCH_TECHNIQUES(shadowbench::of_function<stairs>({
    .id = "stairs",
    .title = "stairs of equal height",
    .paper = "an example",
    .parameters = {shadowbench::integer("stairs", "how many there are from light to dark", 64, 2, 1024)},
    .trades = {{"stairs", SHADOWBENCH_LOGARITHMIC, 2, 1024}},
    // Behind everything, too, an answer may be off by half a stair, which is most for two stairs.
    .promises = {.approximate = true, .leak = 0.25},
    .error_bound = bound,
}))

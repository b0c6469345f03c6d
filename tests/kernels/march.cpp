// What capture of media is held against: the same rays, marched one by one by plain loops in double, which skip
// nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "kernels/inputs.h"
#include "kernels/kernel.h"
#include "rays/light_view.h"

namespace shadowbench::kernels {
namespace {

using base::Vec3d;

// The rays of a map, in the order of the captured tiles.
std::vector<rays::LightLine> lines_of(const Input& input, const std::vector<rays::LightRays>& tiles) {
    std::vector<rays::LightLine> lines;
    for (const rays::LightRays& tile : tiles)
        for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
            const int pixel = static_cast<int>(ray) / tile.samples, sample = static_cast<int>(ray) % tile.samples;
            const rays::SamplePosition at = rays::sample_position(
                input.layout, (tile.x0 + pixel % tile.width) * input.layout.samples_x + sample % input.layout.samples_x,
                (tile.y0 + pixel / tile.width) * input.layout.samples_y + sample / input.layout.samples_x);
            lines.push_back(rays::light_line(input.view, at.x, at.y));
        }
    return lines;
}

struct Segment {
    float front, back, transmittance;
};
struct Marched {
    std::vector<std::size_t> begin;
    std::vector<Segment> segments;
};

double density_at(const scene::GridVolume& grid, const Vec3d& point) {
    std::array<int, 3> low{}, high{};
    std::array<double, 3> share{};
    for (int a = 0; a < 3; ++a) {
        const double place = std::clamp(
            (point[a] - grid.lower[a]) / (grid.upper[a] - grid.lower[a]) * grid.size[a] - 0.5, 0.0, grid.size[a] - 1.0);
        const auto axis = static_cast<std::size_t>(a);
        low[axis] = static_cast<int>(place);
        high[axis] = std::min(low[axis] + 1, grid.size[a] - 1);
        share[axis] = place - low[axis];
    }
    const auto row = [&](int y, int z) {
        const float* r = grid.density.data() + (static_cast<std::size_t>(z) * grid.size.y + y) * grid.size.x;
        return r[low[0]] + share[0] * (r[high[0]] - r[low[0]]);
    };
    const double near = row(low[1], low[2]) + share[1] * (row(high[1], low[2]) - row(low[1], low[2]));
    const double far = row(low[1], high[2]) + share[1] * (row(high[1], high[2]) - row(low[1], high[2]));
    return near + share[2] * (far - near);
}

void add(double front, double back, double depth, Marched& marched) {
    if (depth > 0.0)
        marched.segments.push_back(
            {static_cast<float>(front), static_cast<float>(back), static_cast<float>(std::exp(-depth))});
}

void march(const scene::GridVolume& grid, double extinction, const rays::LightLine& line, Marched& marched) {
    double front = line.z_start, end = 1e30;
    for (int a = 0; a < 3; ++a) {
        const double t0 = (grid.lower[a] - line.origin[a]) / line.direction[a];
        const double t1 = (grid.upper[a] - line.origin[a]) / line.direction[a];
        front = std::max(front, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    if (!(front < end)) return;
    double before = density_at(grid, line.origin + line.direction * front);
    for (double z = front; z < end;) {
        const double next = std::min(z + grid.step / line.scale, end);
        const double behind = density_at(grid, line.origin + line.direction * next);
        add(z, next, 0.5 * (before + behind) * (next - z) * line.scale * extinction, marched);
        before = behind;
        z = next;
    }
}

void march(const scene::Particles& puffs, double extinction, const rays::LightLine& line, Marched& marched) {
    const double length2 = line.direction.dot(line.direction);
    for (std::size_t i = 0; i < puffs.radii.size(); ++i) {
        const Vec3d to_centre = Vec3d(puffs.centres[i]) - line.origin;
        const double middle = to_centre.dot(line.direction) / length2;
        const Vec3d miss = to_centre - line.direction * middle;
        const double inside = static_cast<double>(puffs.radii[i]) * puffs.radii[i] - miss.dot(miss);
        if (!(inside > 0.0)) continue;
        const double half = std::sqrt(inside / length2);
        add(middle - half, middle + half, 2.0 * half * line.scale * puffs.density[i] * extinction, marched);
    }
    std::sort(marched.segments.begin() + static_cast<std::ptrdiff_t>(marched.begin.back()), marched.segments.end(),
              [](const Segment& a, const Segment& b) { return a.front < b.front; });
}

Marched march_all(const scene::Object& object, const std::vector<rays::LightLine>& lines) {
    Marched marched;
    for (const rays::LightLine& line : lines) {
        marched.begin.push_back(marched.segments.size());
        if (const auto* grid = std::get_if<scene::GridVolume>(&object.shape))
            march(*grid, object.extinction.x, line, marched);
        else
            march(std::get<scene::Particles>(object.shape), object.extinction.x, line, marched);
    }
    marched.begin.push_back(marched.segments.size());
    return marched;
}

// Whether the captured rays transmit as much.
void check_marched(const Marched& marched, const std::vector<rays::LightRays>& tiles) {
    std::size_t number = 0;
    for (const rays::LightRays& tile : tiles)
        for (std::size_t ray = 0; ray < tile.rays(); ++ray, ++number) {
            double transmittance = 1.0;
            for (std::size_t s = marched.begin[number]; s < marched.begin[number + 1]; ++s)
                transmittance *= static_cast<double>(marched.segments[s].transmittance);
            const double captured = rays::transmittance(tile, ray, 0, 1e30);
            check(std::abs(transmittance - captured) < 1e-5,
                  fmt::format("ray {} transmits {} when it is marched, and {} when it is captured", number,
                              transmittance, captured));
        }
}

Subject prepare_march(Kind kind, int map, int samples) {
    const SharedInput input = make_input(kind, map, samples);
    const std::vector<rays::LightRays> tiles = capture_all(*input);
    const auto lines = std::make_shared<const std::vector<rays::LightLine>>(lines_of(*input, tiles));
    const Marched marched = march_all(input->scene.objects[0], *lines);
    check_marched(marched, tiles);
    Subject subject;
    subject.exact.nodes = static_cast<double>(marched.segments.size());
    subject.exact.bytes =
        static_cast<double>(marched.begin.size() * sizeof(std::size_t) + marched.segments.size() * sizeof(Segment));
    subject.vertices = *subject.exact.nodes;
    subject.pass = [input, lines] {
        benchmark::DoNotOptimize(march_all(input->scene.objects[0], *lines).segments.data());
    };
    return subject;
}

}  // namespace

void add_march_kernels(Kernels& kernels) {
    for (const Kind kind : {Kind::smoke, Kind::cloud})
        kernels.push_back(
            {fmt::format("march/{}/map:64/samples:16", name_of(kind)), [=] { return prepare_march(kind, 64, 16); }});
}

}  // namespace shadowbench::kernels

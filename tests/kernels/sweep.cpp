// Sweep: computes the visibility function of each pixel from its rays.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "curves/sweep.h"
#include "kernels/inputs.h"
#include "kernels/kernel.h"

namespace shadowbench::kernels {
namespace {

constexpr int map = 16;
constexpr double linearisation = 1e-3;
constexpr double rounding = 2e-6;  // of the sum, and of the oracle's depths as floats

// The mean of the rays' exact transmittance at z, or just behind z.
double truth(const rays::LightRays& tile, std::size_t first, double z, bool behind) {
    if (behind) z = std::nextafter(z, std::numeric_limits<double>::infinity());
    double sum = 0.0;
    for (int s = 0; s < tile.samples; ++s) sum += rays::transmittance(tile, first + static_cast<std::size_t>(s), 0, z);
    return sum / tile.samples;
}

// Checks every vertex from both sides, and the middle between any two.
double error_of(const rays::LightRays& tile, std::size_t first, const curves::Curve& function) {
    double error = 0.0;
    const auto compare = [&](float value, double z, bool behind) {
        error = std::max(error, std::abs(value - truth(tile, first, z, behind)));
    };
    for (std::size_t i = 0; i < function.size(); ++i) {
        const float z = function[i].z;
        compare(curves::evaluate(function, z), z, false);
        compare(curves::evaluate_behind(function, z), z, true);
        if (i + 1 == function.size() || function[i + 1].z == z) continue;
        const float middle = z + 0.5f * (function[i + 1].z - z);
        compare(curves::evaluate(function, middle), middle, false);
    }
    return error;
}

template <class Visit>
void for_each_pixel(const std::vector<rays::LightRays>& tiles, const Visit& visit) {
    for (const rays::LightRays& tile : tiles)
        for (std::size_t ray = 0; ray < tile.rays(); ray += static_cast<std::size_t>(tile.samples)) visit(tile, ray);
}

struct Sweep {
    std::vector<rays::LightRays> tiles;
    curves::SweepScratch scratch;
    curves::Curve function;

    void operator()(const rays::LightRays& tile, std::size_t ray) {
        curves::visibility(tile, ray, static_cast<std::size_t>(tile.samples), linearisation, scratch, function);
    }
};

Subject prepare(Kind kind, int samples) {
    const auto sweep = std::make_shared<Sweep>();
    sweep->tiles = capture_all(*make_input(kind, map, samples));
    std::size_t vertices = 0;
    double error = 0.0;
    for_each_pixel(sweep->tiles, [&](const rays::LightRays& tile, std::size_t ray) {
        (*sweep)(tile, ray);
        vertices += sweep->function.size();
        error = std::max(error, error_of(tile, ray, sweep->function));
    });
    check(error <= linearisation + rounding, fmt::format("a function differs from its rays by {}", error));

    Subject subject;
    subject.exact = {static_cast<double>(vertices * sizeof(curves::Vertex)), static_cast<double>(vertices), error, {}};
    subject.vertices = static_cast<double>(vertices);
    subject.pass = [sweep] {
        for_each_pixel(sweep->tiles, std::ref(*sweep));
        benchmark::DoNotOptimize(sweep->function.data());
    };
    std::vector<const void*> lines;
    append_lines(sweep->tiles, lines);
    subject.floor = floor_of(std::move(lines));
    return subject;
}

}  // namespace

void add_sweep_kernels(Kernels& kernels) {
    for (const Kind kind : {Kind::hair, Kind::smoke, Kind::mixed})
        for (const int samples : {4, 16, 64})
            kernels.push_back(
                {fmt::format("sweep/{}/samples:{}", name_of(kind), samples), [=] { return prepare(kind, samples); }});
}

}  // namespace shadowbench::kernels

#include "claims/lokovic_cover.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/hand_made.h"
#include "rays/light_view.h"
#include "techniques/technique.h"

namespace shadowbench::claims::lokovic {
namespace {

using techniques::Query;

constexpr float caster = 1.0f, behind = 2.0f, z_max = 3.0f;
constexpr int deep_side = 16;

// Places of squares `width` wide in a map of this side.
std::vector<Query> places(double side, double width, double scatter_y, int count, std::uint64_t seed) {
    base::Random random(base::hash(seed, 0x706c6163u));
    std::vector<Query> queries;
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform(0.5 * width, side - 0.5 * width);
        const double y = 0.5 * side + scatter_y * random.uniform(-0.5, 0.5);
        queries.push_back({static_cast<float>(x), static_cast<float>(y), behind, static_cast<float>(width)});
    }
    return queries;
}

// `cells` is the number of cells of the cover along one map pixel.
double rms_error(const Cover& cover, std::span<const Query> queries, double cells, std::span<const float> answers) {
    double squares = 0.0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Query& q = queries[i];
        const double error = answers[i] - (1.0 - cover.share(cells * q.x, cells * q.y, cells * q.width));
        squares += error * error;
    }
    return std::sqrt(squares / static_cast<double>(queries.size()));
}

}  // namespace

Cover::Cover(int side, std::vector<char> covered) : side_(side), covered_(std::move(covered)) {
    const auto n = static_cast<std::size_t>(side) + 1;
    sums_.assign(n * n, 0.0);
    for (std::size_t y = 1; y < n; ++y)
        for (std::size_t x = 1; x < n; ++x)
            sums_[y * n + x] = sums_[(y - 1) * n + x] + sums_[y * n + x - 1] - sums_[(y - 1) * n + x - 1] +
                               covered_[(y - 1) * (n - 1) + x - 1];
}

bool Cover::at(double x, double y) const {
    return covered_[static_cast<std::size_t>(y) * side_ + static_cast<std::size_t>(x)] != 0;
}

// Linear between the corners of a cell, in x and in y, since a cell is covered wholly or not at all.
double Cover::sum(double x, double y) const {
    const double last = side_ - 1.0;
    const double i = std::min(std::floor(x), last), j = std::min(std::floor(y), last), u = x - i, v = y - j;
    const std::size_t n = static_cast<std::size_t>(side_) + 1;
    const double* corner = &sums_[static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i)];
    return (1 - v) * ((1 - u) * corner[0] + u * corner[1]) + v * ((1 - u) * corner[n] + u * corner[n + 1]);
}

double Cover::share(double x, double y, double width) const {
    const double side = side_, x0 = std::clamp(x - 0.5 * width, 0.0, side), x1 = std::clamp(x + 0.5 * width, 0.0, side),
                 y0 = std::clamp(y - 0.5 * width, 0.0, side), y1 = std::clamp(y + 0.5 * width, 0.0, side);
    return (sum(x1, y1) - sum(x0, y1) - sum(x1, y0) + sum(x0, y0)) / ((x1 - x0) * (y1 - y0));
}

rays::LightRays Cover::rays() const {
    rays::LightRays tile;
    tile.width = tile.height = side_;
    tile.begin.push_back(0);
    for (const char covered : covered_) {
        if (covered) tile.z_front.push_back(caster);
        tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
    }
    tile.transmittance.assign(tile.z_front.size(), 0.0f);
    return tile;
}

Cover silhouette(int side) {
    std::vector<char> covered(static_cast<std::size_t>(side) * side, 0);
    std::fill(covered.begin(), covered.begin() + static_cast<std::ptrdiff_t>(covered.size() / 2), 1);
    return {side, std::move(covered)};
}

Cover fur(int side, std::uint64_t seed) {
    constexpr double length = 60.0, step = 0.5;  // cells
    base::Random random(base::hash(seed, 0x66757200u));
    std::vector<char> covered(static_cast<std::size_t>(side) * side, 0);
    std::size_t count = 0;
    const auto wrapped = [side](double x) {
        return static_cast<std::size_t>(x + side) % static_cast<std::size_t>(side);
    };
    while (2 * count < covered.size()) {
        const double x = random.uniform(0.0, side), y = random.uniform(0.0, side);
        const double turn = std::numbers::pi * random.uniform(), dx = std::cos(turn), dy = std::sin(turn);
        for (double s = 0.0; s < length; s += step) {
            char& cell = covered[wrapped(y + s * dy) * static_cast<std::size_t>(side) + wrapped(x + s * dx)];
            count += cell == 0;
            cell = 1;
        }
    }
    return {side, std::move(covered)};
}

double filtering_error(const Cover& cover, int width, int samples, int lookups, std::uint64_t seed,
                       const char* placement) {
    const std::vector<Query> queries = places(cover.side(), width, width, lookups, seed);
    const nlohmann::json parameters = {
        {"num_samples", samples}, {"res_factor", 1}, {"min_size", 0}, {"min_samples", 1}, {"placement", placement}};
    return rms_error(cover, queries, 1.0, look_up("pcf", parameters, cover.rays(), z_max, queries));
}

double deep_error(const Cover& cover, int samples_per_pixel, double pixels, int lookups, std::uint64_t seed,
                  const char* kernel) {
    rays::MapLayout layout;
    layout.width = layout.tile_width = layout.height = layout.tile_height = deep_side;
    layout.jittered = true;
    layout.seed = seed;
    layout.z_min = 0.0f;
    layout.z_max = z_max;
    rays::set_samples(layout, samples_per_pixel);

    const double cells = static_cast<double>(cover.side()) / deep_side;
    rays::LightRays tile;
    tile.width = tile.height = deep_side;
    tile.samples = samples_per_pixel;
    tile.begin.push_back(0);
    for (int y = 0; y < deep_side; ++y)
        for (int x = 0; x < deep_side; ++x)
            for (int s = 0; s < samples_per_pixel; ++s) {
                const rays::SamplePosition at = rays::sample_position(
                    layout, x * layout.samples_x + s % layout.samples_x, y * layout.samples_y + s / layout.samples_x);
                if (cover.at(cells * at.x, cells * at.y)) tile.z_front.push_back(caster);
                tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
            }
    tile.transmittance.assign(tile.z_front.size(), 0.0f);

    const double width = std::sqrt(pixels);
    const std::vector<Query> queries = places(deep_side, width, deep_side - width, lookups, seed);
    const rays::LightView view;
    const techniques::Technique& row = techniques::find("deep", "");
    nlohmann::json parameters;
    parameters["kernel"] = kernel;
    const auto map = row.create(techniques::read_parameters(row.parameters, parameters, ""));
    map->begin({layout, view, nullptr});
    map->add(tile);
    map->finish();
    std::vector<float> visibility(queries.size());
    map->lookup(queries, visibility);
    return rms_error(cover, queries, cells, visibility);
}

}  // namespace shadowbench::claims::lokovic

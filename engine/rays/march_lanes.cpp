// Rays that are neighbours, marched side by side: VolumeMarcher::march_side_by_side.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "rays/exp_minus.h"
#include "rays/grid_density.h"
#include "rays/march.h"
#include "rays/medium_floats.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

// The rays inside the box, in voxel coordinates: start + slope * s. A lane without a ray has a length of 0.
struct Ways {
    Lanes<double> start_x{}, start_y{}, start_z{}, slope_x{}, slope_y{}, slope_z{};
    Lanes<double> t_min{}, length{}, scale{}, step{}, steps{};
};

// Where the rays are.
struct State {
    Lanes<double> place{}, density{};  // where the next step starts, and the density there
    Lanes<double> rest{};              // of StepRounding, in its one channel
};

// What the rays cross in one step.
struct Step {
    Lanes<float> front, back, transmittance;
    Lanes<double> depth;
};

// The first if all bits of the mask are set, the second if none is. Masks are made in a loop before, or GCC makes
// branches, and no vectors, of the choices.
SHADOWBENCH_SIMD_LOOP inline double choose(std::uint64_t mask, double first, double second) {
    const auto bits = std::bit_cast<std::uint64_t>(second);
    return std::bit_cast<double>(bits ^ ((bits ^ std::bit_cast<std::uint64_t>(first)) & mask));
}

SHADOWBENCH_SIMD_LOOP inline void stand_at(const Ways& ways, const Voxels& voxels, double i, State& state) {
    Lanes<double> x, y, z;
    for (std::size_t l = 0; l < side_by_side; ++l) {
        const double steps = i * ways.step[l], s = steps < ways.length[l] ? steps : ways.length[l];
        x[l] = ways.start_x[l] + ways.slope_x[l] * s;
        y[l] = ways.start_y[l] + ways.slope_y[l] * s;
        z[l] = ways.start_z[l] + ways.slope_z[l] * s;
        state.place[l] = s;
    }
    densities_at(voxels, x, y, z, state.density);
}

// Whether any ray meets density there.
SHADOWBENCH_SIMD_LOOP inline bool any_density(const State& state) {
    std::uint64_t bits = 0;
    for (const double density : state.density) bits |= std::bit_cast<std::uint64_t>(density);
    return bits != 0;
}

// What the rays cross on their way to the next state, whose `rest` it fills.
SHADOWBENCH_SIMD_LOOP inline void take_step(const Ways& ways, double extinction, const State& state, State& next,
                                            Step& step) {
    Lanes<double> with_rest, exact, rounded, error;
    Lanes<std::int32_t> near;
    constexpr auto one = std::bit_cast<std::int32_t>(1.0f);
    Lanes<std::uint64_t> dense, clear;
    for (std::size_t l = 0; l < side_by_side; ++l) {
        const double length = next.place[l] - state.place[l];
        const double unit = 0.5 * (state.density[l] + next.density[l]) * length * ways.scale[l];
        step.front[l] = static_cast<float>(ways.t_min[l] + state.place[l]);
        step.back[l] = static_cast<float>(ways.t_min[l] + next.place[l]);
        step.depth[l] = unit * extinction;
        dense[l] = unit > 0.0 ? ~std::uint64_t{0} : 0;
        with_rest[l] = std::min(step.depth[l] + state.rest[l], most_depth);
    }
    // As StepRounding does it.
    for (std::size_t l = 0; l < side_by_side; ++l) {
        exact[l] = exp_minus(with_rest[l]);
        near[l] = std::bit_cast<std::int32_t>(static_cast<float>(exact[l]));  // grows with the float
    }
    for (std::size_t l = 0; l < side_by_side; ++l) {
        const std::int32_t above = near[l] - one, below = above >> 31;  // all bits set below 1
        rounded[l] = std::bit_cast<float>(near[l] - (above & ~below));
        clear[l] = ~static_cast<std::uint64_t>(std::int64_t{below});
    }
    for (std::size_t l = 0; l < side_by_side; ++l) error[l] = (rounded[l] - exact[l]) / exact[l];
    for (std::size_t l = 0; l < side_by_side; ++l) {
        const double rest = choose(clear[l], with_rest[l], error[l]);
        next.rest[l] = choose(dense[l], rest, state.rest[l]);
        step.transmittance[l] = static_cast<float>(choose(dense[l], rounded[l], 1.0));
    }
}

}  // namespace

bool VolumeMarcher::march_side_by_side(std::span<const WorldRay> rays, double t_min, double t_max, float extinction,
                                       Lanes<std::vector<MediumStep>>& out) const {
    for (std::vector<MediumStep>& steps : out) steps.clear();
    if (volume_.size.x < 2) return false;
    Ways ways;
    double most_steps = 0.0;
    for (std::size_t l = 0; l < rays.size(); ++l) {
        Way way;
        if (!enter(rays[l].origin, rays[l].direction, t_min, t_max, way)) continue;
        const double step = volume_.step / rays[l].scale, end = way.t_min + way.length;
        // Steps so short would have to be joined.
        if (step < 0x1p-22 * std::max(std::abs(way.t_min), std::abs(end))) return false;
        ways.start_x[l] = way.start.x, ways.start_y[l] = way.start.y, ways.start_z[l] = way.start.z;
        ways.slope_x[l] = way.slope.x, ways.slope_y[l] = way.slope.y, ways.slope_z[l] = way.slope.z;
        ways.t_min[l] = way.t_min, ways.length[l] = way.length;
        ways.scale[l] = rays[l].scale, ways.step[l] = step;
        ways.steps[l] = std::max(1.0, std::ceil(way.length / step));
        most_steps = std::max(most_steps, ways.steps[l]);
    }

    // The step before which all rays surely stay in empty blocks, if they do at step i.
    const auto empty_until = [&](double i) {
        double until = most_steps;
        for (std::size_t l = 0; l < rays.size() && until > i; ++l) {
            if (!(i < ways.steps[l])) continue;
            const base::Vec3d slope(ways.slope_x[l], ways.slope_y[l], ways.slope_z[l]);
            const double s = i * ways.step[l];
            const base::Vec3d index = base::Vec3d(ways.start_x[l], ways.start_y[l], ways.start_z[l]) + slope * s;
            const double ahead = blocks_.empty_ahead(index, slope);
            until = std::min(until, ahead > 0.0 ? std::floor((s + ahead) / ways.step[l]) : i);
        }
        return std::max(until, i);  // the division may round down
    };
    State state, next;
    Step step;
    bool stands = false, dense = false;  // where step i starts, and in density
    for (double i = 0.0; i < most_steps; i += 1.0) {
        if (!dense) {
            const double until = empty_until(i);
            if (until >= most_steps) break;
            stands = stands && until == i;
            i = until;
        }
        bool met = false;
        base::on_simd_path([&]() SHADOWBENCH_SIMD_LOOP {
            if (!stands) {
                stand_at(ways, voxels_, i, state);
                dense = any_density(state);
            }
            stand_at(ways, voxels_, i + 1.0, next);
            const bool next_dense = any_density(next);
            met = dense || next_dense;
            if (met)
                take_step(ways, extinction, state, next, step);
            else
                next.rest = state.rest;
            dense = next_dense;
            state = next;
        });
        stands = true;
        for (std::size_t l = 0; met && l < side_by_side; ++l) {
            if (step.transmittance[l] == 1.0f) continue;
            if (step.depth[l] > darkest) return false;
            // Only the last step, which may be shorter, can end at the float where it starts.
            const float back = step.back[l] > step.front[l] ? step.back[l] : next_depth(step.front[l]);
            out[l].push_back({step.front[l], back, step.transmittance[l]});
        }
    }
    return true;
}

}  // namespace shadowbench::rays

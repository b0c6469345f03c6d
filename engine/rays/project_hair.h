// Projects hair into the sample grid of a tile. On the view plane a segment lies in a strip around its axis: the rows'
// spans of the strip are compared with it in single precision, four samples at a time, and only samples inside it are
// tested exactly. Internal to tile_projection.h.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "rays/bins.h"
#include "rays/hits.h"
#include "rays/light_view.h"
#include "rays/primitives.h"
#include "rays/tile_grid.h"

namespace shadowbench::rays {

// The samples that a segment may cover, in cells of a tile: |x nx + y ny - offset| <= reach, inside a box.
struct HairStrip {
    double nx, ny, offset, reach;  // (nx, ny) has unit length
    double x_low, x_high;
    int j_low, j_high;
};

// How far on the view plane a segment behind the light can reach from its axis; infinite if it is so near that slopes
// mean nothing. Seen from the light, a sphere of angular radius alpha around a point at the angle theta from the
// light's axis reaches from tan theta to tan(theta + alpha) outwards, and less far to all other sides.
template <bool perspective>
double reach_of(const HairSegment& s) {
    if constexpr (!perspective) return std::max(s.radius_a, s.radius_b);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double az = s.a.z, bz = s.b.z, front_a = az - s.radius_a, front_b = bz - s.radius_b;
    if (!(std::min(front_a, front_b) > 0.0)) return infinity;
    // At least tan alpha and tan^2 theta everywhere on the segment: both are greatest at an end.
    const double spread = std::max(s.radius_a / front_a, s.radius_b / front_b);
    const auto square = [](const base::Vec3f& p, double z) {
        return (static_cast<double>(p.x) * p.x + static_cast<double>(p.y) * p.y) / (z * z);
    };
    const double slope2 = std::max(square(s.a, az), square(s.b, bz));
    const double remaining = 1.0 - std::sqrt(slope2) * spread;
    return remaining > 0.5 ? spread * (1.0 + slope2) / remaining : infinity;
}

// Returns false if the tile has no such samples.
template <bool perspective>
bool find_strip(const HairSegment& s, const TileGrid& grid, const LightView& view, HairStrip& strip) {
    constexpr double far = 1e9, infinity = std::numeric_limits<double>::infinity();  // far, in cells: rounding counts
    if (perspective && std::min(s.a.z - s.radius_a, s.b.z - s.radius_b) <= 0.25 * view.z_near) {
        // Around the light, where slopes grow without bound: every sample in the bounds of what lies behind the near
        // plane.
        PlaneBox box;
        add_hair(view, base::Vec3d(s.a), s.radius_a, base::Vec3d(s.b), s.radius_b, box);
        if (box.empty()) return false;
        const double x_low = std::max(grid.cells_x(box.x_low) - margin, 0.0);
        const double x_high = std::min<double>(grid.cells_x(box.x_high) + margin, grid.nx);
        const double y_low = grid.cells_y(box.y_low) - margin, y_high = grid.cells_y(box.y_high) + margin;
        strip = {1.0, 0.0, 0.0, infinity, x_low, x_high, grid.row(y_low), grid.row(y_high)};
        return x_low <= x_high && y_high >= 0.0 && y_low <= grid.ny;
    }
    const double reach = reach_of<perspective>(s);
    const double per_za = perspective ? 1.0 / s.a.z : 1.0, per_zb = perspective ? 1.0 / s.b.z : 1.0;
    const double ax = grid.cells_x(s.a.x * per_za), ay = grid.cells_y(s.a.y * per_za);
    const double bx = grid.cells_x(s.b.x * per_zb), by = grid.cells_y(s.b.y * per_zb);
    const double reach_x = reach * grid.per_cell_x + margin, reach_y = reach * grid.per_cell_y + margin;
    if (!(std::max({std::abs(ax), std::abs(ay), std::abs(bx), std::abs(by), reach_x, reach_y}) < far)) {
        strip = {1.0, 0.0, 0.0, infinity, 0.0, static_cast<double>(grid.nx), 0, grid.ny - 1};  // test every sample
        return true;
    }
    const double y_low = std::min(ay, by) - reach_y, y_high = std::max(ay, by) + reach_y;
    strip.x_low = std::max(std::min(ax, bx) - reach_x, 0.0);
    strip.x_high = std::min<double>(std::max(ax, bx) + reach_x, grid.nx);
    if (strip.x_low > strip.x_high || y_high < 0.0 || y_low > grid.ny) return false;
    strip.j_low = grid.row(y_low);
    strip.j_high = grid.row(y_high);
    const double dx = bx - ax, dy = by - ay, length2 = dx * dx + dy * dy;
    strip.nx = 1.0;
    strip.ny = 0.0;
    if (length2 > 1e-12) {  // else any direction will do
        const double per_length = 1.0 / std::sqrt(length2);
        strip.nx = dy * per_length;
        strip.ny = -dx * per_length;
    }
    strip.offset = ax * strip.nx + ay * strip.ny;
    const double across_x = strip.nx * reach_x, across_y = strip.ny * reach_y;
    // The last term exceeds the rounding in append_near().
    strip.reach = std::sqrt(across_x * across_x + across_y * across_y) + 1e-6 * (grid.nx + grid.ny + reach_x + reach_y);
    const double from_middle = strip.offset - 0.5 * (strip.nx * grid.nx + strip.ny * grid.ny);
    return std::abs(from_middle) <= strip.reach + 0.5 * (std::abs(strip.nx) * grid.nx + std::abs(strip.ny) * grid.ny);
}

#if defined(__SSE2__)
// The places of the bits of a mask of four, in order, and how many there are.
struct BitsOfFour {
    alignas(16) std::uint32_t place[4] = {0, 0, 0, 0};
    int count = 0;

    constexpr explicit BitsOfFour(std::uint32_t mask) {
        for (std::uint32_t i = 0; i < 4; ++i)
            if (mask >> i & 1) place[count++] = i;
    }
};
constexpr BitsOfFour bits_of_four[16] = {BitsOfFour(0),  BitsOfFour(1),  BitsOfFour(2),  BitsOfFour(3),
                                         BitsOfFour(4),  BitsOfFour(5),  BitsOfFour(6),  BitsOfFour(7),
                                         BitsOfFour(8),  BitsOfFour(9),  BitsOfFour(10), BitsOfFour(11),
                                         BitsOfFour(12), BitsOfFour(13), BitsOfFour(14), BitsOfFour(15)};
#endif

// Projects the segments of one hair object. Crossings go to `sink` in the order of segments, rows and columns; finish()
// hands over the last ones.
template <bool perspective, class Sink>
class HairProjection {
public:
    HairProjection(const TileGrid& grid, const LightView& view, const float* transmittance, Sink& sink)
        : grid_(grid), view_(view), transmittance_(transmittance), sink_(sink) {}

    void project(const HairSegment& s) {
        HairStrip strip;
        if (!find_strip<perspective>(s, grid_, view_, strip)) return;
        const bool along_rows = std::abs(strip.nx) < 1e-6;  // it leaves a row only at its ends
        const double per_nx = along_rows ? 0.0 : 1.0 / strip.nx;
        const double half = along_rows ? grid_.nx : (strip.reach + 0.5 * std::abs(strip.ny)) * std::abs(per_nx);
        const double first = along_rows ? 0.5 * grid_.nx : (strip.offset - 0.5 * strip.ny) * per_nx;
        const double slope = along_rows ? 0.0 : -strip.ny * per_nx;
        const Line line(strip);
        for (int j = strip.j_low; j <= strip.j_high; ++j) {
            const double middle = first + slope * j;
            const double x_low = std::max(middle - half, strip.x_low), x_high = std::min(middle + half, strip.x_high);
            if (!(x_low <= x_high)) continue;
            const int i_high = std::min(static_cast<int>(x_high), grid_.nx - 1);
            for (int i = static_cast<int>(x_low); i <= i_high; i += 4) {
                if (count_ > most) [[unlikely]]
                    test(s);
                count_ += line.append_near(grid_, j, i, candidates_ + count_);
            }
        }
        test(s);
    }

    void finish() {
        check_hits(sink_);
        for (int i = 0; i < found_; ++i) sink_.surface(grid_.ray[found_samples_[i]], found_z_[i], transmittance_);
        found_ = 0;
    }

private:
    static constexpr int lanes = 2, size = 256, most = size - 4;
    using Doubles = double __attribute__((vector_size(lanes * sizeof(double))));  // a register of SSE2

    // A strip in single precision.
    struct Line {
        float nx, ny, offset, reach;
        explicit Line(const HairStrip& strip)
            : nx(static_cast<float>(strip.nx)),
              ny(static_cast<float>(strip.ny)),
              offset(static_cast<float>(strip.offset)),
              reach(static_cast<float>(strip.reach)) {}

        // Of the samples in cells i to i + 3 of row j, writes the numbers of those in the strip; returns how many there
        // are. Behind them it may write anything, up to four in all.
        int append_near(const TileGrid& grid, int j, int i, std::uint32_t* out) const {
            const std::size_t at = static_cast<std::size_t>(j) * grid.cell_stride + i;
            const float *x = &grid.cell_x[at], *y = &grid.cell_y[at];
            const std::uint32_t sample = static_cast<std::uint32_t>(j * grid.nx + i);
#if defined(__SSE2__)
            const __m128 along_x = _mm_mul_ps(_mm_loadu_ps(x), _mm_set1_ps(nx));
            const __m128 along_y = _mm_mul_ps(_mm_loadu_ps(y), _mm_set1_ps(ny));
            const __m128 from = _mm_sub_ps(_mm_add_ps(along_x, along_y), _mm_set1_ps(offset));
            const __m128 distance = _mm_andnot_ps(_mm_set1_ps(-0.0f), from);
            const int near = _mm_movemask_ps(_mm_cmple_ps(distance, _mm_set1_ps(reach)));
            const __m128i places = _mm_load_si128(reinterpret_cast<const __m128i*>(bits_of_four[near].place));
            const __m128i numbers = _mm_add_epi32(_mm_set1_epi32(static_cast<int>(sample)), places);
            _mm_storeu_si128(reinterpret_cast<__m128i*>(out), numbers);
            return bits_of_four[near].count;
#else
            int count = 0;
            for (std::uint32_t k = 0; k < 4; ++k) {
                out[count] = sample + k;
                count += std::abs(x[k] * nx + y[k] * ny - offset) <= reach;
            }
            return count;
#endif
        }
    };

    // Tests the candidates exactly.
    void test(const HairSegment& s) {
        if (count_ == 0) return;
        for (int i = count_; i % lanes != 0; ++i) candidates_[i] = candidates_[0];
        double z[size];
        for (int i = 0; i < count_; i += lanes) {
            Doubles x, y;
            for (int k = 0; k < lanes; ++k) {
                x[k] = grid_.x[candidates_[i + k]];
                y[k] = grid_.y[candidates_[i + k]];
            }
            const Doubles depths = hair_depth(s, RayMetric<perspective, Doubles>(x, y));
            std::memcpy(z + i, &depths, sizeof depths);
        }
        if (found_ + count_ > size) [[unlikely]]
            finish();
        for (int i = 0; i < count_; ++i) {
            found_samples_[found_] = candidates_[i];
            found_z_[found_] = z[i];
            found_ += z[i] > view_.z_near;
        }
        count_ = 0;
    }

    const TileGrid& grid_;
    const LightView& view_;
    const float* transmittance_;
    Sink& sink_;
    std::uint32_t candidates_[size];  // samples that the segment may cover
    int count_ = 0;
    std::uint32_t found_samples_[size];
    double found_z_[size];
    int found_ = 0;
};

}  // namespace shadowbench::rays

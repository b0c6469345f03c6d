// The colour spaces of FLIP. Internal to flip.cpp.
#pragma once

#include <array>
#include <cmath>

namespace shadowbench::metrics {

using Triple = std::array<double, 3>;

// Linear RGB to XYZ: sRGB's primaries (IEC 61966-2-1) with the white D65, x = 0.31271, y = 0.32902, as exact fractions.
inline constexpr double rgb_to_xyz[3][3] = {{10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
                                            {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
                                            {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

// XYZ relative to the white, which is RGB (1, 1, 1).
inline Triple relative_xyz(const Triple& rgb) {
    Triple xyz{};
    for (int r = 0; r < 3; ++r) {
        const double* m = rgb_to_xyz[r];
        xyz[r] = (m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]) / (m[0] + m[1] + m[2]);
    }
    return xyz;
}

inline Triple rgb_of(const Triple& relative) {
    const auto& m = rgb_to_xyz;
    Triple xyz{};
    for (int r = 0; r < 3; ++r) xyz[r] = relative[r] * (m[r][0] + m[r][1] + m[r][2]);
    // Cramer's rule: the columns of the cofactors are cross products of the rows.
    const auto cross = [&](int a, int b) {
        return Triple{m[a][1] * m[b][2] - m[a][2] * m[b][1], m[a][2] * m[b][0] - m[a][0] * m[b][2],
                      m[a][0] * m[b][1] - m[a][1] * m[b][0]};
    };
    const Triple c0 = cross(1, 2), c1 = cross(2, 0), c2 = cross(0, 1);
    const double determinant = m[0][0] * c0[0] + m[0][1] * c0[1] + m[0][2] * c0[2];
    Triple rgb{};
    for (int i = 0; i < 3; ++i) rgb[i] = (c0[i] * xyz[0] + c1[i] * xyz[1] + c2[i] * xyz[2]) / determinant;
    return rgb;
}

// YCxCz: linearised CIELAB, in which pictures are filtered. It has no cube root, so that the filter averages light.
inline Triple ycxcz(const Triple& rgb) {
    const Triple xyz = relative_xyz(rgb);
    return {116.0 * xyz[1] - 16.0, 500.0 * (xyz[0] - xyz[1]), 200.0 * (xyz[1] - xyz[2])};
}

inline Triple rgb_of_ycxcz(const Triple& opponent) {
    const double y = (opponent[0] + 16.0) / 116.0;
    return rgb_of({y + opponent[1] / 500.0, y, y - opponent[2] / 200.0});
}

// CIELAB (CIE 15) with a* and b* multiplied by 0.01 L*, which weakens dark colours (Hunt effect).
inline Triple hunt_lab(const Triple& rgb) {
    const Triple xyz = relative_xyz(rgb);
    const auto f = [](double t) {
        constexpr double delta = 6.0 / 29.0;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const double fx = f(xyz[0]), fy = f(xyz[1]), fz = f(xyz[2]);
    const double lightness = 116.0 * fy - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (fx - fy), 0.01 * lightness * 200.0 * (fy - fz)};
}

// Abasi, Tehran, Fairchild 2020: city-block in lightness, Euclidean in chroma.
inline double hyab(const Triple& a, const Triple& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

}  // namespace shadowbench::metrics

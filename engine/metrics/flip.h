// FLIP: how different two pictures look to a person who flips between them.
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020 (Proc. ACM Comput. Graph. Interact. Tech. 3, 2, article 15), for pictures of low dynamic range:
//  - colour pipeline: spatial filtering in the opponent space YCxCz by contrast sensitivity functions, clamp to the RGB
//    cube, Hunt-adjusted CIELAB, HyAB distance, error redistribution over [0, 1];
//  - feature pipeline: edges and points of both pictures, by first and second derivatives of a Gaussian;
//  - final difference: colour difference to the power 1 - feature difference.
// With the authors' erratum: Y + 16 is divided by 116, not by 100, before features are detected.
// The paper's two-dimensional kernels are applied as sums of separable kernels. Beyond the border the outermost pixels
// are repeated.
#pragma once

#include <span>
#include <vector>

namespace shadowbench::metrics {

// The paper's default: 0.7 m away from a monitor that is 0.7 m and 3840 pixels wide.
inline constexpr double flip_pixels_per_degree = 67.0;

struct Flip {
    std::vector<float> map;  // one value per pixel, in [0, 1]; 0: no visible difference
    double mean = 0.0;
    // The paper's pooled value: pixels that differ by no more than this hold half of the sum of all differences. The
    // authors now advise the mean.
    double weighted_median = 0.0;
    double max = 0.0;
};

// Compares two pictures of width * height pixels with three values a pixel: linear RGB (primaries and white of sRGB),
// row after row. Values are clamped to [0, 1]; NaN counts as 0. The result does not depend on which picture comes
// first, nor on the number of threads.
Flip flip(std::span<const float> reference, std::span<const float> test, int width, int height,
          double pixels_per_degree = flip_pixels_per_degree);

}  // namespace shadowbench::metrics

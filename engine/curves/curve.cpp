#include "curves/curve.h"

#include <algorithm>

namespace shadowbench::curves {

float evaluate(CurveView curve, float z) {
    if (curve.empty()) return 1.0f;
    const auto right =
        std::lower_bound(curve.begin(), curve.end(), z, [](const Vertex& v, float x) { return v.z < x; });
    if (right == curve.end()) return curve.back().value;
    if (right == curve.begin() || right->z == z) return right->value;
    return join(*(right - 1), *right, z);
}

float evaluate_behind(CurveView curve, float z) {
    if (curve.empty()) return 1.0f;
    const auto right =
        std::upper_bound(curve.begin(), curve.end(), z, [](float x, const Vertex& v) { return x < v.z; });
    if (right == curve.begin()) return right->value;
    const auto left = right - 1;
    if (right == curve.end() || left->z == z) return left->value;
    return join(*left, *right, z);
}

bool is_visibility(CurveView curve, float slack) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        // Written so that a NaN fails.
        if (!(curve[i].value >= -slack && curve[i].value <= 1.0f + slack)) return false;
        if (i > 0 && !(curve[i].value <= curve[i - 1].value + slack)) return false;
    }
    return true;
}

}  // namespace shadowbench::curves

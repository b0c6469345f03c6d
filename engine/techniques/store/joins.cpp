#include "techniques/store/joins.h"

#include "base/simd_path.h"

namespace shadowbench::techniques {

void join(const Joins& joins, std::size_t count, float* values) {
    base::on_simd_path([&j = joins, count, to_values = values]() SHADOWBENCH_SIMD_LOOP {
        float* __restrict out = to_values;
        for (std::size_t i = 0; i < count; ++i) {
            const double z = j.z[i], left = j.left_z[i], right = j.right_z[i];
            const double from = j.left_value[i], to = j.right_value[i];
            const float value = static_cast<float>(from + (to - from) * ((z - left) / (right - left)));
            out[i] = j.z[i] == j.right_z[i] || j.left_z[i] == j.right_z[i] ? j.right_value[i] : value;
        }
    });
}

}  // namespace shadowbench::techniques

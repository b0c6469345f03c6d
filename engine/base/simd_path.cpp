#include "base/simd_path.h"

#include <array>
#include <atomic>
#include <cstddef>

namespace shadowbench::base {
namespace {

constexpr std::array all_paths{SimdPath::baseline, SimdPath::avx2, SimdPath::avx512};

std::size_t paths_here() {
#if defined(__x86_64__)
    if (!__builtin_cpu_supports("avx2")) return 1;
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
    return avx512 ? 3 : 2;
#else
    return 1;
#endif
}

std::atomic<SimdPath>& path() {
    static std::atomic<SimdPath> chosen = simd_paths().back();
    return chosen;
}

}  // namespace

std::span<const SimdPath> simd_paths() {
    return std::span(all_paths).first(paths_here());
}

SimdPath simd_path() {
    return path().load(std::memory_order_relaxed);
}

void set_simd_path(SimdPath chosen) {
    path().store(chosen, std::memory_order_relaxed);
}

}  // namespace shadowbench::base

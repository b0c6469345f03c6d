// The instructions that loops over blocks of numbers use. All paths give the same bits: they multiply and add in the
// same order, and none fuses the two (the project is compiled with -ffp-contract=off).
#pragma once

#include <span>

namespace shadowbench::base {

enum class SimdPath {
    baseline,  // any x86-64, or another machine
    avx2,
    avx512,
};

// Those that this machine has, the slowest first.
std::span<const SimdPath> simd_paths();

// The one in use: the last of them, or the one that was set. For tests and measurements; not while another thread runs
// such a loop.
SimdPath simd_path();
void set_simd_path(SimdPath path);

// Runs loop() with these instructions. It must be SHADOWBENCH_SIMD_LOOP, and so must be what it calls, so that the loop
// is compiled once for each path:
//   on_simd_path([&]() SHADOWBENCH_SIMD_LOOP { for (...) ... });
#define SHADOWBENCH_SIMD_LOOP __attribute__((always_inline))

#if defined(__x86_64__)
template <class Loop>
[[gnu::target("avx2")]] void run_avx2(const Loop& loop) {
    loop();
}
template <class Loop>
[[gnu::target("avx512f,avx512vl,avx512dq,avx512bw,prefer-vector-width=512")]] void run_avx512(const Loop& loop) {
    loop();
}
#endif

template <class Loop>
void on_simd_path(const Loop& loop) {
#if defined(__x86_64__)
    switch (simd_path()) {
        case SimdPath::avx512:
            return run_avx512(loop);
        case SimdPath::avx2:
            return run_avx2(loop);
        case SimdPath::baseline:
            break;
    }
#endif
    loop();
}

}  // namespace shadowbench::base

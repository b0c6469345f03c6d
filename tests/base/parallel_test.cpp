#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>
#include <vector>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "base/error.h"

namespace shadowbench::base {
namespace {

TEST(ParallelFor, CallsTheBodyOnceForEveryIndex) {
    std::vector<std::atomic<int>> calls(10000);
    parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) ASSERT_EQ(count, 1);
}

#if defined(__SSE2__)
// As Embree does while it builds: then all later work would lose its smallest numbers.
TEST(ParallelFor, RoundsAsItsCallerAndNotAsTheFirstOne) {
    std::thread([] {
        const unsigned usual = _mm_getcsr();
        _mm_setcsr(usual | 0x8040);  // denormal floats become zero
        parallel_for(100, [](std::size_t) {});
        _mm_setcsr(usual);
        std::atomic<int> lost = 0;
        parallel_for(100, [&](std::size_t) {
            volatile float least = std::numeric_limits<float>::min();
            lost += least / 4.0f == 0.0f;
        });
        EXPECT_EQ(lost, 0);
    }).join();
}
#endif

TEST(ParallelFor, OfNothingDoesNothing) {
    parallel_for(0, [](std::size_t) { FAIL(); });
}

// Anything but a rethrow on the calling thread would end the process, a service with it.
TEST(ParallelFor, AnExceptionOfTheBodyReachesTheCaller) {
    try {
        parallel_for(1000, [](std::size_t i) {
            if (i == 500) throw Error(ErrorCode::io, "file", "broken");
        });
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::io);
        EXPECT_EQ(error.message(), "broken");
    }
    std::atomic<int> calls{0};
    parallel_for(100, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 100) << "the next loop works as ever";
}

TEST(ParallelFor, MayBeNested) {
    std::atomic<int> calls{0};
    parallel_for(10, [&](std::size_t) { parallel_for(10, [&](std::size_t) { ++calls; }); });
    EXPECT_EQ(calls, 100);
}

TEST(ThreadLimit, HoldsWhileItLives) {
    const int all = thread_count();
    {
        const ThreadLimit one(1);
        EXPECT_EQ(thread_count(), 1);
        int calls = 0;  // not atomic: only one thread counts
        parallel_for(1000, [&](std::size_t) { ++calls; });
        EXPECT_EQ(calls, 1000);
    }
    EXPECT_EQ(thread_count(), all);
}

TEST(ThreadLimit, OfZeroMeansAllProcessors) {
    const ThreadLimit limit(0);
    EXPECT_GE(thread_count(), 1);
}

}  // namespace
}  // namespace shadowbench::base

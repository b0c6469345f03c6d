// Reference work that exists on every machine and that no change of the engine affects: times of other kernels may be
// divided by these.
#include <cstdint>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/random.h"
#include "bench/floor.h"
#include "kernels/kernel.h"

namespace shadowbench::kernels {
namespace {

constexpr std::uint64_t steps = 1 << 16;
constexpr std::size_t table_bytes = std::size_t{8} << 20;

// A chain of multiplications in which each waits for the one before it.
Subject arithmetic() {
    Subject subject;
    subject.vertices = static_cast<double>(steps);
    subject.pass = [] {
        std::uint64_t x = 1;
        for (std::uint64_t i = 0; i < steps; ++i) x = base::mix(x);
        benchmark::DoNotOptimize(x);
    };
    return subject;
}

// Independent reads of cache lines in random order.
Subject memory() {
    const auto table = std::make_shared<std::vector<unsigned char>>(table_bytes, static_cast<unsigned char>(1));
    base::Random random(1);
    std::vector<const void*> lines;
    for (std::uint64_t i = 0; i < steps; ++i) lines.push_back(table->data() + random.below(table_bytes));
    Subject subject;
    subject.vertices = static_cast<double>(steps);
    subject.pass = [table, lines] { benchmark::DoNotOptimize(bench::read_lines(lines)); };
    return subject;
}

}  // namespace

void add_reference_kernels(Kernels& kernels) {
    kernels.push_back({"reference/arithmetic", arithmetic});
    kernels.push_back({"reference/memory", memory});
}

}  // namespace shadowbench::kernels

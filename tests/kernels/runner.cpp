#include "kernels/runner.h"

#include <benchmark/benchmark.h>

#include "kernels/measure.h"

namespace shadowbench::kernels {

Runner::Runner(const Kernels& kernels, const std::vector<Injection>& injections) : injections_(injections) {
    for (const Kernel& kernel : kernels)
        benchmark::RegisterBenchmark(kernel.name.c_str(), [&](benchmark::State& state) { run(state, kernel); });
}

void Runner::run(benchmark::State& state, const Kernel& kernel) {
    try {
        if (prepared_ != &kernel) {
            prepared_ = nullptr;
            subject_ = {};
            subject_ = kernel.prepare();
            prepared_ = &kernel;
        }
        measure(state, kernel.name, subject_, faults_of(kernel.name, injections_));
    } catch (const std::exception& error) {
        wrong_ = true;
        state.SkipWithError(error.what());
    }
}

}  // namespace shadowbench::kernels

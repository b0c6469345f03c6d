// Kernels on Google Benchmark.
#pragma once

#include <string>
#include <vector>

#include "kernels/inject.h"
#include "kernels/kernel.h"

namespace benchmark {
class State;
}

namespace shadowbench::kernels {

// Google Benchmark calls a kernel again and again until it has enough of it; its subject is made once, when it is first
// called, and dropped when another kernel's turn comes. One whose answers are wrong is skipped with the reason.
class Runner {
public:
    // Registers every kernel. Both lists outlive the runner, and it the run.
    Runner(const Kernels& kernels, const std::vector<Injection>& injections);

    bool wrong() const { return wrong_; }  // whether any kernel answered wrongly

private:
    void run(benchmark::State& state, const Kernel& kernel);

    const std::vector<Injection>& injections_;
    const Kernel* prepared_ = nullptr;
    Subject subject_;
    bool wrong_ = false;
};

}  // namespace shadowbench::kernels

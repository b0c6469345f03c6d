// Runs kernels with Google Benchmark.
#pragma once

#include <string>
#include <vector>

#include "kernels/inject.h"
#include "kernels/kernel.h"

namespace benchmark {
class State;
}

namespace shadowbench::kernels {

// Google Benchmark calls a kernel repeatedly until it has enough iterations. The kernel's subject is made at the first
// call and dropped when another kernel runs. A kernel with wrong answers is skipped, with the reason.
class Runner {
public:
    // Registers every kernel. Both lists must outlive the runner, and the runner the run.
    Runner(const Kernels& kernels, const std::vector<Injection>& injections);

    bool wrong() const { return wrong_; }  // whether any kernel gave wrong answers

private:
    void run(benchmark::State& state, const Kernel& kernel);

    const std::vector<Injection>& injections_;
    const Kernel* prepared_ = nullptr;
    Subject subject_;
    bool wrong_ = false;
};

}  // namespace shadowbench::kernels

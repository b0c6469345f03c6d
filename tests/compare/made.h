// Synthetic results for tests: in the form that `run` writes, with times as on a shared machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/random.h"
#include "compare/compare.h"

namespace shadowbench::compare {

// A result.json of two techniques (deep and uncompressed) and one light, as the program wrote it.
nlohmann::json made_result();

nlohmann::json& cell_of(nlohmann::json& result, std::size_t index);

// The output of kernels: two kernels of three repetitions each, and an aggregate.
nlohmann::json made_kernels();

// One side of a comparison; each document is a process.
Measured side(const std::vector<nlohmann::json>& documents, const std::string& interleaved = "");

// The line of this measure of the first cell whose name starts with `cell`.
const Line& line(const Comparison& comparison, const std::string& cell, const std::string& measure);

// The machine's noise, after the figures of ../shared/platform.md: all processes of one side after the other, or
// interleaved. The logarithm of its speed follows a slow autoregression (correlation 0.9 from process to process), each
// process has a random factor of its own, and repetitions scatter with rare outliers. Over the floor most of the slow
// part is gone.
class Noise {
public:
    explicit Noise(std::uint64_t seed, double slow = 0.05, double luck = 0.01)
        : random_(seed), slow_(slow), luck_(luck) {}
    // Starts another process.
    void next();
    // A repetition of this process: the factors of a plain time and of a time over its floor.
    double plain();
    double over_floor();

private:
    double normal();
    base::Random random_;
    double slow_, luck_;
    double machine_ = 0.0, own_ = 0.0;
    bool started_ = false;
};

// Replaces the times of every cell by noisy ones around fixed values; those of cell `slowed` are multiplied by
// `factor`.
void make_times(nlohmann::json& result, Noise& noise, std::size_t slowed = 99, double factor = 1.0);

}  // namespace shadowbench::compare

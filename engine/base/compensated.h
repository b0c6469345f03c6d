// A running sum whose rounding errors are kept and added back: terms that are added and later taken away leave nothing.
// Neumaier, Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen (1974), with Knuth's branch-free
// two-sum. Needs strict IEEE arithmetic (no -ffast-math).
#pragma once

namespace shadowbench::base {

class CompensatedSum {
public:
    constexpr CompensatedSum() = default;
    explicit constexpr CompensatedSum(double value) : sum_(value) {}

    constexpr void add(double term) {
        const double next = sum_ + term;
        const double taken = next - sum_;
        error_ += (sum_ - (next - taken)) + (term - taken);
        sum_ = next;
    }
    constexpr double value() const { return sum_ + error_; }

private:
    double sum_ = 0.0;
    double error_ = 0.0;
};

}  // namespace shadowbench::base

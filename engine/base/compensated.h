// Sums and products in double that keep their rounding errors and add them back. They need strict IEEE arithmetic (no
// -ffast-math).
#pragma once

#include <bit>
#include <cstdint>

namespace shadowbench::base {

// A running sum: adding terms and taking them away again leaves nothing. Neumaier, Rundungsfehleranalyse einiger
// Verfahren zur Summation endlicher Summen (1974), with Knuth's branch-free two-sum.
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

// A running product of finite floats. Ogita, Rump and Oishi, Accurate sum and dot product (2005), applied to products
// as in Graillat, Accurate floating point product and exponentiation (2009). For up to 2^30 factors the relative error
// is below 2^-52, as if the product were rounded once. This holds while products stay above 1e-290; smaller ones lose
// less than 1e-296.
class CompensatedProduct {
public:
    constexpr void multiply(float factor) {
        // The upper half of the digits: the product of either half and the 24 bits of a float is exact (Dekker 1971).
        const double head = std::bit_cast<double>(std::bit_cast<std::uint64_t>(product_) & ~std::uint64_t{0x7ffffff});
        const double next = product_ * factor;
        error_ = error_ * factor + ((head * factor - next) + (product_ - head) * factor);
        product_ = next;
    }
    constexpr double value() const { return product_ + error_; }

private:
    double product_ = 1.0;
    double error_ = 0.0;
};

}  // namespace shadowbench::base

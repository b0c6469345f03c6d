#include "base/compensated.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace shadowbench::base {
namespace {

// A plain sum loses the small terms as soon as it contains the large one.
TEST(CompensatedSum, WhatIsAddedAndTakenAwayLeavesNothing) {
    CompensatedSum sum(1.0);
    sum.add(1e20);
    sum.add(3.0);
    sum.add(-1e20);
    EXPECT_EQ(sum.value(), 4.0);
}

TEST(CompensatedSum, AMillionTermsKeepTheirLastDigits) {
    CompensatedSum sum;
    for (int i = 0; i < 1'000'000; ++i) sum.add(0.1);
    EXPECT_DOUBLE_EQ(sum.value(), 100000.0);
}

TEST(CompensatedSum, RandomTermsTakenAwayInAnotherOrderLeaveNextToNothing) {
    CompensatedSum sum;
    for (int round = 0; round < 2; ++round) {
        Random random(5);
        for (int i = 0; i < 100'000; ++i) {
            const double term = random.uniform(-1e6, 1e6);
            sum.add(round == 0 ? term : -term);
        }
    }
    EXPECT_NEAR(sum.value(), 0.0, 1e-12);
}

TEST(CompensatedSum, StartsAtWhatItIsGiven) {
    EXPECT_EQ(CompensatedSum().value(), 0.0);
    EXPECT_EQ(CompensatedSum(2.5).value(), 2.5);
}

// A plain product is off by about as many last digits as the square root of its factors.
TEST(CompensatedProduct, AMillionFactorsKeepTheirLastDigits) {
    CompensatedProduct product;
    double plain = 1.0;
    long double expected = 0.0L;
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        long double part = 0.0L;
        for (int k = 0; k < 1000; ++k) {
            const float factor = 1.0f - static_cast<float>(random.uniform(0, 1e-5));
            product.multiply(factor);
            plain *= factor;
            part += log1pl(static_cast<long double>(factor) - 1.0L);
        }
        expected += part;
    }
    const long double exact = expl(expected);
    EXPECT_LE(std::abs(product.value() / exact - 1.0L), 0x1p-52L);
    EXPECT_GT(std::abs(plain / exact - 1.0L), 0x1p-50L);
}

TEST(CompensatedProduct, IsExactWhereItFitsADouble) {
    CompensatedProduct product;
    EXPECT_EQ(product.value(), 1.0);
    product.multiply(0.7f);
    product.multiply(0.3f);
    EXPECT_EQ(product.value(), 0.7f * static_cast<double>(0.3f));
    product.multiply(0.0f);
    EXPECT_EQ(product.value(), 0.0);
}

TEST(CompensatedProduct, FallsToZeroOverDenormalsWithoutTurningNegativeOrRising) {
    CompensatedProduct product;
    for (double before = 1.0; before > 0.0; before = product.value()) {
        product.multiply(0.37f);
        ASSERT_GE(product.value(), 0.0);
        ASSERT_LT(product.value(), before);
    }
}

}  // namespace
}  // namespace shadowbench::base

#include "metrics/student.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Student, has_the_closed_forms_of_one_two_and_infinitely_many_degrees) {
    for (const double t : {0.0, 0.01, 0.5, 1.0, 3.0, 20.0, 1000.0}) {
        const double cauchy = 0.5 - std::atan(t) / std::numbers::pi;
        EXPECT_NEAR(student_tail(t, 1.0), cauchy, 1e-13) << t;
        EXPECT_NEAR(student_tail(t, 2.0), 0.5 - 0.5 * t / std::sqrt(2.0 + t * t), 1e-13) << t;
        EXPECT_DOUBLE_EQ(student_tail(t, infinity), 0.5 * std::erfc(t / std::sqrt(2.0))) << t;
    }
}

// The density integrated by Simpson's rule, for degrees that are not whole and far tails.
TEST(Student, is_the_integral_of_its_density) {
    for (const double degrees : {1.5, 4.0, 7.3, 60.0, 5000.0}) {
        const double scale = std::exp(std::lgamma(0.5 * (degrees + 1.0)) - std::lgamma(0.5 * degrees)) /
                             std::sqrt(degrees * std::numbers::pi);
        for (const double t : {0.3, 2.0, 6.0}) {
            constexpr int steps = 4000;
            double sum = 0.0;
            for (int i = 0; i <= steps; ++i) {
                const double at = t * i / steps;
                const double weight = i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0;
                sum += weight * std::pow(1.0 + at * at / degrees, -0.5 * (degrees + 1.0));
            }
            EXPECT_NEAR(student_tail(t, degrees), 0.5 - scale * sum * t / steps / 3.0, 1e-10) << degrees << " " << t;
        }
    }
}

TEST(Student, quantiles_invert_the_tail) {
    for (const double degrees : {1.0, 2.5, 4.0, 8.0, 1e5, infinity})
        for (const double tail : {0.5, 0.4, 0.025, 1e-3, 1e-6}) {
            const double t = student_quantile(tail, degrees);
            EXPECT_NEAR(student_tail(t, degrees), tail, 1e-9 * tail) << degrees;
        }
    EXPECT_NEAR(student_quantile(0.025, 4.0), 2.776445, 1e-6);
    EXPECT_NEAR(student_quantile(0.025, infinity), 1.959964, 1e-6);
}

TEST(MeanInterval, of_equal_values_has_no_width_but_that_of_the_known_error) {
    const MeanAndVariance equal = mean_and_variance(std::vector<double>(7, 0.1));
    EXPECT_EQ(equal.mean, 0.1);
    EXPECT_EQ(equal.variance, 0.0);
    const Interval exact = mean_interval(equal, 0.0, 1e-4), normal = mean_interval(equal, 4.0, 0.025);
    EXPECT_EQ(exact.low, 0.1);
    EXPECT_EQ(exact.high, 0.1);
    EXPECT_NEAR(normal.high, 0.1 + 2.0 * 1.959964, 1e-5);
}

double normal(base::Random& random) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * random.uniform());
}

// Student's interval is exact; Welch and Satterthwaite's is approximate.
TEST(MeanInterval, holds_as_often_as_it_says) {
    constexpr int rounds = 20000;
    for (const double known_sd : {0.0, 0.2, 0.5, 2.0}) {
        base::Random random(7);
        int held = 0;
        for (int round = 0; round < rounds; ++round) {
            std::vector<double> sample(5);
            const double shift = known_sd * normal(random);
            for (double& value : sample) value = 3.0 + shift + normal(random);
            const Interval interval = mean_interval(mean_and_variance(sample), known_sd * known_sd, 0.025);
            held += interval.low <= 3.0 && 3.0 <= interval.high;
        }
        EXPECT_GE(held, 0.93 * rounds) << known_sd;
        EXPECT_LE(held, 0.97 * rounds) << known_sd;
    }
}

}  // namespace
}  // namespace shadowbench::metrics

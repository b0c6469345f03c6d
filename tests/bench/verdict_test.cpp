#include "bench/verdict.h"

#include <gtest/gtest.h>

#include <limits>

namespace shadowbench::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double noise_tolerance = 0.125;  // of 16 rays a pixel

results::Cell cell(double curve_max, double bound) {
    results::Cell cell;
    cell.error_bound = bound;
    cell.curve = results::CurveErrors{};
    cell.curve->norms = {curve_max, 0.01, 0.005, 0.02};
    cell.lookup = results::LookupErrors{{0.5, 0.2, 0.1, 0.4}, 0.0};
    cell.nodes = {1, 8, 8, {}};
    return cell;
}

void expect(results::Cell judged, results::Verdict verdict, const std::string& says,
            const techniques::Promises& promises = {}) {
    judge(judged, promises, noise_tolerance);
    EXPECT_STREQ(to_string(judged.verdict), to_string(verdict)) << judged.verdict_why;
    EXPECT_NE(judged.verdict_why.find(says), std::string::npos) << judged.verdict_why;
}

TEST(Verdict, of_a_broken_promise_is_failed_whatever_the_figures) {
    results::Cell broken = cell(0.0, 0.5);
    broken.status = results::CellStatus::failed;
    broken.reason = "cell (3, 4): the value rises";
    expect(broken, results::Verdict::failed, "cell (3, 4): the value rises");
}

// The curve check has tested the bound; a loose bound, well above the noise, is kept too.
TEST(Verdict, of_a_bound_that_held_is_kept) {
    expect(cell(0.3, 0.4), results::Verdict::kept, "curve error 0.3, promised 0.4");
    expect(cell(0.0, 0.0), results::Verdict::kept, "promised 0");
}

TEST(Verdict, without_a_bound_goes_by_the_noise_tolerance) {
    expect(cell(0.125, infinity), results::Verdict::kept, "within the noise tolerance 0.125");
    expect(cell(0.1251, infinity), results::Verdict::degraded, "at most 8 nodes");
    expect(cell(0.1251, infinity), results::Verdict::degraded, "curve error 0.125, noise tolerance 0.125");
}

TEST(Verdict, of_an_opaque_technique_in_a_translucent_scene_ignores_its_bound) {
    results::Cell opaque = cell(0.4, 0.0);
    opaque.outside_promise = true;
    expect(opaque, results::Verdict::degraded, "made for opaque scenes");
    opaque.curve->norms.max = 0.1;
    expect(opaque, results::Verdict::kept, "within the noise tolerance");
}

TEST(Verdict, reports_rise_and_fall_if_neither_is_excluded) {
    results::Cell published = cell(0.3, 0.4);
    published.curve->rise = 0.25;
    published.curve->lowest = -0.125;
    expect(published, results::Verdict::kept, "promised 0.4; rises by up to 0.25; falls to -0.125",
           {.monotone = false, .unit_range = false});
}

TEST(Verdict, names_a_promise_for_the_ends_only) {
    results::Cell series = cell(0.4, infinity);
    expect(series, results::Verdict::degraded, "exact only before and behind", {.localised = false});
}

TEST(Verdict, names_an_approximation) {
    expect(cell(0.4, infinity), results::Verdict::degraded, "approximates, by up to 0.11 even behind all",
           {.localised = false, .approximate = true, .leak = 1.0 / 9.0});
}

TEST(Verdict, of_a_technique_that_stores_nothing_goes_by_the_rms_of_its_lookups) {
    results::Cell traced = cell(0.0, infinity);
    traced.curve.reset();
    expect(traced, results::Verdict::degraded, "lookup error rms 0.2");
    traced.lookup->norms.rms = 0.12;
    expect(traced, results::Verdict::kept, "lookup error rms 0.12");
    // A bound on the error of functions does not apply to a technique without functions.
    traced.error_bound = 1.0;
    traced.lookup->norms.rms = 0.2;
    expect(traced, results::Verdict::degraded, "stores no function");
}

}  // namespace
}  // namespace shadowbench::bench

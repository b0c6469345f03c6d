// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 7, and what section 1 makes of it.
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/equal_error.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_rows.h"

namespace shadowbench::claims::lokovic {
namespace {

void add_figure_7_table(const Rows& measured, PaperReport& report) {
    Table table{
        "Figure 7: deep maps and depth maps with equal numbers of samples, 256 x 256 pixels, over the width of a "
        "pixel; errors over the whole picture, where a deep lookup weighs the means of up to 4 pixels, or reads the "
        "one whose centre is nearest, and at the middles of pixels, where both read one",
        {"N", "0.5 / sqrt N", "deep ns", "deep ns, nearest", "depth ns", "deep bytes", "deep bytes, not compressed",
         "depth bytes", "deep rms, picture", "deep rms, picture, nearest", "depth rms, picture", "depth rms, middles",
         "deep / depth rms, middles", "nodes a pixel"},
        {}};
    for (std::size_t i = 0; i < measured.rows.size(); ++i) {
        const Row& r = measured.rows[i];
        const AtMiddles& middles = measured.middles[i];
        const auto ns = [&](std::size_t map) { return to_text(measured.ns.time(map)); };
        table.rows.push_back({std::to_string(r.samples), fmt::format("{:.3g}", 0.5 / std::sqrt(r.samples)),
                              ns(Rows::deep(i)), ns(Rows::nearest(i)), ns(Rows::depth(i)),
                              bytes_text(r.deep_bytes.value), bytes_text(r.lossless_bytes.value),
                              bytes_text(r.depth_bytes.value), to_text(r.deep_error), to_text(r.nearest_error),
                              to_text(r.depth_error), to_text(middles.depth_error), to_text(middles.ratio),
                              fmt::format("{:.2f}", r.nodes)});
    }
    report.tables.push_back(std::move(table));
}

// "1 at N = 1, 1.1 [1, 1.2] at N = 4"
template <class Of>
std::string at_each_number(const Of& of, std::size_t first = 0) {
    std::string text;
    for (std::size_t row = first; row < std::size(all_samples); ++row)
        text += fmt::format("{}{} at N = {}", row == first ? "" : ", ", of(row), all_samples[row]);
    return text;
}
std::string at_each_number(const std::vector<Value>& values) {
    return at_each_number([&](std::size_t row) { return to_text(values[row]); });
}

Judged all_alike(const std::vector<Value>& ratios) {
    std::vector<Judged> each;
    for (const Value& ratio : ratios) each.push_back(judge_alike(ratio, exactly(1.0)));
    return in_all(each);
}

// Section 4: the tolerance against the noise of the samples.
void tolerance(const Rows& measured, PaperReport& report) {
    std::vector<Judged> no_worse, smaller;
    std::vector<Value> errors, bytes;
    for (std::size_t row = few; row < measured.rows.size(); ++row) {
        const Row& r = measured.rows[row];
        errors.push_back(measured.middles[row].compressed);
        bytes.push_back(r.deep_bytes / r.lossless_bytes);
        no_worse.push_back(judge_alike(largest(errors.back(), exactly(1.0)), exactly(1.0)));
        smaller.push_back(judge_significant(bytes.back(), exactly(1.0)));
    }
    const std::string measured_text = fmt::format(
        "error rms with compression over that without, at the middles of pixels: {}; bytes with compression over those "
        "without: {}",
        at_each_number([&](std::size_t row) { return to_text(errors[row - few]); }, few),
        at_each_number([&](std::size_t row) { return to_text(bytes[row - few]); }, few));
    std::vector<Value> values = errors;
    values.insert(values.end(), bytes.begin(), bytes.end());
    report.claims.push_back(
        {"section 4",
         "at any sampling rate a tolerance, 0.25 / sqrt N, allows significant compression without compromising shadow "
         "quality",
         measured_text, both(in_all(no_worse), in_all(smaller)),
         "By both halves, at each N but 1, where one sample leaves nothing to compress. A smaller error counts as "
         "alike. The error without compression is that of filtering all depth samples of the pixel.",
         std::move(values)});
}

// Section 4, and what figure 7 builds on it.
void equal_samples(const Rows& measured, PaperReport& report) {
    std::vector<Value> differences;
    bool within = true;
    for (const AtMiddles& middles : measured.middles) {
        differences.push_back(exactly(middles.difference));
        within = within && middles.difference <= 1.001;  // rounding
    }
    report.claims.push_back(
        {"section 4",
         "evaluating a pixel's function is equivalent to percentage closer filtering of all depth samples within the "
         "pixel's filter, to within the tolerance",
         "largest difference in tolerances: " +
             at_each_number([&](std::size_t row) { return fmt::format("{:.3g}", differences[row].value); }),
         by_construction(within),
         "Over 2048 lookups at the middles of pixels, for each of three seeds of the light rays.", differences});

    std::vector<Value> at_middles, over_picture, nearest;
    for (const AtMiddles& middles : measured.middles) at_middles.push_back(middles.ratio);
    for (const Row& r : measured.rows) {
        over_picture.push_back(r.deep_error / r.depth_error);
        nearest.push_back(r.nearest_error / r.depth_error);
    }
    std::vector<Value> values = at_middles;
    values.insert(values.end(), over_picture.begin(), over_picture.end());
    values.insert(values.end(), nearest.begin(), nearest.end());
    report.claims.push_back(
        {"section 6, figure 7",
         "N samples a lookup achieve the same accuracy as a deep map of N samples a pixel at its minimum filter size",
         fmt::format("error rms of the deep map over that of the depth map, at the middles of pixels: {}; over the "
                     "whole picture: {}; and there by the pixel whose centre is nearest: {}",
                     at_each_number(at_middles), at_each_number(over_picture), at_each_number(nearest)),
         in_readings({all_alike(at_middles), all_alike(over_picture), all_alike(nearest)}),
         "Judged at each N, in three readings. At the middles of pixels the filter is the deep map's minimum. "
         "Elsewhere a filter as wide as a pixel takes part of the means of up to 4 pixels, and so depth samples "
         "outside it. This makes the deep map less noisy than the depth map, and blurs by an error that does not fall "
         "with N. Weighted by pixel centres, as in section 3.4, a box as wide as a pixel takes the one pixel whose "
         "centre is nearest.",
         std::move(values)});
}

// What a depth map costs at the error of the deep map of the most samples.
struct EqualCost {
    Value at_middles, over_picture, nearest;
};

template <class Cost>
EqualCost depth_cost(const Rows& measured, const Cost& cost) {
    std::vector<CostAtError> middles, picture;
    for (std::size_t row = 0; row < measured.rows.size(); ++row) {
        middles.push_back({exactly(measured.middles[row].depth_error.value), cost(row)});
        picture.push_back({measured.rows[row].depth_error, cost(row)});
    }
    // At the middles the ratio of both errors is known better than either.
    const AtMiddles& last = measured.middles[most];
    return {cost_at(last.depth_error.value * last.ratio, middles), cost_at(measured.rows[most].deep_error, picture),
            cost_at(measured.rows[most].nearest_error, picture)};
}

// Of section 1: the size and the time of equivalent depth maps.
void equal_errors(const Rows& measured, PaperReport& report) {
    const Value deep_bytes = measured.rows[most].deep_bytes, deep_ns = measured.ns.time(Rows::deep(most)),
                nearest_ns = measured.ns.time(Rows::nearest(most));
    const EqualCost bytes = depth_cost(measured, [&](std::size_t row) { return measured.rows[row].depth_bytes; }),
                    ns = depth_cost(measured, [&](std::size_t row) { return measured.ns.time(Rows::depth(row)); });
    const Value smaller[] = {bytes.at_middles / deep_bytes, bytes.over_picture / deep_bytes, bytes.nearest / deep_bytes,
                             measured.rows[most].depth_bytes / deep_bytes};
    const Value faster[] = {ns.at_middles / deep_ns, ns.over_picture / deep_ns, ns.nearest / nearest_ns,
                            measured.ns.ratio(Rows::depth(most), Rows::deep(most))};
    const char* readings =
        "Judged in four readings of what is equivalent to the deep map with 256 samples a pixel, near the paper's 250: "
        "a depth map of the same error at the middles of pixels, where the filter is the deep map's minimum; of the "
        "same error over the whole picture, where that map's blur counts too; the same with deep lookups by pixel "
        "centres; and a depth map of as many samples, as in figure 7. At equal error depth maps are interpolated over "
        "N.";
    const auto text = [](const Value(&of)[4], const char* what) {
        return fmt::format(
            "{} times {} at equal error at the middles of pixels, {} at equal error over the picture, {} there by "
            "pixel centres, {} with as many samples",
            to_text(of[0]), what, to_text(of[1]), to_text(of[2]), to_text(of[3]));
    };
    const auto judged = [](const Value(&of)[4], Judged (*judge)(const Value&)) {
        std::vector<Judged> each;
        for (const Value& one : of) each.push_back(judge(one));
        return in_readings(each);
    };
    report.claims.push_back(
        {"section 1",
         "for high-quality shadows, deep maps are smaller than equivalent depth maps by an order of magnitude",
         text(smaller, "smaller"),
         judged(smaller, [](const Value& times) { return judge_gain(10.0, times); }),
         fmt::format("{} Of bytes held.", readings),
         {smaller[0], smaller[1], smaller[2], smaller[3]}});
    report.claims.push_back(
        {"section 1",
         "for high-quality shadows, deep maps are significantly faster to access than equivalent depth maps",
         text(faster, "faster"),
         judged(faster, [](const Value& times) { return judge_significant(exactly(1.0), times); }),
         fmt::format("{} Lookups are of the whole picture.", readings),
         {faster[0], faster[1], faster[2], faster[3]}});
}

// Times of figure 7.
void times_over_samples(const Rows& measured, PaperReport& report) {
    std::vector<Value> slower, nearest_slower;
    std::vector<std::size_t> filtered, nearest;
    for (std::size_t row = 0; row < std::size(all_samples); ++row) {
        slower.push_back(measured.slower(row));
        nearest_slower.push_back(measured.nearest_slower(row));
        filtered.push_back(Rows::deep(row));
        nearest.push_back(Rows::nearest(row));
    }
    const auto sides = [](const std::vector<Value>& over_depth) {
        std::vector<Judged> each;
        for (std::size_t row = 0; row < over_depth.size(); ++row)
            each.push_back(row <= sixteen ? judge_less(exactly(1.0), over_depth[row])
                                          : judge_less(over_depth[row], exactly(1.0)));
        return in_all(each);
    };
    std::vector<Value> all_slower = slower;
    all_slower.insert(all_slower.end(), nearest_slower.begin(), nearest_slower.end());
    report.claims.push_back(
        {"section 6, figure 7", "depth maps are faster only at 4 x 4 samples and fewer",
         fmt::format("deep over depth, times: {}; by the pixel whose centre is nearest: {}", at_each_number(slower),
                     at_each_number(nearest_slower)),
         in_readings({sides(slower), sides(nearest_slower)}),
         "Judged at each N, to both sides: up to 16 the depth map must be the faster one, beyond 16 the deep map. Two "
         "readings of the deep map's filter: pixels by their covered parts, or by their centres. The rows are those of "
         "equal N, as the paper's; over the whole picture their errors are not equal. Where the times cross depends on "
         "the cost of a search against that of a depth test.",
         std::move(all_slower)});
    const auto from_four = [](const std::vector<std::size_t>& all) { return std::span(all).subspan(few); };
    const Value growth = measured.ns.growth(from_four(filtered)),
                nearest_growth = measured.ns.growth(from_four(nearest)), from_one = measured.ns.growth(filtered),
                nearest_from_one = measured.ns.growth(nearest);
    report.claims.push_back(
        {"section 6, figure 7",
         "deep lookup times are virtually constant as N grows",
         fmt::format(
             "of N = 4 to 256, more samples take at most {} times as long as fewer, and of N = 1 to 256 {} times; by "
             "the pixel whose centre is nearest {} and {}",
             to_text(growth), to_text(from_one), to_text(nearest_growth), to_text(nearest_from_one)),
         in_readings({judge_constant(growth), judge_constant(from_one), judge_constant(nearest_growth),
                      judge_constant(nearest_from_one)}),
         "Judged over the rows of the table, in two readings of the paper's: it has rows of fewer than 4 x 4 samples, "
         "and whether one of them is N = 1 is not known. There a function is a single step, with hardly anything to "
         "search. And in two readings of the filter, as above. 64 times the samples would cost 64 times the tests in a "
         "depth map.",
         {growth, from_one, nearest_growth, nearest_from_one}});
    const Value of_depth = measured.ns.ratio(Rows::depth(most), Rows::depth(few));
    report.claims.push_back({"section 6, figure 7",
                             "depth maps become much more expensive as the error threshold decreases",
                             fmt::format("N = 256 takes {} times as long as N = 4", to_text(of_depth)),
                             judge_much_less(exactly(1.0), of_depth),
                             "Each lookup compares N depths.",
                             {of_depth}});
}

// Section 4, by the rows of figure 7.
void against_equal_samples(const Rows& measured, PaperReport& report) {
    std::vector<Judged> cheaper;
    for (std::size_t row = few; row < measured.rows.size(); ++row) {
        const Row& r = measured.rows[row];
        cheaper.push_back(both(judge_significant(r.deep_bytes, r.depth_bytes),
                               judge_significant(measured.slower(row), exactly(1.0))));
    }
    const Value bytes = measured.rows[most].deep_bytes / measured.rows[most].depth_bytes, ns = measured.slower(most);
    report.claims.push_back(
        {"section 4",
         "a deep map is typically considerably cheaper to store and access than a depth map of as many samples",
         fmt::format("at N = 256 {} of its bytes and {} of its time", to_text(bytes), to_text(ns)),
         in_most(cheaper),
         "By both halves, over the rows of figure 7's table from N = 4 on. Considerably counts as significantly.",
         {bytes, ns}});
}

void sizes_over_samples(const Rows& measured, PaperReport& report) {
    std::vector<std::pair<double, double>> bytes, shares;
    for (const Row& r : measured.rows) {
        if (r.samples < 16) continue;
        bytes.emplace_back(r.samples, r.deep_bytes.value);
        shares.emplace_back(r.samples, r.deep_bytes.value / r.depth_bytes.value);
    }
    const Value exponent = fitted_exponent(bytes), of_depths = fitted_exponent(shares);
    const Value times = measured.rows[most].deep_bytes / measured.rows[sixteen].deep_bytes;
    report.claims.push_back(
        {"section 6, figure 7",
         "deep maps grow very slowly in size as the error falls: as N^(1/4), section 4",
         fmt::format("bytes grow as N^{}; 16 times the samples: {} times the bytes", to_text(exponent), to_text(times)),
         judge_at_most_exponent(0.25, exponent),
         "The law is a bound: section 4 writes O(N^(1/4)). Fitted over N from 16 to 256, with the interval of the fit "
         "(Student's t); that of the bytes is over three seeds of the light rays.",
         {exponent, times}});
    report.claims.push_back(
        {"section 4",
         "a deep map is smaller than the depth map of as many samples by a factor that grows at least as N^(1/2), "
         "typically as N^(3/4)",
         fmt::format("deep over depth, bytes: as N^{}", to_text(of_depths)),
         both(judge_at_most_exponent(-0.5, of_depths), judge_at_most_exponent(-0.75, of_depths)),
         "By both bounds, which the paper writes with an Omega. Fitted over N from 16 to 256.",
         {of_depths}});
}

}  // namespace

void sampling(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    const Rows measured = measure_rows(context);
    add_figure_7_table(measured, report);
    tolerance(measured, report);
    equal_samples(measured, report);
    equal_errors(measured, report);
    times_over_samples(measured, report);
    against_equal_samples(measured, report);
    sizes_over_samples(measured, report);
}

}  // namespace shadowbench::claims::lokovic

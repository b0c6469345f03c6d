// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 7, and what section 1 makes of it.
#include <cmath>
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
        "pixel; errors over the whole picture, where a deep lookup weighs the means of up to 4 pixels, and at the "
        "middles of pixels, where it reads one",
        {"N", "0.5 / sqrt N", "deep ns", "depth ns", "deep bytes", "depth bytes", "deep rms, picture",
         "depth rms, picture", "depth rms, middles", "deep / depth rms, middles", "nodes a pixel"},
        {}};
    for (std::size_t i = 0; i < measured.rows.size(); ++i) {
        const Row& r = measured.rows[i];
        const AtMiddles& middles = measured.middles[i];
        table.rows.push_back({std::to_string(r.samples), fmt::format("{:.3g}", 0.5 / std::sqrt(r.samples)),
                              to_text(measured.ns.time(Rows::deep(i))), to_text(measured.ns.time(Rows::depth(i))),
                              bytes_text(r.deep_bytes.value), bytes_text(r.depth_bytes.value), to_text(r.deep_error),
                              to_text(r.depth_error), to_text(middles.depth_error), to_text(middles.ratio),
                              fmt::format("{:.2f}", r.nodes)});
    }
    report.tables.push_back(std::move(table));
}

// "1 at N = 1, 1.1 [1, 1.2] at N = 4"
template <class Of>
std::string at_each_number(const Of& of) {
    std::string text;
    for (std::size_t row = 0; row < std::size(all_samples); ++row)
        text += fmt::format("{}{} at N = {}", row == 0 ? "" : ", ", of(row), all_samples[row]);
    return text;
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

    std::vector<Value> at_middles, over_picture;
    for (const AtMiddles& middles : measured.middles) at_middles.push_back(middles.ratio);
    for (const Row& r : measured.rows) over_picture.push_back(r.deep_error / r.depth_error);
    const auto alike = [](const std::vector<Value>& ratios) {
        std::vector<Judged> each;
        for (const Value& ratio : ratios) each.push_back(judge_alike(ratio, exactly(1.0)));
        return in_all(each);
    };
    std::vector<Value> values = at_middles;
    values.insert(values.end(), over_picture.begin(), over_picture.end());
    report.claims.push_back(
        {"section 6, figure 7",
         "N samples a lookup achieve the same accuracy as a deep map of N samples a pixel at its minimum filter size",
         fmt::format("error rms of the deep map over that of the depth map, at the middles of pixels: {}; over the "
                     "whole picture: {}",
                     at_each_number([&](std::size_t row) { return to_text(at_middles[row]); }),
                     at_each_number([&](std::size_t row) { return to_text(over_picture[row]); })),
         in_readings({alike(at_middles), alike(over_picture)}),
         "Judged at each N, in two readings. At the middles of pixels the filter is the deep map's minimum. Elsewhere "
         "a "
         "filter as wide as a pixel takes part of the means of up to 4 pixels, and so depth samples outside it. This "
         "makes the deep map less noisy than the depth map, and blurs by an error that does not fall with N.",
         std::move(values)});
}

// What a depth map costs at the error of the deep map of the most samples.
struct EqualCost {
    Value at_middles, over_picture;
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
    return {cost_at(last.depth_error.value * last.ratio, middles), cost_at(measured.rows[most].deep_error, picture)};
}

// Of section 1: the size and the time of equivalent depth maps.
void equal_errors(const Rows& measured, PaperReport& report) {
    const Value deep_bytes = measured.rows[most].deep_bytes, deep_ns = measured.ns.time(Rows::deep(most));
    const EqualCost bytes = depth_cost(measured, [&](std::size_t row) { return measured.rows[row].depth_bytes; }),
                    ns = depth_cost(measured, [&](std::size_t row) { return measured.ns.time(Rows::depth(row)); });
    const Value smaller[] = {bytes.at_middles / deep_bytes, bytes.over_picture / deep_bytes,
                             measured.rows[most].depth_bytes / deep_bytes};
    const Value faster[] = {ns.at_middles / deep_ns, ns.over_picture / deep_ns};
    const char* readings =
        "Depth maps are interpolated over N to the error of the deep map with 256 samples a pixel, near the paper's "
        "250. Judged in two readings: at the error at the middles of pixels, where the filter is the deep map's "
        "minimum; and at the error over the whole picture, where that map's blur counts too.";
    report.claims.push_back(
        {"section 1",
         "for high-quality shadows, deep maps are smaller than equivalent depth maps by an order of magnitude",
         fmt::format("{} times smaller at equal error at the middles of pixels, {} at equal error over the picture; {} "
                     "with as many samples",
                     to_text(smaller[0]), to_text(smaller[1]), to_text(smaller[2])),
         in_readings({judge_gain(10.0, smaller[0]), judge_gain(10.0, smaller[1])}),
         fmt::format("{} Of bytes held.", readings),
         {smaller[0], smaller[1], smaller[2]}});
    report.claims.push_back(
        {"section 1",
         "for high-quality shadows, deep maps are significantly faster to access than equivalent depth maps",
         fmt::format("{} times faster at equal error at the middles of pixels, {} at equal error over the picture",
                     to_text(faster[0]), to_text(faster[1])),
         in_readings({judge_significant(exactly(1.0), faster[0]), judge_significant(exactly(1.0), faster[1])}),
         fmt::format("{} Lookups are of the whole picture.", readings),
         {faster[0], faster[1]}});
}

// Times of figure 7.
void times_over_samples(const Rows& measured, PaperReport& report) {
    std::vector<Judged> sides;
    std::vector<Value> slower;
    std::vector<std::size_t> filtered;
    for (std::size_t row = 0; row < std::size(all_samples); ++row) {
        slower.push_back(measured.slower(row));
        sides.push_back(row <= sixteen ? judge_less(exactly(1.0), slower.back())
                                       : judge_less(slower.back(), exactly(1.0)));
        if (row >= few) filtered.push_back(Rows::deep(row));
    }
    report.claims.push_back(
        {"section 6, figure 7", "depth maps are faster only at 4 x 4 samples and fewer",
         "deep over depth, times: " + at_each_number([&](std::size_t row) { return to_text(slower[row]); }),
         in_all(sides),
         "Judged at each N: up to 16 the depth map must be the faster one, beyond 16 the deep map. The rows are those "
         "of equal N, as the paper's; over the whole picture their errors are not equal. Where the times cross depends "
         "on the cost of a search against that of a depth test.",
         slower});
    const Value spread = measured.ns.spread(filtered);
    report.claims.push_back(
        {"section 6, figure 7",
         "deep lookup times are virtually constant as N grows",
         fmt::format("from N = 4 to 256 the slowest takes {} times as long as the fastest", to_text(spread)),
         judge_constant(spread),
         "Judged over all N of the table but 1: the paper's has rows of fewer than 4 x 4 samples. "
         "64 times the samples would cost 64 times the tests in a depth map.",
         {spread}});
    const Value growth = measured.ns.ratio(Rows::depth(most), Rows::depth(few));
    report.claims.push_back({"section 6, figure 7",
                             "depth maps become much more expensive as the error threshold decreases",
                             fmt::format("N = 256 takes {} times as long as N = 4", to_text(growth)),
                             judge_much_less(exactly(1.0), growth),
                             "Each lookup compares N depths.",
                             {growth}});
}

void sizes_over_samples(const Rows& measured, PaperReport& report) {
    std::vector<std::pair<double, double>> bytes;
    for (const Row& r : measured.rows)
        if (r.samples >= 16) bytes.emplace_back(r.samples, r.deep_bytes.value);
    const Value exponent = fitted_exponent(bytes);
    const Value times = measured.rows[most].deep_bytes / measured.rows[sixteen].deep_bytes;
    report.claims.push_back(
        {"section 6, figure 7",
         "deep maps grow very slowly in size as the error falls: as N^(1/4), section 4",
         fmt::format("bytes grow as N^{}; 16 times the samples: {} times the bytes", to_text(exponent), to_text(times)),
         judge_exponent(0.25, exponent),
         "Fitted over N from 16 to 256, with the interval of the fit (Student's t); that of the bytes is over three "
         "seeds of the light rays.",
         {exponent, times}});
}

}  // namespace

void sampling(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    const Rows measured = measure_rows(context);
    add_figure_7_table(measured, report);
    equal_samples(measured, report);
    equal_errors(measured, report);
    times_over_samples(measured, report);
    sizes_over_samples(measured, report);
}

}  // namespace shadowbench::claims::lokovic

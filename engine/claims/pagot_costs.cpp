// Pagot, Comba, Oliveira 2004: what a test on several depths costs (section 6), what selecting them costs (section
// 4.3), and what they take to store (section 4.4).
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/pagot.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::pagot {
namespace {

const std::vector<std::string> smaller = {"rays.resolution=256"};  // of a quick run

// Lookups of several kernels.
void shadow_tests(const Context& context) {
    TimedMaps timed;
    timed.add(
        context, flat,
        {fmt::format("techniques=[{},{},{},{}]", request({1, 3}), request({2, 3}), request({3, 3}), request({1, 4}))},
        {"rays.resolution=256", "receivers.resolution=[256,192]"}, 16384);
    const Turns ns = timed.take({}, {99, 99, 0.0});
    const Value two = ns.ratio(1, 0), three = ns.ratio(2, 0), two_instead = ns.ratio(1, 3);
    const auto slightly = [](const Value& factor) {
        return both(judge_less(exactly(1.0), factor), judge_constant(factor));
    };
    context.report->claims.push_back(
        {"section 6",
         "a multiple-depth shadow test is slightly more expensive than a conventional one",
         fmt::format("a lookup of 3 x 3 cells on two depths takes {} times as long as on one, on three depths {}",
                     to_text(two), to_text(three)),
         in_all({slightly(two), slightly(three)}),
         "It costs more, and slightly so if by at most a factor of 1.25. All kernels look up the same receivers in "
         "image order. The paper hopes for hardware that makes all comparisons at once; a thread makes one after the "
         "other.",
         {two, three}});
    context.report->claims.push_back(
        {"section 4.4",
         "for static scenes and lights the depths are chosen in advance, and this cost need not be considered",
         fmt::format("a lookup of the 2-SM with 3 x 3 takes {} times as long as of the 1-SM with 4 x 4",
                     to_text(two_instead)),
         by_construction(true),
         "What is built before is not built again. The paper says no more; the time of the smaller kernel without that "
         "cost stands beside it, and is not judged.",
         {two_instead}});
}

void selections(const Context& context) {
    const auto with = [](const char* select, int q) {
        return fmt::format(R"({{"type":"multi_depth","n":2,"select":"{}","q":{}}})", select, q);
    };
    const SeededLight light(context, flat,
                            {fmt::format("techniques=[{},{},{},{}]", with("maximum", 9), with("sorted", 9),
                                         with("maximum", 25), with("sorted", 25))},
                            smaller);
    const Turns ms = light.build_turns({}, fixed_rounds);
    const Value few = ms.ratio(0, 1), many = ms.ratio(2, 3);
    context.report->claims.push_back(
        {"section 4.3",
         "the maximum is the cheapest way to select a depth, since the samples need not be sorted",
         fmt::format("a 2-SM builds in {} of the time of one with sorted samples (q = 9), and in {} (q = 25)",
                     to_text(few), to_text(many)),
         in_all({judge_less(few, exactly(1.0)), judge_less(many, exactly(1.0))}),
         "Whole builds from captured rays, on one thread. Neither way sorts where all samples are equal.",
         {few, many}});
}

void storage(const Context& context) {
    std::string requests;
    for (int n = 1; n <= 4; ++n) requests += fmt::format(R"({}{{"type":"multi_depth","n":{}}})", n == 1 ? "" : ",", n);
    const SeededLight light(context, flat, {fmt::format("techniques=[{}]", requests)}, smaller);
    const double cells = static_cast<double>(light.layout().width) * light.layout().height;
    bool kept = true;
    std::vector<Value> values;
    std::vector<std::string> texts;
    for (const bench::Maps& maps : light.build(0)) {
        const double bytes = static_cast<double>(bench::bytes(maps)) / cells;
        values.push_back(exactly(bytes));
        texts.push_back(to_text(values.back()));
        kept = kept && static_cast<std::size_t>(bytes) == sizeof(float) * values.size();
    }
    context.report->claims.push_back(
        {"section 4.4", "a 4-SM fits into one texture of four channels of 32 bits",
         fmt::format("bytes a cell with 1, 2, 3 and 4 depths: {}", fmt::join(texts, ", ")), by_construction(kept),
         "Depths are floats of 32 bits. Eight depths of 16 bits, section 7, are not implemented.", std::move(values)});
}

}  // namespace

void costs(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    shadow_tests(context);
    selections(context);
    storage(context);
}

}  // namespace shadowbench::claims::pagot

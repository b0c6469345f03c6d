// Pagot, Comba, Oliveira 2004: figures 1, 6 and 7, and what the abstract says of them. The paper compares pictures with
// each other by eye; so do the claims here, by the difference of what a camera sees.
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "claims/intervals.h"
#include "claims/pagot_views.h"

namespace shadowbench::claims::pagot {
namespace {

const std::string over_lights = "; means over five lights and views";  // for titles of tables

// A distance of two pictures.
struct Distance {
    Value rms, flip;

    std::string text() const { return fmt::format("{}, {}", to_text(rms), to_text(flip)); }
    std::string text_by_name() const { return fmt::format("rms {}, FLIP {}", to_text(rms), to_text(flip)); }
};
Distance distance(const Apart& apart) {
    return {mean_of(apart.rms), mean_of(apart.flip)};
}
Distance ratio(const Apart& a, const Apart& b) {
    return {mean_ratio_of(a.rms, b.rms), mean_ratio_of(a.flip, b.flip)};
}

// `smaller` on several depths looks like `larger` on one. Without the paper's idea, the smaller kernel on one depth
// would take its place.
void looks_like(Views& views, const char* place, const Kernel& smaller, const Kernel& larger, PaperReport& report) {
    const Kernel without{1, smaller.side};
    const Difference &ours = views.difference(smaller, larger), &plain = views.difference(without, larger);
    const Distance apart = distance(ours.of_means), share = ratio(ours.of_means, plain.of_means),
                   apart_in_one = distance(ours.in_one_phase),
                   share_in_one = ratio(ours.in_one_phase, plain.in_one_phase),
                   of_phase = distance(views.numbers(larger).half_a_cell_on);
    std::vector<Value> values;
    for (const Distance& one : {apart, share, apart_in_one, share_in_one, of_phase})
        values.insert(values.end(), {one.rms, one.flip});
    report.claims.push_back(
        {place, fmt::format("{} looks like {}", title(smaller), title(larger)),
         fmt::format("means over phases of the cells differ by {}: {} and {} of what {} differs. Not judged: pictures "
                     "in one phase by {}: {} and {} of it, where {} differs from itself half a cell on by {}",
                     apart.text_by_name(), to_text(share.rms), to_text(share.flip), title(without),
                     apart_in_one.text_by_name(), to_text(share_in_one.rms), to_text(share_in_one.flip), title(larger),
                     of_phase.text_by_name()),
         both(judge_likeness(share.rms), judge_likeness(share.flip)),
         "A kernel of an odd side lies around the middle of a cell and one of an even side around a corner, so that in "
         "one phase their steps lie half a cell apart, whatever the kernels do. There even the exact mean over the "
         "larger kernel's cells, without steps, would be 0.6 of the smaller kernel's difference away at a straight "
         "edge. So the likeness is judged by the means over four phases, where the steps of both lie at the same "
         "places.",
         std::move(values)});
}

void difference_tables(Views& views, const char* figure, PaperReport& report) {
    const auto add = [&](const char* which, Apart Difference::*apart) {
        Table table{fmt::format("{}: how {} differ, rms and FLIP{}", figure, which, over_lights), {"kernel"}, {}};
        for (const Kernel& standard : views.kernels())
            if (standard.n == 1) table.header.push_back(title(standard));
        for (const Kernel& kernel : views.kernels()) {
            std::vector<std::string> row{title(kernel)};
            for (const Kernel& standard : views.kernels()) {
                if (standard.n != 1) continue;
                row.push_back(kernel == standard ? "" : distance(views.difference(kernel, standard).*apart).text());
            }
            table.rows.push_back(std::move(row));
        }
        report.tables.push_back(std::move(table));
    };
    add("means over four phases of the cells", &Difference::of_means);
    add("pictures in one phase", &Difference::in_one_phase);
}

void kernel_table(const Views& views, const char* figure, PaperReport& report) {
    Table table{fmt::format("{}: each kernel by itself; error rms of visibility is against the truth over this width{}",
                            figure, over_lights),
                {"kernel", "picture half a cell on: rms, FLIP", "aliasing rms", "share of receivers in transitions"},
                {}};
    for (const double width : widths) table.header.push_back(fmt::format("error rms, {:g} cells", width));
    for (const Kernel& kernel : views.kernels()) {
        const Views::Numbers& numbers = views.numbers(kernel);
        std::vector<std::string> row{title(kernel), distance(numbers.half_a_cell_on).text(),
                                     to_text(mean_of(numbers.aliasing)), to_text(mean_of(numbers.transition))};
        for (const std::vector<double>& error : numbers.error) row.push_back(to_text(mean_of(error)));
        table.rows.push_back(std::move(row));
    }
    report.tables.push_back(std::move(table));
}

// How far a transition's area is from the standard map's under each light, as a share of it.
std::vector<double> off_standard(const std::vector<double>& transition, const std::vector<double>& standard) {
    std::vector<double> off;
    for (std::size_t i = 0; i < transition.size(); ++i) off.push_back(std::abs(transition[i] / standard[i] - 1.0));
    return off;
}

void figure_7(Views& views, PaperReport& report) {
    const Kernel standard{1, 4}, two{2, 3}, three{3, 3};
    const Difference &of_two = views.difference(two, standard), &of_three = views.difference(three, standard);
    const Distance share = ratio(of_three.of_means, of_two.of_means),
                   in_one = ratio(of_three.in_one_phase, of_two.in_one_phase);
    const std::vector<double>& wide = views.numbers(standard).transition;
    const std::vector<double> two_off = off_standard(views.numbers(two).transition, wide),
                              three_off = off_standard(views.numbers(three).transition, wide);
    std::vector<double> nearer;
    for (std::size_t i = 0; i < wide.size(); ++i) nearer.push_back(two_off[i] - three_off[i]);
    const Value area = mean_of(nearer);
    report.claims.push_back(
        {"section 5, figure 7",
         "the 3-SM makes a transition closer to that of the standard map than the 2-SM does",
         fmt::format("means over phases of the cells differ by {} (rms) and {} (FLIP) of what those of the 2-SM do; "
                     "its transition's area is {} of the standard map's off, that of the 2-SM {}, so that the 3-SM is "
                     "{} nearer. Not judged: pictures in one phase differ by {} and {}",
                     to_text(share.rms), to_text(share.flip), to_text(mean_of(three_off)), to_text(mean_of(two_off)),
                     to_text(area), to_text(in_one.rms), to_text(in_one.flip)),
         in_readings({both(judge_less(share.rms, exactly(1.0)), judge_less(share.flip, exactly(1.0))),
                      judge_less(exactly(0.0), area)}),
         "Both have kernels of 3 x 3, the standard map has 4 x 4. The paper does not say how the transition is closer: "
         "its words in brackets are of its width, its figure shows pictures. Both are read.",
         {share.rms, share.flip, mean_of(three_off), mean_of(two_off), area, in_one.rms, in_one.flip}});
    const Value of_two_share = mean_ratio_of(views.numbers(two).transition, wide),
                of_three_share = mean_ratio_of(views.numbers(three).transition, wide);
    report.claims.push_back(
        {"section 5, figure 7",
         "the 2-SM's transition is thinner than that of the standard map",
         fmt::format("it covers {} of the pixels that are neither lit nor dark with the standard map; that of the 3-SM "
                     "covers {}",
                     to_text(of_two_share), to_text(of_three_share)),
         judge_less(of_two_share, exactly(1.0)),
         "The area of the transitions, by which their widths are compared, without what balls seem to shade of "
         "themselves.",
         {of_two_share, of_three_share}});
}

// A kernel on several depths, in one of the scenes.
struct Case {
    const Views& views;
    const char* scene;
    Kernel kernel;

    const Views::Numbers& ours() const { return views.numbers(kernel); }
    const Views::Numbers& plain() const { return views.numbers({1, kernel.side}); }
    const Views::Numbers& larger() const { return views.numbers({1, kernel.side + 1}); }
    std::string name() const { return fmt::format("{}, {}", scene, title(kernel)); }
};

// Read over every width of the truth, and with each kernel at the width at which it errs least.
void better_estimates(const std::vector<Case>& cases, PaperReport& report) {
    std::vector<Judged> readings;
    std::vector<std::string> texts(cases.size());
    std::vector<Value> values;
    const auto read = [&](const std::string& name, const auto& share_of) {
        std::vector<Judged> judged;
        for (std::size_t c = 0; c < cases.size(); ++c) {
            const Value share = share_of(cases[c]);
            texts[c] += fmt::format("{}{} {}", texts[c].empty() ? cases[c].name() + ": " : ", ", to_text(share), name);
            judged.push_back(judge_less(share, exactly(1.0)));
            values.push_back(share);
        }
        readings.push_back(in_all(judged));
    };
    for (std::size_t w = 0; w < std::size(widths); ++w)
        read(fmt::format("over {:g} cells", widths[w]),
             [w](const Case& one) { return mean_ratio_of(one.ours().error[w], one.plain().error[w]); });
    read("with both at their best", [](const Case& one) {
        return mean_ratio_of(one.ours().error[one.ours().best_width()], one.plain().error[one.plain().best_width()]);
    });
    report.claims.push_back(
        {"abstract", "a kernel on several depths estimates the percentage of shadow better than on one",
         fmt::format("error rms over that of the same kernel on one depth: {}", fmt::join(texts, "; ")),
         in_readings(readings),
         "The paper does not say of what area the percentage is. It is read over widths of 2 to 6 cells, and with each "
         "kernel at the width at which it errs least. The 2-SM's second depth is the maximum, which makes every shadow "
         "smaller.",
         std::move(values)});
}

void less_aliasing(const std::vector<Case>& cases, PaperReport& report) {
    std::vector<std::string> texts;
    std::vector<Judged> judged;
    std::vector<Value> values;
    for (const Case& one : cases) {
        const Value share = mean_ratio_of(one.ours().aliasing, one.plain().aliasing);
        texts.push_back(fmt::format("{}: {}", one.name(), to_text(share)));
        judged.push_back(judge_significant(share, exactly(1.0)));
        values.push_back(share);
    }
    report.claims.push_back(
        {"section 1", "multiple depths significantly reduce aliasing artifacts",
         fmt::format("aliasing rms over that of the same kernel on one depth: {}", fmt::join(texts, "; ")),
         in_all(judged),
         "Aliasing is what depends on where the cells lie: the difference of pictures in four phases from their mean. "
         "More outcomes make smaller steps, but more of them. The paper adds: with a small increase in cost; a row of its "
         "own has that.",
         std::move(values)});
}

void less_aliasing_with_smaller_kernels(const std::vector<Case>& cases, PaperReport& report) {
    std::vector<std::string> texts;
    std::vector<Judged> judged;
    std::vector<Value> values;
    for (const Case& one : cases) {
        const Value share = mean_ratio_of(one.ours().aliasing, one.larger().aliasing);
        texts.push_back(fmt::format("{}: {}", one.name(), to_text(share)));
        judged.push_back(judge_less(share, exactly(1.0)));
        values.push_back(share);
    }
    report.claims.push_back(
        {"abstract", "with percentage closer filtering, several depths reduce aliasing artifacts using smaller kernels",
         fmt::format("aliasing rms over that of a kernel on one depth with one cell more along each side: {}",
                     fmt::join(texts, "; ")),
         in_all(judged),
         "These are the kernels that figures 1, 6 and 7 compare. Aliasing is that of section 1; the abstract does not "
         "say how much less it is.",
         std::move(values)});
}

}  // namespace

void pictures(const Context& context) {
    const Kernel two{2, 3}, three{3, 3}, three_small{3, 2}, standard{1, 4};
    Views flat_views(context, flat, Surfaces::plane, {{1, 2}, {1, 3}, standard, two, three_small, three}),
        curved_views(context, curved, Surfaces::others, {{1, 3}, standard, two, three});
    PaperReport& report = *context.report;
    const std::vector<Case> cases{{flat_views, "flat", three_small},
                                  {flat_views, "flat", two},
                                  {flat_views, "flat", three},
                                  {curved_views, "curved", two},
                                  {curved_views, "curved", three}};
    better_estimates(cases, report);
    less_aliasing(cases, report);
    less_aliasing_with_smaller_kernels(cases, report);
    looks_like(flat_views, "section 1, figure 1", two, standard, report);
    looks_like(flat_views, "section 5, figure 6", three_small, {1, 3}, report);
    looks_like(flat_views, "section 5, figure 6", three, standard, report);
    looks_like(curved_views, "section 5, figure 7", two, standard, report);
    looks_like(curved_views, "section 5, figure 7", three, standard, report);
    figure_7(curved_views, report);
    difference_tables(flat_views, "Figure 6", report);
    kernel_table(flat_views, "Figure 6", report);
    difference_tables(curved_views, "Figure 7", report);
    kernel_table(curved_views, "Figure 7", report);
}

}  // namespace shadowbench::claims::pagot

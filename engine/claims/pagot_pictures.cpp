// Pagot, Comba, Oliveira 2004: figures 6 and 7. The paper compares pictures with each other by eye; so do the claims
// here, by the difference of what a camera sees. Errors against the truth stand beside them.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/intervals.h"
#include "claims/pagot.h"
#include "claims/seen.h"
#include "render/render.h"

namespace shadowbench::claims::pagot {
namespace {

constexpr std::uint64_t repeats = 3;    // with the cells of the map at other places
const std::string over_places = "; means over three places of the map's cells";  // for titles of tables
constexpr double widths[] = {2, 3, 4};  // cells, of the truth's footprints
constexpr std::size_t judged = 4096;    // receivers compared with the truth

// The visibilities of one scene through several kernels.
class Pictures {
public:
    Pictures(const Context& context, const char* name, std::vector<Kernel> kernels)
        : kernels_(std::move(kernels)), errors_(kernels_.size()) {
        std::string list;
        for (const Kernel& kernel : kernels_) list += (list.empty() ? "" : ",") + request(kernel);
        std::vector<std::string> set{"techniques=[" + list + "]"};
        if (context.quick) set.insert(set.end(), {"rays.resolution=256", "receivers.resolution=[256,192]"});
        const nlohmann::json document = context.document(name, set);
        note_document(context, name, document);
        for (std::uint64_t repeat = 0; repeat < repeats; ++repeat)
            add(Seen(with_moved_map(document, repeat), context.data));
    }

    struct Difference {
        std::vector<double> rms, flip;  // of each repeat, over the whole picture
    };
    const Difference& difference(const Kernel& a, const Kernel& b) {
        Difference& found = differences_[{place(a), place(b)}];
        if (!found.rms.empty()) return found;
        for (const std::vector<render::Image>& images : images_) {
            const render::PictureErrors errors = render::compare(images[place(a)], images[place(b)]);
            found.rms.push_back(errors.rms);
            found.flip.push_back(errors.flip_mean);
        }
        return found;
    }

    // The share of the picture that lies in transitions: neither lit nor dark.
    Value transition(const Kernel& kernel) const {
        std::vector<double> shares;
        for (const std::vector<render::Image>& images : images_) {
            const std::vector<base::Vec3f>& pixels = images[place(kernel)].pixels;
            const auto between = std::count_if(pixels.begin(), pixels.end(),
                                               [](const base::Vec3f& p) { return p.x > 0.001f && p.x < 0.999f; });
            shares.push_back(static_cast<double>(between) / static_cast<double>(pixels.size()));
        }
        return mean_of(shares);
    }

    // How the picture of each kernel on several depths, a row, differs from that of each on one depth.
    Table difference_table(const std::string& title_of_table) {
        Table table{title_of_table, {"kernel"}, {}};
        for (const Kernel& standard : kernels_)
            if (standard.n == 1) table.header.push_back(title(standard) + ": rms, FLIP");
        for (const Kernel& kernel : kernels_) {
            if (kernel.n == 1) continue;
            std::vector<std::string> row{title(kernel)};
            for (const Kernel& standard : kernels_) {
                if (standard.n != 1) continue;
                const Difference& from = difference(kernel, standard);
                row.push_back(fmt::format("{}, {}", to_text(mean_of(from.rms)), to_text(mean_of(from.flip))));
            }
            table.rows.push_back(std::move(row));
        }
        return table;
    }

    // A row for each kernel: the RMS error against the truth over each width.
    Table error_table(const std::string& title_of_table) const {
        Table table{title_of_table, {"kernel"}, {}};
        for (const double width : widths) table.header.push_back(fmt::format("{:g} cells", width));
        for (const Kernel& kernel : kernels_) {
            std::vector<std::string> row{title(kernel)};
            for (std::size_t w = 0; w < std::size(widths); ++w) row.push_back(to_text(error(kernel, w)));
            table.rows.push_back(std::move(row));
        }
        return table;
    }
    Value error(const Kernel& kernel, std::size_t width) const {
        std::vector<double> rms;
        for (const std::array<double, std::size(widths)>& of_repeat : errors_[place(kernel)])
            rms.push_back(of_repeat[width]);
        return mean_of(rms);
    }

private:
    std::size_t place(const Kernel& kernel) const {
        return static_cast<std::size_t>(std::find(kernels_.begin(), kernels_.end(), kernel) - kernels_.begin());
    }

    void add(const Seen& seen) {
        std::vector<render::Image>& images = images_.emplace_back();
        for (std::size_t k = 0; k < kernels_.size(); ++k) images.push_back(seen.picture(seen.visibility(k)));
        const std::vector<std::size_t> chosen = seen.chosen(judged);
        std::vector<techniques::Query> asked;
        for (const double width : widths)
            for (const std::size_t q : chosen) {
                asked.push_back(seen.queries()[q]);
                asked.back().width = static_cast<float>(width);
            }
        const bench::Truth truth = seen.truth(asked);
        for (std::size_t k = 0; k < kernels_.size(); ++k) {
            std::array<double, std::size(widths)>& rms = errors_[k].emplace_back();
            for (std::size_t w = 0; w < std::size(widths); ++w) {
                double squares = 0.0;
                for (std::size_t i = 0; i < chosen.size(); ++i) {
                    const double off =
                        static_cast<double>(seen.visibility(k)[chosen[i]]) - truth.value[w * chosen.size() + i];
                    squares += off * off;
                }
                rms[w] = std::sqrt(squares / static_cast<double>(chosen.size()));
            }
        }
    }

    std::vector<Kernel> kernels_;
    std::vector<std::vector<render::Image>> images_;  // of each repeat, of each kernel
    std::map<std::pair<std::size_t, std::size_t>, Difference> differences_;
    std::vector<std::vector<std::array<double, std::size(widths)>>> errors_;  // of each kernel, of each repeat
};

Value ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
    return mean_of(ratios);
}

// `smaller` on several depths looks like `larger` on one. Without the paper's idea, the smaller kernel on one depth
// would take its place. `in_phase` on one depth has an even or an odd side, as `smaller` has.
void looks_like(Pictures& pictures, const char* place, const Kernel& smaller, const Kernel& larger,
                const Kernel& in_phase, PaperReport& report) {
    const Pictures::Difference &ours = pictures.difference(smaller, larger),
                               &plain = pictures.difference({1, smaller.side}, larger),
                               &same_phase = pictures.difference(smaller, in_phase);
    const Value rms = ratio(ours.rms, plain.rms), flip = ratio(ours.flip, plain.flip);
    report.claims.push_back(
        {place,
         fmt::format("{} looks like {}", title(smaller), title(larger)),
         fmt::format("the pictures differ by rms {}, FLIP {}; {} and {} of what {} differs; from {}, in the same "
                     "phase, by rms {}, FLIP {}; errors over 2, 3, 4 cells: {}, {}, {} against {}, {}, {}",
                     to_text(mean_of(ours.rms)), to_text(mean_of(ours.flip)), to_text(rms), to_text(flip),
                     title({1, smaller.side}), title(in_phase), to_text(mean_of(same_phase.rms)),
                     to_text(mean_of(same_phase.flip)), to_text(pictures.error(smaller, 0)),
                     to_text(pictures.error(smaller, 1)),
                     to_text(pictures.error(smaller, 2)), to_text(pictures.error(larger, 0)),
                     to_text(pictures.error(larger, 1)), to_text(pictures.error(larger, 2))),
         both(judge_likeness(rms), judge_likeness(flip)),
         "Over the whole picture. A kernel of an odd side lies around the middle of a cell, one of an even side around "
         "a corner of cells, so the two pictures of this pair are half a cell out of phase. The table of differences "
         "shows which kernel on one depth it is nearest to.",
         {rms, flip}});
}

void figure_6(const Context& context) {
    Pictures pictures(context, flat, {{1, 2}, {1, 3}, {1, 4}, {3, 2}, {3, 3}});
    looks_like(pictures, "section 5, figure 6", {3, 2}, {1, 3}, {1, 4}, *context.report);
    looks_like(pictures, "section 5, figure 6", {3, 3}, {1, 4}, {1, 3}, *context.report);
    context.report->tables.push_back(pictures.difference_table("Figure 6: how the pictures differ" + over_places));
    context.report->tables.push_back(
        pictures.error_table("Figure 6: error rms against the truth over this width" + over_places));
}

void figure_7(const Context& context) {
    const Kernel standard{1, 4}, two{2, 3}, three{3, 3};
    Pictures pictures(context, curved, {{1, 3}, standard, two, three});
    PaperReport& report = *context.report;
    looks_like(pictures, "section 5, figure 7", two, standard, {1, 3}, report);
    looks_like(pictures, "section 5, figure 7", three, standard, {1, 3}, report);
    const Pictures::Difference &of_two = pictures.difference(two, standard),
                               &of_three = pictures.difference(three, standard);
    const Value rms = ratio(of_three.rms, of_two.rms), flip = ratio(of_three.flip, of_two.flip);
    report.claims.push_back({"section 5, figure 7",
                             "the 3-SM makes a transition closer to that of the standard map than the 2-SM does",
                             fmt::format("its picture differs by {} (rms) and {} (FLIP) of what that of the 2-SM does",
                                         to_text(rms), to_text(flip)),
                             both(judge_less(rms, exactly(1.0)), judge_less(flip, exactly(1.0))),
                             "Both have kernels of 3 x 3, the standard map has 4 x 4.",
                             {rms, flip}});
    const Value thin = pictures.transition(two), wide = pictures.transition(standard);
    report.claims.push_back(
        {"section 5, figure 7",
         "the 2-SM's transition is thinner than that of the standard map",
         fmt::format("{} and {} of the picture are neither lit nor dark", to_text(thin), to_text(wide)),
         judge_less(thin, wide),
         "The area of the transitions, by which their widths are compared.",
         {thin, wide}});
    report.tables.push_back(pictures.difference_table("Figure 7: how the pictures differ" + over_places));
    report.tables.push_back(
        pictures.error_table("Figure 7: error rms against the truth over this width" + over_places));
}

}  // namespace

void pictures(const Context& context) {
    figure_6(context);
    figure_7(context);
}

}  // namespace shadowbench::claims::pagot

// Salvi et al. 2010, sections 4.1 and 5.3: segments that are inserted as they come instead of sorted, whose order may
// change from frame to frame.
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/salvi.h"
#include "claims/salvi_streams.h"
#include "claims/salvi_view.h"

namespace shadowbench::claims::salvi {
namespace {

constexpr const char* list = R"([{"type":"avsm","cells":"sample","nodes":4,"filter":"bilinear","order":"captured"},)"
                             R"({"type":"avsm","cells":"sample","nodes":8,"filter":"bilinear","order":"captured"},)"
                             R"({"type":"avsm","cells":"sample","nodes":4,"filter":"bilinear","order":"sorted"},)"
                             R"({"type":"avsm","cells":"sample","nodes":8,"filter":"bilinear","order":"sorted"},)"
                             R"({"type":"uncompressed","filter":"bilinear"}])";

std::vector<std::string> avsm(int nodes, const char* order) {
    return {fmt::format("nodes={}", nodes), fmt::format("order={}", order)};
}

// The paper does not say how far fragments change places from frame to frame: fragments of primitives that a GPU draws
// at the same time do. Here those among so many successive ones of a ray do, at random; the last is all of them.
constexpr std::uint32_t whole = ~0u;
constexpr std::array<std::uint32_t, 3> windows = {4, 64, whole};
constexpr std::array<int, 2> node_counts = {4, 8};

std::string window_text(std::uint32_t window) {
    return window == whole ? "all" : std::to_string(window);
}

// Differences of pictures over seeds, for one number of nodes.
struct Differences {
    SeededDifferences frames[windows.size()];    // two frames
    std::vector<double> errors[windows.size()];  // rms of a frame from the uncompressed picture
    SeededDifferences unsorted;                  // as captured from sorted
    std::vector<double> sorted_error, captured_error;
};

void measure_scene(const View& view, int nodes, const render::Image& truth, Differences& out) {
    const bench::Contender& streamed = view.contender("avsm", avsm(nodes, "captured"));
    const render::Image sorted = view.picture("avsm", avsm(nodes, "sorted"));
    const render::Image captured = view.picture("avsm", avsm(nodes, "captured"));
    out.unsorted.add(view.difference(captured, sorted));
    out.sorted_error.push_back(view.difference(sorted, truth).rms);
    out.captured_error.push_back(view.difference(captured, truth).rms);
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const auto shown = [&](std::uint64_t seed) {
            return view.picture(view.build(streamed, shuffled(view.tiles(), windows[w], seed)));
        };
        const render::Image one = shown(1), next = shown(2);
        out.frames[w].add(view.difference(one, next));
        out.errors[w].push_back(view.difference(one, truth).rms);
    }
}

void add_table(const std::array<Differences, node_counts.size()>& measured, PaperReport& report) {
    Table table{"Section 4.1: orders of insertion, differences of pictures; medians over six scenes",
                {"nodes", "order", "rms from the uncompressed picture", "rms from the next frame",
                 "from it at 99 % of the pixels, at most"},
                {}};
    for (std::size_t n = 0; n < node_counts.size(); ++n) {
        const Differences& d = measured[n];
        const std::string nodes = std::to_string(node_counts[n]);
        table.rows.push_back({nodes, "sorted", to_text(median_of(d.sorted_error)), "0", "0"});
        table.rows.push_back({nodes, "as captured", to_text(median_of(d.captured_error)), "0", "0"});
        for (std::size_t w = 0; w < windows.size(); ++w)
            table.rows.push_back({nodes, fmt::format("random among {}", window_text(windows[w])),
                                  to_text(median_of(d.errors[w])), to_text(median_of(d.frames[w].rms)),
                                  to_text(median_of(d.frames[w].most))});
    }
    report.tables.push_back(std::move(table));
}

// Two frames for each window, by one measure.
struct Frames {
    std::vector<Value> values;
    std::vector<Judged> judged;
    std::string text;  // "0.01 [...] among 4, ..."
};

Frames frames_of(const Differences& measured, std::vector<double> SeededDifferences::*measure) {
    Frames frames;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        frames.values.push_back(median_of(measured.frames[w].*measure));
        frames.judged.push_back(judge_unnoticed(frames.values.back()));
        frames.text +=
            fmt::format("{}{} among {}", w ? ", " : "", to_text(frames.values.back()), window_text(windows[w]));
    }
    return frames;
}

void claims_of(const Differences& four, const Differences& eight, PaperReport& report) {
    const Frames rms = frames_of(eight, &SeededDifferences::rms), most = frames_of(eight, &SeededDifferences::most);
    std::vector<Value> values = rms.values;
    values.insert(values.end(), most.values.begin(), most.values.end());
    report.claims.push_back(
        {"section 4.1", "with 8 nodes, artifacts of an order that changes from frame to frame are mostly imperceptible",
         fmt::format("two frames differ by rms {}; 99 % of the pixels by at most {}", rms.text, most.text),
         in_readings({in_most(rms.judged), in_most(most.judged)}),
         "The paper does not say how far segments change places: at random among 4 or 64 successive ones, or all of a "
         "ray; \"mostly\" is in most of these. Judged by the rms and by 99 % of the pixels.",
         values});
    const SeededDifferences& few = four.frames[windows.size() - 1];
    const Value few_rms = median_of(few.rms), few_most = median_of(few.most);
    report.claims.push_back(
        {"sections 4.1 and 5.4",
         "with a low number of nodes, an order that changes can result in visible artifacts",
         fmt::format("4 nodes: two frames differ by {} in one of three windows, that of all segments of a ray",
                     few.text()),
         in_readings({judge_visible(few_rms), judge_visible(few_most)}),
         "All segments of a ray change places, as far as they can. Judged by the same two measures.",
         few.values()});
    const std::vector<Value> of_unsorted = eight.unsorted.values();
    values.insert(values.end(), of_unsorted.begin(), of_unsorted.end());
    report.claims.push_back(
        {"section 5.3", "errors from not sorting are often imperceptible, so that it can usually be skipped",
         fmt::format("8 nodes: two frames in different orders differ by rms {}; 99 % of the pixels by at most {}; the "
                     "pictures of the order of capture and of the sorted one by {}",
                     rms.text, most.text, eight.unsorted.text()),
         in_readings({in_most(rms.judged), in_most(most.judged), judge_unnoticed(median_of(eight.unsorted.rms)),
                      judge_unnoticed(median_of(eight.unsorted.most))}),
         "Two readings, each by both measures. The sentence begins with \"As discussed earlier\", and section 4.1 "
         "discusses frames whose orders differ; its own words are of skipping the sort. Puffs are captured one after "
         "the other, from the foot of a column to its top.",
         values});
}

}  // namespace

void orders(const Context& context) {
    std::array<Differences, node_counts.size()> measured;
    for (int k = 0; k < seeds; ++k) {
        nlohmann::json document = with_size(with_seeds(context.document(columns), k), context);
        document["techniques"] = nlohmann::json::parse(list);
        const View view(document, context);
        const render::Image truth = view.picture("uncompressed");
        for (std::size_t n = 0; n < node_counts.size(); ++n) measure_scene(view, node_counts[n], truth, measured[n]);
    }
    add_table(measured, *context.report);
    claims_of(measured[0], measured[1], *context.report);
}

}  // namespace shadowbench::claims::salvi

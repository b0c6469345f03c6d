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
    std::vector<double> frames[windows.size()];  // two frames
    std::vector<double> errors[windows.size()];  // a frame from the uncompressed picture
    std::vector<double> unsorted;                // as captured from sorted
    std::vector<double> sorted_error, captured_error;
};

void measure_scene(const View& view, int nodes, const render::Image& truth, Differences& out) {
    const bench::Contender& streamed = view.contender("avsm", avsm(nodes, "captured"));
    const render::Image sorted = view.picture("avsm", avsm(nodes, "sorted"));
    const render::Image captured = view.picture("avsm", avsm(nodes, "captured"));
    out.unsorted.push_back(view.difference(captured, sorted).rms);
    out.sorted_error.push_back(view.difference(sorted, truth).rms);
    out.captured_error.push_back(view.difference(captured, truth).rms);
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const auto shown = [&](std::uint64_t seed) {
            return view.picture(view.build(streamed, shuffled(view.tiles(), windows[w], seed)));
        };
        const render::Image one = shown(1), next = shown(2);
        out.frames[w].push_back(view.difference(one, next).rms);
        out.errors[w].push_back(view.difference(one, truth).rms);
    }
}

void add_table(const std::array<Differences, node_counts.size()>& measured, PaperReport& report) {
    Table table{"Section 4.1: orders of insertion, rms of pictures; medians over six scenes",
                {"nodes", "order", "from the uncompressed picture", "from the next frame"},
                {}};
    for (std::size_t n = 0; n < node_counts.size(); ++n) {
        const Differences& d = measured[n];
        const std::string nodes = std::to_string(node_counts[n]);
        table.rows.push_back({nodes, "sorted", to_text(median_of(d.sorted_error)), "0"});
        table.rows.push_back({nodes, "as captured", to_text(median_of(d.captured_error)), "0"});
        for (std::size_t w = 0; w < windows.size(); ++w)
            table.rows.push_back({nodes, fmt::format("random among {}", window_text(windows[w])),
                                  to_text(median_of(d.errors[w])), to_text(median_of(d.frames[w]))});
    }
    report.tables.push_back(std::move(table));
}

void claims_of(const Differences& four, const Differences& eight, PaperReport& report) {
    std::vector<Judged> cases;
    std::vector<Value> values;
    std::string text;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        values.push_back(median_of(eight.frames[w]));
        cases.push_back(judge_unnoticed(values.back()));
        text += fmt::format("{}{} among {}", w ? ", " : "", to_text(values.back()), window_text(windows[w]));
    }
    report.claims.push_back(
        {"section 4.1", "with 8 nodes, artifacts of an order that changes from frame to frame are mostly imperceptible",
         "two frames differ by rms " + text, in_most(cases),
         "The paper does not say how far segments change places: at random among 4 or 64 successive ones, or all of a "
         "ray. \"Mostly\" is over the whole picture; single pixels may differ by more.",
         values});
    const Value few = median_of(four.frames[windows.size() - 1]);
    report.claims.push_back(
        {"sections 4.1 and 5.4",
         "with a low number of nodes, an order that changes can result in visible artifacts",
         fmt::format("4 nodes: two frames differ by rms {} in one of three windows, that of all segments of a ray",
                     to_text(few)),
         judge_less(exactly(grey_level), few),
         "All segments of a ray change places, as far as they can. A grey level is less than a visible "
         "difference.",
         {few}});
    const Value unsorted = median_of(eight.unsorted);
    Value frames = values.front();
    for (const Value& of_window : values) frames = largest(frames, of_window);
    report.claims.push_back(
        {"section 5.3",
         "errors from not sorting are often imperceptible, so that it can usually be skipped",
         fmt::format("8 nodes: two frames in different orders differ by rms {} at most, over three windows; the "
                     "pictures of the order of capture and of the sorted one by rms {}",
                     to_text(frames), to_text(unsorted)),
         in_readings({judge_unnoticed(frames), judge_unnoticed(unsorted)}),
         "Two readings. The sentence begins with \"As discussed earlier\", and section 4.1 discusses frames whose "
         "orders differ; its own words are of skipping the sort. Puffs are captured one after the other, from the foot "
         "of a column to its top.",
         {frames, unsorted}});
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

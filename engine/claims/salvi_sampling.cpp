// Salvi et al. 2010, section 3.3: transmittance that is linear between nodes, where uniform density makes it
// exponential.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/salvi.h"
#include "claims/salvi_view.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::salvi {
namespace {

constexpr const char* both_samplings =
    R"({"type":"avsm","cells":"sample","nodes":8,"filter":"bilinear","sampling":"linear"},)"
    R"({"type":"avsm","cells":"sample","nodes":8,"filter":"bilinear","sampling":"exponential"})";

// The times of lookups, exponential over linear.
Value slower(const Context& context) {
    TimedMaps timed;
    timed.add(context, columns, {fmt::format("techniques=[{}]", both_samplings)}, {"rays.resolution=128"}, 8192);
    const Compared judged[] = {{1, 0}};
    return timed.take(judged, fixed_rounds).ratio(1, 0);
}

}  // namespace

void sampling(const Context& context) {
    SeededDifferences apart;
    std::vector<double> linear, exponential;  // rms from the uncompressed picture
    for (int k = 0; k < seeds; ++k) {
        nlohmann::json document = with_size(with_seeds(context.document(columns), k), context);
        document["techniques"] =
            nlohmann::json::parse(fmt::format(R"([{},{{"type":"uncompressed","filter":"bilinear"}}])", both_samplings));
        const View view(document, context);
        const render::Image truth = view.picture("uncompressed"), lines = view.picture("avsm", {"sampling=linear"}),
                            decays = view.picture("avsm", {"sampling=exponential"});
        apart.add(view.difference(lines, decays));
        linear.push_back(view.difference(lines, truth).rms);
        exponential.push_back(view.difference(decays, truth).rms);
    }
    const Value times = slower(context), of_lines = median_of(linear), of_decays = median_of(exponential);
    const Value over = ratio_of(linear, exponential);
    std::vector<Value> values = apart.values();
    values.insert(values.end(), {of_lines, of_decays, over});
    PaperReport& report = *context.report;
    report.claims.push_back({"section 3.3",
                             "linear interpolation between nodes is faster than exponential",
                             fmt::format("AVSM 8: exponential lookups take {} times as long", to_text(times)),
                             judge_less(exactly(1.0), times),
                             "On the scene of figure 4. Lookups are those of one thread: the paper says which is "
                             "faster, and no size.",
                             {times}});
    report.claims.push_back(
        {"section 3.3", "and a visually acceptable alternative",
         fmt::format("AVSM 8: the pictures differ by {}; from the uncompressed one by rms {} (linear) and {} "
                     "(exponential), linear over exponential {}",
                     apart.text(), to_text(of_lines), to_text(of_decays), to_text(over)),
         not_comparable(), "In the same scenes. The paper does not say what it accepts.", std::move(values)});
}

}  // namespace shadowbench::claims::salvi

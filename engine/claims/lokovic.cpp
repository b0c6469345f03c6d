// Lokovic and Veach, Deep Shadow Maps, 2000: figure 6, and the order of the other parts.
#include "claims/lokovic.h"

#include <fmt/format.h>

#include "claims/sheet.h"

namespace shadowbench::claims {
namespace lokovic {

using results::Cell;

// Filters over exactly the width of the lookup, with this number of samples.
std::string pcf(int samples, const char* cells) {
    return fmt::format(R"({{"type":"pcf","num_samples":{},"res_factor":1,"min_size":0,"min_samples":1,"cells":"{}"}})",
                       samples, cells);
}

std::string set_techniques(const std::string& list) {
    return "techniques=[" + list + "]";
}

std::string bytes_text(double bytes) {
    return bytes < 1048576.0 ? fmt::format("{:.3g} KiB", bytes / 1024.0) : fmt::format("{:.3g} MiB", bytes / 1048576.0);
}

namespace {

// A depth map of 512 x 512, one of 4096 x 4096, and a deep map of 512 x 512 pixels of 256 samples. All lookups are over
// one pixel of the smaller maps.
void figure_6(const Context& context) {
    PaperReport& report = *context.report;
    const results::Result small = context.run(
        hair_ball,
        {"rays.resolution=512", "rays.samples_per_pixel=1", "rays.pattern=regular", set_techniques(pcf(16, "centre"))},
        {"rays.resolution=128"});
    const results::Result large =
        context.run(hair_ball,
                    {"rays.resolution=4096", "rays.samples_per_pixel=1", "rays.pattern=regular",
                     "receivers.filter_width=8", set_techniques(pcf(400, "centre"))},
                    {"rays.resolution=1024"});
    const results::Result deep = context.run(hair_ball,
                                             {"rays.resolution=512", "rays.samples_per_pixel=256",
                                              "timing.repetitions=7", "reference.spread_seeds=2",
                                              set_techniques(tent + std::string(",") + pixels)},
                                             {"rays.resolution=128"});
    const Cell& coarse = cell_of(light_of(small), "pcf");
    const Cell& fine = cell_of(light_of(large), "pcf");
    const Cell& stored = cell_of(light_of(deep), "deep", {"kernel=tent"});

    Table table{"Figure 6: one pixel's width of hair shadow by three maps",
                {"map", "ns a lookup", "bytes", "error rms", "error max"},
                {}};
    const auto add = [&](const std::string& name, const Cell& cell) {
        table.rows.push_back({name, to_text(time_of(cell)), bytes_text(static_cast<double>(cell.bytes)),
                              to_text(error_of(cell)), fmt::format("{:.3g}", cell.lookup->norms.max)});
    };
    const auto map = [](const results::Result& result) { return light_of(result).layout; };
    add(fmt::format("depth map {}, 16 samples", map(small).width), coarse);
    add(fmt::format("depth map {}, 400 samples", map(large).width), fine);
    add(fmt::format("deep map {}, {} samples a pixel", map(deep).width, map(deep).samples()), stored);
    add("the same, only the nearest pixel", cell_of(light_of(deep), "deep", {"kernel=pixels"}));
    report.tables.push_back(table);

    const Value faster = time_of(fine) / time_of(stored);
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 4096 map with 400 samples takes 559 s: 15 times faster",
         to_text(faster) + " times faster",
         judge_gain(15.0, faster),
         "A deep lookup searches the short functions of a few pixels; the depth map reads 400 scattered depths.",
         {faster}});
    const Value slower = time_of(stored) / time_of(coarse);
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 512 map with 16 samples takes 19 s: 1.9 times slower",
         to_text(slower) + " times the time",
         judge_ratio(37.0 / 19.0, slower),
         "The paper had not optimised deep lookups. Its lookups are compared with 16 depth tests.",
         {slower}});
    const Value smaller = exactly(static_cast<double>(fine.bytes) / static_cast<double>(stored.bytes));
    report.claims.push_back({"section 6, figure 6",
                             "the deep map needs one sixth of the 4096 map's storage",
                             fmt::format("1 / {}", to_text(smaller)),
                             judge_gain(6.0, smaller),
                             "Both are measured in bytes held; the depth map is raw floats.",
                             {smaller}});
    report.claims.push_back(
        {"section 6, figure 6",
         "quality slightly better than the 4096 map, since every depth sample counts",
         fmt::format("error rms {} against {}", to_text(error_of(stored)), to_text(error_of(fine))),
         judge_less(error_of(stored), error_of(fine)),
         "The truth is a box of one pixel; the tent over whole pixels of the deep map is wider than that, the depth "
         "map's region is not.",
         {error_of(stored), error_of(fine)}});
}

}  // namespace
}  // namespace lokovic

void measure_lokovic(const Context& context) {
    using namespace lokovic;
    context.report->conditions =
        "The hair ball is procedural (50,000 curly opaque hairs), lit by one of the paper's three spot lights; the "
        "paper's times are of whole images less the time without shadows, on one processor of its day, and here of "
        "lookups in "
        "image order, on one thread. Errors are against 1024 rays a pixel over the same footprint.";
    figure_6(context);
    sampling(context);
    filtering(context);
    channels(context);
    motion(context);
    context.report->sheets.push_back(
        picture_sheet(context, hair_ball,
                      {"rays.resolution=512", "rays.samples_per_pixel=16",
                       set_techniques(pcf(16, "centre") + "," + pcf(16, "sample") + "," + pixels +
                                      R"(,{"type":"deep","tolerance":0.02,"kernel":"tent"})")}));
}

}  // namespace shadowbench::claims

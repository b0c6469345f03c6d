// Lokovic and Veach, Deep Shadow Maps, 2000: what its parts share, and their order.
#include "claims/lokovic.h"

#include <vector>

#include <fmt/format.h>

#include "claims/intervals.h"
#include "claims/sheet.h"

namespace shadowbench::claims {
namespace lokovic {

std::string published_deep(const char* kernel) {
    return fmt::format(R"({{"type":"deep","compression":"published","kernel":"{}"}})", kernel);
}

// Filters over exactly the width of the lookup, with this number of samples.
std::string pcf(int samples, const char* cells) {
    return fmt::format(R"({{"type":"pcf","num_samples":{},"res_factor":1,"min_size":0,"min_samples":1,"cells":"{}"}})",
                       samples, cells);
}

std::string placed_pcf(int samples, const char* placement) {
    return fmt::format(
        R"({{"type":"pcf","num_samples":{},"res_factor":1,"min_size":0,"min_samples":1,"placement":"{}"}})", samples,
        placement);
}

std::string set_techniques(const std::string& list) {
    return "techniques=[" + list + "]";
}

std::string bytes_text(double bytes) {
    return bytes < 1048576.0 ? fmt::format("{:.3g} KiB", bytes / 1024.0) : fmt::format("{:.3g} MiB", bytes / 1048576.0);
}

Value bytes_of(const results::Cell& cell) {
    std::vector<double> sample{static_cast<double>(cell.bytes)};
    for (const results::SeedErrors& seed : cell.over_seeds) sample.push_back(static_cast<double>(seed.bytes));
    return sample.size() > 1 ? mean_of(sample) : exactly(sample.front());
}

}  // namespace lokovic

void measure_lokovic(const Context& context) {
    using namespace lokovic;
    context.report->conditions =
        "The hair ball is procedural: 50,000 curly opaque hairs, lit by one of the paper's three spot lights. In "
        "figures 6 to 8 it is as the paper describes it: each hair is much finer than a map pixel, hair is in about "
        "40 % of the pixels, and ground and backdrop are in the map. Figure 6 gives its deep map 512 x 512 pixels of "
        "256 samples, and as many depth samples as a depth map of 4096 x 4096, which cannot both be. Its claims are "
        "judged over three readings: as printed, with 64 samples a pixel, and with 256 x 256 pixels as in figure 7. "
        "The width of its filter is not printed; ours is 4 / 512 of the map. Deep lookups weigh each pixel by the part "
        "that the filter covers. Section 3.4 weighs it by f(centre - x), which for a box takes or leaves whole pixels: "
        "where the filter matters, claims are judged over both readings. Figure 9 is of maps of 256 x 256 pixels with "
        "64 samples a pixel, and the depth map is filtered with 64 of them. Figures 6 to 9, sections 3.3 and 3.4, "
        "vertices, biases and the sizes of mip levels use the paper's compression word for word "
        "(compression=published), section 5.2 both. All else uses the program's default (compression=bounded), which "
        "keeps the same tolerance, and whose functions "
        "never rise and stay in [0, 1]. The dense hair of sections 2 and 4 lies at one depth. Lookups are of the whole "
        "picture, unless a claim says otherwise; the paper magnifies the shadow. The paper's times are of whole images "
        "less the time without shadows, on one processor of its day; here they are of lookups in image order, on one "
        "thread. Errors are against exact rays over the footprint that is asked for. Sizes, and the errors of section "
        "5.3, are means over three seeds of the light rays, the tiles of section 5.4 over three views, each with a "
        "seed of its own; the errors of section 2, and that of dense hair in section 4, over eight. Exponents and "
        "numbers of samples of section 2 are read off the law of each seed: their "
        "intervals are over the eight, too.";
    noise(context);
    three_maps(context);
    searches(context);
    sampling(context);
    generation(context);
    vertices(context);
    filtering(context);
    biases(context);
    channels(context);
    motion(context);
    media(context);
    context.report->sheets.push_back(
        picture_sheet(context, hair_ball,
                      {"rays.resolution=512", "rays.samples_per_pixel=16",
                       set_techniques(pcf(16, "centre") + "," + pcf(16, "sample") + "," + pixels +
                                      R"(,{"type":"deep","tolerance":0.02,"kernel":"tent"})")}));
}

}  // namespace shadowbench::claims

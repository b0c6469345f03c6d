// Salvi, Vidimce, Lauritzen, Lefohn, Adaptive Volumetric Shadow Maps, 2010: the order of its parts.
#include "claims/salvi.h"

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "claims/sheet.h"

namespace shadowbench::claims {
namespace salvi {

nlohmann::json with_size(nlohmann::json document, const Context& context) {
    if (context.quick) document["rays"]["resolution"] = 128;
    return document;
}

}  // namespace salvi

void measure_salvi(const Context& context) {
    using namespace salvi;
    const base::ThreadLimit threads(context.threads);
    context.report->conditions =
        "Procedural smoke, hair and opaque things in place of the paper's scenes, which are not public, at the paper's "
        "256 x 256 texels of one light ray, on one thread of a processor where the paper used a GPU (Radeon 5870): "
        "times are ratios to AVSM with 8 nodes. Lookups are bilinear over four texels. As in the paper, pictures and "
        "curves are compared with those of the uncompressed map of the same rays. Their errors are medians over six "
        "scenes, or over 24 texels of three scenes, that differ in the seeds of smoke and hair, with the interval that "
        "holds the median with 95 %; pictures are 256 x 192, as a display shows them, and 1 is its whole range. The "
        "rms of a difference is over the pixels that see anything. What the paper's words leave open is read in "
        "several ways, which the claims name: how near is near (the rms, 99 % of the pixels or FLIP of pictures; the "
        "largest or the mean distance of curves), how far apart the columns are, and how dense smoke and hair are. The "
        "paper's frames a second and milliseconds of whole frames are of its GPU and its scenes; they are not judged.";
    table_1(context);
    depth_range(context);
    pictures(context);
    texels(context);
    sampling(context);
    orders(context);
    streaming_times(context);
    drift(context);
    context.report->sheets.push_back(
        picture_sheet(context, columns,
                      {R"(techniques=[{"type":"avsm","cells":"sample","nodes":8,"filter":"bilinear"},)"
                       R"({"type":"fourier","cells":"sample","terms":16,"filter":"bilinear"},)"
                       R"({"type":"opacity","cells":"sample","slices":32,"filter":"bilinear"}])"}));
}

}  // namespace shadowbench::claims

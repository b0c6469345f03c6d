// Lokovic and Veach, Deep Shadow Maps, 2000: figures 10 and 11.
#include <fmt/format.h>

#include "claims/lokovic.h"
#include "claims/sheet.h"

namespace shadowbench::claims::lokovic {

void media(const Context& context) {
    PaperReport& report = *context.report;
    const results::LightResult light = light_of(context.run(smoke_scene, {}, {"rays.resolution=96"}));
    const Value deep = error_of(cell_of(light, "deep")), depth = error_of(cell_of(light, "pcf"));
    report.claims.push_back({"section 6, figure 11",
                             "a single deep map serves volumetric and surface shadows, which a depth map cannot",
                             fmt::format("error rms {} against {} of a depth map", to_text(deep), to_text(depth)),
                             judge_much_less(deep, depth),
                             "A depth map counts the first puff of smoke as opaque. Both have 16 samples a pixel.",
                             {deep, depth}});
    report.sheets.push_back(picture_sheet(context, cloud_scene, {}, "_figure10"));
    report.sheets.push_back(picture_sheet(context, smoke_scene, {}, "_figure11"));
}

}  // namespace shadowbench::claims::lokovic

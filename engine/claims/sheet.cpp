#include "claims/sheet.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/panels.h"
#include "render/exposure.h"
#include "render/image_file.h"
#include "render/render.h"

namespace shadowbench::claims {

Sheet picture_sheet(const Context& context, const std::string& name, const std::vector<std::string>& set,
                    const std::string& suffix) {
    render::RenderOptions options;
    options.run.data = context.data;
    options.run.threads = context.threads;
    options.size = context.quick ? base::Vec2i(192, 144) : base::Vec2i(512, 384);
    options.rays_per_side = context.quick ? 1 : 2;
    const nlohmann::json document = context.document(name, set);
    note_document(context, name, document);
    const render::Rendering rendering = render::render(document, options, context.progress);

    const render::Image& reference = rendering.reference.shaded;
    const double exposure = render::exposure_of(reference, rendering.seen);
    std::vector<Panel> panels{{render::on_grey(reference, rendering.seen, exposure), rendering.reference.shadow}};
    Sheet sheet;
    sheet.name = context.report->id + suffix;
    sheet.caption = fmt::format("Above, from left to right: {}: 1 reference", name);
    for (const render::TechniquePictures& pictures : rendering.techniques) {
        const std::string label = results::title(pictures.cell);
        if (pictures.cell.status == results::CellStatus::failed) {
            sheet.caption += fmt::format("; {} failed ({})", label, pictures.cell.reason);
            continue;
        }
        const render::Image& shaded = pictures.picture.shaded;
        panels.push_back({render::on_grey(shaded, rendering.seen, exposure),
                          dark_on_white(render::difference_times_four(shaded, reference))});
        sheet.caption += fmt::format("; {} {} (rms {:.2g}, FLIP {:.2g})", panels.size(), label, pictures.shaded.rms,
                                     pictures.shaded.flip_mean);
    }
    sheet.caption += fmt::format(
        ". Below: the reference's visibility, then each difference from the reference, times four, dark on white. In "
        "brackets: rms difference of the linear values of the picture above from those of the reference, over all "
        "pixels, and FLIP's mean; both are of this one picture. The visibility of the reference has a standard error "
        "of rms {:.2g}",
        rendering.reference_standard_error);
    sheet.png = render::encode_png(side_by_side(panels));
    return sheet;
}

}  // namespace shadowbench::claims

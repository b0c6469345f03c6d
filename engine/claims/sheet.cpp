#include "claims/sheet.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "render/image_file.h"
#include "render/render.h"

namespace shadowbench::claims {
namespace {

void paste(const render::Image& from, int x0, int y0, render::Image& to) {
    for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < from.width; ++x) to.at(x0 + x, y0 + y) = from.at(x, y);
}

}  // namespace

Sheet picture_sheet(const Context& context, const std::string& name, const std::vector<std::string>& set) {
    render::RenderOptions options;
    options.run.data = context.data;
    options.run.threads = context.threads;
    options.size = context.quick ? base::Vec2i(192, 144) : base::Vec2i(384, 288);
    options.rays_per_side = context.quick ? 1 : 2;
    const render::Rendering rendering = render::render(context.document(name, set), options, context.progress);

    const base::Vec2i size = *options.size;
    std::vector<const render::TechniquePictures*> shown;
    Sheet sheet;
    sheet.name = context.report->id;
    sheet.caption = fmt::format("{}: reference", name);
    for (const render::TechniquePictures& pictures : rendering.techniques) {
        const std::string label = results::title(pictures.cell);
        if (pictures.cell.status == results::CellStatus::failed) {
            sheet.caption += fmt::format("; {} failed ({})", label, pictures.cell.reason);
            continue;
        }
        shown.push_back(&pictures);
        sheet.caption +=
            fmt::format("; {} (rms {:.2g}, FLIP {:.2g})", label, pictures.shaded.rms, pictures.shaded.flip_mean);
    }
    constexpr int gap = 4;
    const int columns = 1 + static_cast<int>(shown.size());
    render::Image image({columns * (size.x + gap) - gap, 2 * size.y + gap}, base::Vec3f(1.0f));
    paste(rendering.reference.shaded, 0, 0, image);
    paste(rendering.reference.shadow, 0, size.y + gap, image);
    for (int i = 1; i < columns; ++i) {
        const render::Image& shaded = shown[static_cast<std::size_t>(i - 1)]->picture.shaded;
        paste(shaded, i * (size.x + gap), 0, image);
        paste(render::difference_times_four(shaded, rendering.reference.shaded), i * (size.x + gap), size.y + gap,
              image);
    }
    sheet.png = render::encode_png(image);
    return sheet;
}

}  // namespace shadowbench::claims

#include <fmt/format.h>

#include "base/table.h"
#include "render/write_pictures.h"

namespace shadowbench::render {
namespace {

constexpr const char* legend =
    "max, rms: errors of linear values against the reference. flip: mean visible difference (FLIP 2020, 0 to 1).\n"
    "shaded: the picture. shadow: the average visibility.\n";

std::vector<std::string> row_of(const TechniquePictures& pictures) {
    const results::Cell& cell = pictures.cell;
    std::vector<std::string> row{results::title(cell)};
    const bool ok = cell.status == results::CellStatus::ok;
    for (const PictureErrors* errors : {&pictures.shaded, &pictures.shadow})
        for (const double value : {errors->max, errors->rms, errors->flip_mean})
            row.push_back(ok ? fmt::format("{:.2g}", value) : "-");
    row.push_back(!ok                    ? "failed: " + cell.reason
                  : cell.outside_promise ? "ok, but promised for opaque scenes only"
                                         : "ok");
    return row;
}

}  // namespace

std::string to_table(const Rendering& rendering) {
    std::string text = fmt::format(
        "{}: {} x {} pixels{}, {} lookups a light; reference: {} rays a map pixel, standard error rms {:.2g}; heat "
        "maps to {:g}\n",
        rendering.name, rendering.size.x, rendering.size.y, rendering.default_camera ? " of the default camera" : "",
        rendering.points, rendering.reference_samples, rendering.reference_standard_error, rendering.heat_top);
    for (const document::Setting& setting : rendering.settings)
        text += fmt::format("{} = {} (the first value of its sweep)\n", setting.pointer, setting.value);
    base::Table table({"technique", "shaded max", "rms", "flip", "shadow max", "rms", "flip", "status"});
    for (const TechniquePictures& pictures : rendering.techniques) table.add(row_of(pictures));
    return text + table.text("    ") + legend;
}

}  // namespace shadowbench::render

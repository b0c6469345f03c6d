#include <filesystem>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/pending_file.h"
#include "bench/one_light.h"
#include "document/technique_choice.h"
#include "render/deep_exr.h"
#include "results/report.h"
#include "service/cli/commands.h"
#include "service/cli/deep_file_text.h"
#include "service/cli/job.h"
#include "service/cli/progress_bar.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/deep_file.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

// Whether --out names a tiled file. Otherwise it names a deep image.
bool is_tiled(const ExportArguments& arguments) {
    const std::string extension = fs::path(arguments.out).extension().string();
    if (extension != ".dsm" && extension != ".exr")
        throw Error(ErrorCode::usage, "--out " + arguments.out,
                    "the file's name must end in .exr (deep OpenEXR) or .dsm (tiled deep shadow map)");
    if (extension == ".dsm" && arguments.rays)
        throw Error(ErrorCode::usage, "--rays", "light rays are written as .exr, not as .dsm");
    return extension == ".dsm";
}

std::string title_of(const bench::OneLight& light, const std::string& what) {
    return fmt::format("{}, light {}, {}, {} ray{} a pixel", light.scenario().name, light.light().name, what,
                       light.layout().samples(), light.layout().samples() == 1 ? "" : "s");
}

std::string write_image(const ExportArguments& arguments, int width, int height,
                        const std::vector<render::DeepBlock>& blocks, const std::string& text) {
    render::write_deep_exr(arguments.out, width, height, blocks, text);
    std::size_t samples = 0;
    for (const render::DeepBlock& block : blocks) samples += block.z_front.size();
    return fmt::format("{}: deep image of {} bytes\n  of: {}\n  {} x {} pixels, {} channel{}, {} samples\n",
                       arguments.out, fs::file_size(arguments.out), text, width, height, blocks[0].channels,
                       blocks[0].channels == 1 ? "" : "s", samples);
}

std::string export_rays(const ExportArguments& arguments, const bench::OneLight& light,
                        const bench::ProgressCallback& progress) {
    std::vector<render::DeepBlock> blocks;
    const auto add = [&](bench::RaySource::Batch batch) {
        const std::size_t first = blocks.size();
        blocks.resize(first + batch.size());
        base::parallel_for(batch.size(), [&](std::size_t i) { blocks[first + i] = render::samples_of_rays(batch[i]); });
    };
    light.for_each_batch(add, progress);
    return write_image(arguments, light.layout().width, light.layout().height, blocks, title_of(light, "light rays"));
}

std::string export_functions(const ExportArguments& arguments, const bench::Contender& built, const std::string& text) {
    const base::Vec2i size = render::size_of(built.maps);
    std::vector<render::DeepBlock> rows(static_cast<std::size_t>(size.y));
    base::parallel_for(rows.size(),
                       [&](std::size_t y) { rows[y] = render::samples_of_functions(built.maps, static_cast<int>(y)); });
    return write_image(arguments, size.x, size.y, rows, text);
}

std::string export_tiled(const ExportArguments& arguments, const bench::Contender& built, const std::string& text) {
    if (built.maps.parts.size() > 1)
        throw Error(ErrorCode::bad_input, "--out " + arguments.out,
                    "the map stores its three channels separately, which a .dsm cannot hold; write it as .exr");
    techniques::DeepFileNotes notes{0.0f, built.maps.layout->z_min, built.maps.layout->z_max, text};
    notes.tolerance = static_cast<float>(built.row->error_bound(built.values, *built.maps.layout));
    techniques::write_deep_file(arguments.out, techniques::levels(*built.maps.parts[0]), arguments.tile, notes);
    return describe(techniques::DeepFile(arguments.out), arguments.out);
}

std::string export_map(const ExportArguments& arguments, bool tiled, const bench::OneLight& light,
                       const document::TechniqueChoice& technique, const bench::ProgressCallback& progress) {
    const bench::Contender built = light.build(technique, progress);
    if (techniques::Cells::none == bench::cells(built.maps))
        throw Error(ErrorCode::usage, "--technique " + arguments.technique,
                    "this technique stores no functions; choose another");
    const std::string text = title_of(light, results::title(built.cell));
    return tiled ? export_tiled(arguments, built, text) : export_functions(arguments, built, text);
}

}  // namespace

void export_command(const ExportArguments& arguments, std::ostream& out, std::ostream& err) {
    const bool tiled = is_tiled(arguments);
    const Job job = read_job(arguments);  // first: it loads the libraries of techniques
    document::TechniqueChoice technique = document::read_any_technique(arguments.technique);
    if (tiled && technique.row->id != std::string("deep"))
        throw Error(ErrorCode::usage, "--out " + arguments.out,
                    "only technique deep can be written as .dsm; write an .exr");
    if (tiled) technique.values.values["storage"] = std::string("memory");  // a map in tiles keeps no levels to write
    { const base::PendingFile writable(arguments.out); }  // fails now rather than after all the work
    const base::ThreadLimit threads(job.options.threads);
    ProgressBar bar(err);
    const bench::ProgressCallback progress = [&](const bench::Progress& p) { bar.show(p); };
    const bench::OneLight light(*job.document, job.options, arguments.light);
    const std::string text = arguments.rays ? export_rays(arguments, light, progress)
                                            : export_map(arguments, tiled, light, technique, progress);
    bar.end();
    err << results::notes_text(scene::notes(light.scenario()), "");
    out << text;
}

}  // namespace shadowbench::service

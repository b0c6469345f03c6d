#include <algorithm>
#include <charconv>
#include <ostream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/write_files.h"
#include "render/render.h"
#include "render/write_pictures.h"
#include "results/report.h"
#include "scene/limits.h"
#include "service/cli/commands.h"
#include "service/cli/job.h"
#include "service/cli/progress_bar.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

// Reads "640x480".
base::Vec2i read_size(const std::string& text) {
    const char* const end = text.data() + text.size();
    base::Vec2i size(0, 0);
    const auto [middle, first] = std::from_chars(text.data(), end, size.x);
    bool good = first == std::errc() && middle != end && *middle == 'x';
    if (good) {
        const auto [rest, second] = std::from_chars(middle + 1, end, size.y);
        good = second == std::errc() && rest == end && size.x > 0 && size.y > 0 &&
               static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) <= scene::max_camera_pixels &&
               std::max(size.x, size.y) <= scene::max_image_side;
    }
    if (!good)
        throw base::Error(base::ErrorCode::usage, "--size " + text,
                          fmt::format("expected WIDTHxHEIGHT, 1 to {} pixels per side and at most {} in all",
                                      scene::max_image_side, scene::max_camera_pixels));
    return size;
}

bool all_ok(const render::Rendering& rendering) {
    return std::all_of(rendering.techniques.begin(), rendering.techniques.end(),
                       [](const auto& technique) { return technique.cell.status == results::CellStatus::ok; });
}

}  // namespace

bool render_command(const RenderArguments& arguments, std::ostream& out, std::ostream& err) {
    const Job job = read_job(arguments);
    render::RenderOptions options = render::usual_options(job.options);
    if (!arguments.size.empty()) options.size = read_size(arguments.size);
    if (arguments.rays_per_side) options.rays_per_side = *arguments.rays_per_side;
    if (arguments.media_lookups) options.media_lookups = *arguments.media_lookups;
    const fs::path folder = output_folder(arguments.out, "results/images", *job.document);
    base::Undo made;  // a rendering that fails leaves no new folder
    base::make_writable(folder, made);

    ProgressBar bar(err);
    const render::Rendering rendering =
        render::render(*job.document, options, [&](const bench::Progress& progress) { bar.show(progress); });
    bar.end();
    err << results::notes_text(rendering.notes, "");
    render::write_pictures(folder, rendering);
    made.keep();
    out << render::to_table(rendering)
        << fmt::format("written: {0}/images.json and the pictures that it names\n", folder.string());
    return all_ok(rendering);
}

}  // namespace shadowbench::service

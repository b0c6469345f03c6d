#include "claims/salvi_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/memory.h"
#include "bench/ray_source.h"
#include "curves/norms.h"
#include "curves/sweep.h"
#include "rays/capture.h"
#include "rays/tracer.h"
#include "render/display.h"
#include "render/render.h"

namespace shadowbench::claims::salvi {
namespace {

constexpr double most_pixels = 0.99;

double shown(const base::Vec3f& colour, int channel) {
    return render::to_display(std::clamp(static_cast<double>(colour[channel]), 0.0, 1.0));
}

// Notes the scenario in the report, once.
void note(const nlohmann::json& document, const Context& context) {
    const std::string name = document.at("name").get<std::string>();
    for (const std::string& noted : context.report->documents)
        if (noted.starts_with(name + " ")) return;
    note_document(context, name, document);
}

}  // namespace

void SeededDifferences::add(const Difference& one) {
    rms.push_back(one.rms);
    flip.push_back(one.flip);
    most.push_back(one.most);
}

Judged SeededDifferences::unnoticed() const {
    return in_readings({judge_unnoticed(median_of(rms)), judge_unnoticed(median_of(most))});
}

std::string SeededDifferences::text() const {
    return fmt::format("rms {}, 99 % of the pixels by at most {}, mean FLIP {}", to_text(median_of(rms)),
                       to_text(median_of(most)), to_text(median_of(flip)));
}

std::vector<Value> SeededDifferences::values() const {
    return {median_of(rms), median_of(most), median_of(flip)};
}

View::View(const nlohmann::json& document, const Context& context)
    : first_(document, context.data), tiles_(first_.tiles()) {
    note(document, context);
    for (const bench::Contender& one : first_.contenders) listed_.cells.push_back(one.cell);
    const scene::Scenario& scenario = first_.scenario;
    const rays::Tracer tracer(scenario.scene, false);
    render::ViewSettings settings;
    settings.camera = scenario.receivers.camera.value();
    settings.size = context.quick ? base::Vec2i(128, 96) : base::Vec2i(256, 192);
    points_ = render::find_shading_points(scenario.scene, scenario.lights, settings, tracer, {});
    asked_ = render::point_queries(points_, scenario.receivers, first_.light.view);
}

const bench::Contender& View::contender(const std::string& technique,
                                        const std::vector<std::string>& parameters) const {
    const results::Cell& cell = cell_of(listed_, technique, parameters);
    return first_.contenders[static_cast<std::size_t>(&cell - listed_.cells.data())];
}

bench::Maps View::build_within(const bench::Contender& contender, double times_the_range) const {
    rays::MapLayout layout = first_.light.layout;
    const double range = static_cast<double>(layout.z_max) - layout.z_min;
    const auto more = static_cast<float>(0.5 * (times_the_range - 1.0) * range);
    layout.z_min -= more;
    layout.z_max += more;
    bench::Maps maps = bench::begin_maps(*contender.row, contender.values, {layout, first_.light.view, nullptr});
    base::parallel_for(tiles_.size(), [&](std::size_t t) { bench::add(maps, tiles_[t]); });
    bench::finish(maps);
    return maps;
}

render::Image View::picture(const bench::Maps& maps) const {
    render::Picture picture = render::start_picture(points_);
    render::add_answers(points_, 0, asked_, bench::lookup_all(maps, {asked_.queries, {}}), picture);
    return picture.shaded;
}

Difference View::difference(const render::Image& a, const render::Image& b) const {
    double squares = 0.0;
    std::vector<double> largest;  // of each pixel
    for (std::size_t p = 0; p < a.pixels.size(); ++p) {
        if (points_.begin[p] == points_.begin[p + 1]) continue;
        largest.push_back(0.0);
        for (int c = 0; c < 3; ++c) {
            const double difference = shown(a.pixels[p], c) - shown(b.pixels[p], c);
            squares += difference * difference;
            largest.back() = std::max(largest.back(), std::abs(difference));
        }
    }
    const double rms = std::sqrt(squares / (3.0 * static_cast<double>(largest.size())));
    const auto rank = static_cast<std::ptrdiff_t>(most_pixels * static_cast<double>(largest.size() - 1));
    std::nth_element(largest.begin(), largest.begin() + rank, largest.end());
    return {rms, render::compare(a, b).flip_mean, largest[static_cast<std::size_t>(rank)]};
}

double View::change(const Frame& here, const Frame& next) const {
    double squares = 0.0;
    std::size_t pixels = 0;
    for (std::size_t p = 0; p < here.picture.pixels.size(); ++p) {
        if (points_.begin[p] == points_.begin[p + 1]) continue;
        ++pixels;
        for (int c = 0; c < 3; ++c) {
            const auto wrong = [&](const Frame& frame) {
                return shown(frame.picture.pixels[p], c) - shown(frame.truth.pixels[p], c);
            };
            const double difference = wrong(next) - wrong(here);
            squares += difference * difference;
        }
    }
    return std::sqrt(squares / (3.0 * static_cast<double>(pixels)));
}

MapErrors map_errors(const nlohmann::json& document, const Context& context) {
    FirstLight first(document, context.data);
    const rays::MapLayout& layout = first.light.layout;
    const rays::Capture capture(first.scenario.scene, first.light.view, layout);
    const auto unwatched = [](std::size_t) {};
    const bench::MemoryLimits limits;
    const bench::RaySource source(capture, layout, limits.kept_rays, unwatched);
    bench::build_all(first.contenders, source, first.input(), limits.all, unwatched);
    bench::check_functions(first.contenders, source, layout, unwatched);
    MapErrors errors;
    errors.depth = static_cast<double>(layout.z_max) - layout.z_min;
    for (const bench::Contender& contender : first.contenders) {
        if (!contender.ok())
            throw base::Error(base::ErrorCode::internal, contender.cell.technique, contender.cell.reason);
        errors.rms.push_back(contender.cell.curve.value().norms.rms);
    }
    return errors;
}

ComplexCurves complex_curves(const View& view, const bench::Contender& contender, std::size_t segments) {
    const bench::Maps maps = view.build(contender, view.tiles());
    const double low = view.layout().z_min, high = view.layout().z_max;
    std::vector<ComplexCurves> of_tiles(view.tiles().size());  // sums
    base::parallel_for(of_tiles.size(), [&](std::size_t t) {
        const rays::LightRays& tile = view.tiles()[t];
        curves::SweepScratch scratch;
        curves::Curve exact, stored;
        std::vector<float> depths;
        ComplexCurves& sums = of_tiles[t];
        for (std::size_t r = 0; r < tile.rays(); ++r) {
            if (tile.begin[r + 1] - tile.begin[r] <= segments) continue;
            curves::visibility(tile, r, 1, 1e-5, scratch, exact);
            depths.clear();
            for (const curves::Vertex& vertex : exact) depths.push_back(vertex.z);
            bench::stored(maps, tile.x0 + static_cast<int>(r) % tile.width, tile.y0 + static_cast<int>(r) / tile.width,
                          0, depths, stored);
            const curves::Distance apart = curves::distance(stored, exact, low, high);
            ++sums.texels;
            sums.rms += apart.max * apart.max;
            sums.mean += apart.l1 / (high - low);
        }
    });
    ComplexCurves all;
    for (const ComplexCurves& sums : of_tiles) {
        all.texels += sums.texels;
        all.rms += sums.rms;
        all.mean += sums.mean;
    }
    if (all.texels == 0)
        throw base::Error(base::ErrorCode::internal, "light rays", "no ray crosses as many segments");
    all.rms = std::sqrt(all.rms / static_cast<double>(all.texels));
    all.mean /= static_cast<double>(all.texels);
    return all;
}

nlohmann::json with_seeds(nlohmann::json document, int k) {
    if (k == 0) return document;
    for (nlohmann::json& object : document.at("scene").at("objects")) {
        const std::string type = object.at("type").get<std::string>();
        if (type != "smoke_column" && type != "hair_ball") continue;
        object["seed"] = object.value("seed", 1) + 1000 * k;
    }
    return document;
}

}  // namespace shadowbench::claims::salvi

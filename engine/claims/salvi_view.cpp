#include "claims/salvi_view.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "claims/seen.h"
#include "rays/capture.h"
#include "rays/tracer.h"
#include "render/image_file.h"
#include "render/render.h"

namespace shadowbench::claims::salvi {
namespace {

// Notes the scenario in the report, once.
void note(const nlohmann::json& document, const Context& context) {
    const std::string name = document.at("name").get<std::string>();
    for (const std::string& noted : context.report->documents)
        if (noted.starts_with(name + " ")) return;
    note_document(context, name, document);
}

}  // namespace

View::View(const nlohmann::json& document, const Context& context) : loader_(context.data) {
    note(document, context);
    const std::vector<document::Variant> variants = document::expand(document);
    scenario_ = &loader_.load(variants.front());
    contenders_ = bench::make_contenders(*scenario_, variants.front());
    for (const bench::Contender& one : contenders_) listed_.cells.push_back(one.cell);
    light_ = bench::prepare_light(*scenario_, 0, contenders_, {});
    const rays::Capture capture(scenario_->scene, light_.view, light_.layout);
    tiles_.resize(static_cast<std::size_t>(light_.layout.tiles()));
    base::parallel_for(tiles_.size(), [&](std::size_t t) { tiles_[t] = capture.tile(static_cast<int>(t)); });

    const rays::Tracer tracer(scenario_->scene, false);
    render::ViewSettings settings;
    settings.camera = scenario_->receivers.camera.value();
    settings.size = context.quick ? base::Vec2i(128, 96) : base::Vec2i(256, 192);
    points_ = render::find_shading_points(scenario_->scene, scenario_->lights, settings, tracer, {});
    asked_ = render::point_queries(points_, scenario_->receivers, light_.view);
}

const bench::Contender& View::contender(const std::string& technique,
                                        const std::vector<std::string>& parameters) const {
    return contenders_[static_cast<std::size_t>(&cell_of(listed_, technique, parameters) - listed_.cells.data())];
}

bench::Maps View::build(const bench::Contender& contender, std::span<const rays::LightRays> tiles) const {
    bench::Maps maps = bench::begin_maps(*contender.row, contender.values, {light_.layout, light_.view, nullptr});
    base::parallel_for(tiles.size(), [&](std::size_t t) { bench::add(maps, tiles[t]); });
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
    std::size_t pixels = 0;
    for (std::size_t p = 0; p < a.pixels.size(); ++p) {
        if (points_.begin[p] == points_.begin[p + 1]) continue;
        ++pixels;
        for (int c = 0; c < 3; ++c) {
            const auto shown = [c](const base::Vec3f& colour) {
                return render::to_display(std::clamp(static_cast<double>(colour[c]), 0.0, 1.0));
            };
            const double difference = shown(a.pixels[p]) - shown(b.pixels[p]);
            squares += difference * difference;
        }
    }
    return {std::sqrt(squares / (3.0 * static_cast<double>(pixels))), render::compare(a, b).flip_mean};
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

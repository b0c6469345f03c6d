#include "claims/seen.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/random.h"
#include "bench/contender.h"
#include "bench/prepared_light.h"
#include "bench/queries.h"
#include "bench/ray_source.h"
#include "document/document.h"
#include "rays/capture.h"
#include "rays/tracer.h"
#include "render/point_queries.h"

namespace shadowbench::claims {
namespace {

base::Vec3d read_vector(const nlohmann::json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

}  // namespace

Seen::Seen(const nlohmann::json& document, const scene::SearchPath& data) : loader_(data) {
    const document::Variant variant = document::expand(document).front();
    scenario_ = &loader_.load(variant);
    std::vector<bench::Contender> contenders = bench::make_contenders(*scenario_, variant);
    const bench::MemoryLimits limits;
    const auto [view, layout, least] = bench::prepare_light(*scenario_, 0, contenders, limits);
    view_ = view;
    find_queries();
    const rays::Capture capture(scenario_->scene, view_, layout);
    const bench::RaySource source(capture, layout, limits.kept_rays, {});
    bench::build_all(contenders, source, {layout, view_, nullptr}, limits.all, {});
    for (const bench::Contender& contender : contenders) {
        if (!contender.ok())
            throw base::Error(base::ErrorCode::internal, contender.cell.technique, contender.cell.reason);
        visibility_.push_back(bench::lookup_all(contender.maps, {queries_, footprints_}));
    }
}

void Seen::find_queries() {
    render::ViewSettings settings;
    settings.camera = scenario_->receivers.camera.value();
    settings.size = size_ = scenario_->receivers.resolution;
    const rays::Tracer all(scenario_->scene, false);
    const render::ShadingPoints points =
        render::find_shading_points(scenario_->scene, scenario_->lights, settings, all, {});
    render::PointQueries found = render::point_queries(points, scenario_->receivers, view_);
    std::uint32_t pixel = 0;
    for (const std::uint32_t point : found.point) {
        while (points.begin[pixel + 1] <= point) ++pixel;
        pixel_.push_back(pixel);
    }
    queries_ = std::move(found.queries);
    footprints_ = std::move(found.footprints);
}

std::vector<std::size_t> Seen::chosen(std::size_t count) const {
    return bench::choose_judged(queries_.size(), count, scenario_->reference.seed);
}

bench::Truth Seen::truth(std::span<const techniques::Query> queries) const {
    return bench::reference_visibility(scenario_->scene, view_, bench::reference_settings(*scenario_), queries, {});
}

render::Image Seen::picture(std::span<const float> values) const {
    render::Image image(size_, base::Vec3f(1.0f));
    for (std::size_t q = 0; q < pixel_.size(); ++q) image.pixels[pixel_[q]] = base::Vec3f(values[q]);
    return image;
}

nlohmann::json with_moved_map(nlohmann::json document, std::uint64_t seed) {
    nlohmann::json& light = document.at("lights").at(0);
    const nlohmann::json& resolution = document.at("rays").at("resolution");
    const double cells = resolution.is_array() ? resolution.at(0).get<double>() : resolution.get<double>();
    const base::Vec3d position = read_vector(light.at("position")), target = read_vector(light.at("target"));
    const double angle = light.at("angle").get<double>() * std::numbers::pi / 180.0;
    const double cell = (target - position).length() * 2.0 * std::tan(0.5 * angle) / cells;
    base::Random random(base::hash(seed, 0x63656c6cu));
    nlohmann::json moved = nlohmann::json::array();
    for (int axis = 0; axis < 3; ++axis) moved.push_back(target[axis] + cell * random.uniform(-0.5, 0.5));
    light["target"] = std::move(moved);
    return document;
}

void note_document(const Context& context, const std::string& name, const nlohmann::json& document) {
    context.report->documents.push_back(fmt::format("{} {}", name, base::hash_text(document.dump())));
}

}  // namespace shadowbench::claims

#include "claims/seen.h"

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/random.h"
#include "bench/contender.h"
#include "bench/memory.h"
#include "bench/queries.h"
#include "bench/ray_source.h"
#include "rays/capture.h"
#include "rays/tracer.h"
#include "render/point_queries.h"

namespace shadowbench::claims {
namespace {

base::Vec3d read_vector(const nlohmann::json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

}  // namespace

Seen::Seen(const nlohmann::json& document, const scene::SearchPath& data, const base::Vec2d& moved)
    : first_(document, data) {
    first_.light.view.lower += moved * first_.light.view.pixel;
    find_queries();
    const bench::MemoryLimits limits;
    const rays::Capture capture(first_.scenario.scene, first_.light.view, first_.light.layout);
    const bench::RaySource source(capture, first_.light.layout, limits.kept_rays, {});
    bench::build_all(first_.contenders, source, first_.input(), limits.all, {});
    for (bench::Contender& contender : first_.contenders) {
        if (!contender.ok())
            throw base::Error(base::ErrorCode::internal, contender.cell.technique, contender.cell.reason);
        visibility_.push_back(bench::lookup_all(contender.maps, {queries_, footprints_}));
        contender.maps = {};
    }
}

void Seen::find_queries() {
    render::ViewSettings settings;
    const scene::Scenario& scenario = first_.scenario;
    settings.camera = scenario.receivers.camera.value();
    settings.size = size_ = scenario.receivers.resolution;
    const rays::Tracer all(scenario.scene, false);
    const render::ShadingPoints points =
        render::find_shading_points(scenario.scene, scenario.lights, settings, all, {});
    render::PointQueries found = render::point_queries(points, scenario.receivers, first_.light.view);
    std::uint32_t pixel = 0;
    for (const std::uint32_t point : found.point) {
        while (points.begin[pixel + 1] <= point) ++pixel;
        pixel_.push_back(pixel);
        place_.push_back(points.place[point]);
        shade_.push_back(points.radiance[point].x);
    }
    queries_ = std::move(found.queries);
    footprints_ = std::move(found.footprints);
}

std::vector<std::size_t> Seen::chosen(std::size_t count) const {
    return bench::choose_judged(queries_.size(), count, first_.scenario.reference.seed);
}

bench::Truth Seen::truth(std::span<const techniques::Query> queries) const {
    return bench::reference_visibility(first_.scenario.scene, first_.light.view,
                                       bench::reference_settings(first_.scenario), queries, {});
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

}  // namespace shadowbench::claims

#include "render/point_queries.h"

#include "bench/queries.h"

namespace shadowbench::render {

PointQueries point_queries(const ShadingPoints& points, const scene::Receivers& receivers, const rays::LightView& view,
                           const std::optional<scene::FilterWidth>& softness) {
    PointQueries result;
    result.queries.reserve(points.points());
    result.footprints.reserve(points.points());
    result.point.reserve(points.points());
    for (std::size_t i = 0; i < points.points(); ++i) {
        const bench::CameraPoint point{points.place[i], base::Vec3d(points.across[i]), base::Vec3d(points.down[i]),
                                       base::Vec3d(points.normal[i])};
        const auto query = bench::query_of_point(point, receivers, view, softness);
        if (!query) continue;
        result.queries.push_back(*query);
        result.footprints.push_back(bench::footprint_of(point, view));
        result.point.push_back(static_cast<std::uint32_t>(i));
    }
    return result;
}

}  // namespace shadowbench::render

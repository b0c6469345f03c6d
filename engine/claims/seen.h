// What a scenario's camera sees, looked up through the maps of its first light: the visibilities themselves, where a
// run gives their errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/reference.h"
#include "claims/first_light.h"
#include "render/image.h"
#include "render/shading_points.h"
#include "techniques/technique.h"

namespace shadowbench::claims {

class Seen {
public:
    // For a document with a camera and opaque surfaces. Its first variant counts. `moved`: cells by which the whole map
    // lies further along its own axes, in the plane that it divides. Throws Error{internal} for a technique that fails.
    Seen(const nlohmann::json& document, const scene::SearchPath& data, const base::Vec2d& moved = {0.0, 0.0});
    Seen(const Seen&) = delete;
    Seen& operator=(const Seen&) = delete;

    // One query for each pixel that sees a surface inside the light's map.
    std::span<const techniques::Query> queries() const { return queries_; }
    std::uint32_t pixel(std::size_t query) const { return pixel_[query]; }       // row after row
    const base::Vec3d& place(std::size_t query) const { return place_[query]; }  // on the surface, in the world
    // What the light adds to the red channel of its pixel where nothing shadows it: see render/shading.h.
    float shade(std::size_t query) const { return shade_[query]; }
    base::Vec2i size() const { return size_; }  // pixels

    // The answers of the technique with this place in the document, one a query.
    std::span<const float> visibility(std::size_t technique) const { return visibility_[technique]; }

    // Places of `count` of the queries, spread over the picture.
    std::vector<std::size_t> chosen(std::size_t count) const;

    // The truth of the document's reference for any queries to the light.
    bench::Truth truth(std::span<const techniques::Query> queries) const;

    // One value a query, as a picture; pixels without a query are white.
    render::Image picture(std::span<const float> values) const;

private:
    void find_queries();

    FirstLight first_;
    base::Vec2i size_{0, 0};
    std::vector<techniques::Query> queries_;
    std::vector<techniques::Footprint> footprints_;
    std::vector<std::uint32_t> pixel_;
    std::vector<base::Vec3d> place_;
    std::vector<float> shade_;
    std::vector<std::vector<float>> visibility_;
};

// The document with the target of its first light, a spot of a given angle, moved by up to half a cell of its map along
// each axis of the world. So the cells lie at random places of the same scene.
nlohmann::json with_moved_map(nlohmann::json document, std::uint64_t seed);

}  // namespace shadowbench::claims

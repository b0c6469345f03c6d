#include "rays/surfaces.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <variant>

#include "rays/traced_primitives.h"

namespace shadowbench::rays {
namespace {

using base::Vec3d;

constexpr double same_place = 1e-4;  // relative depth within which crossings of one edge at two slopes lie

// Finds the crossings that are duplicates: those that the deflected ray does not have, if the ray has another crossing
// at the same place, unless they are the first there (at a mesh's border the deflected ray may have none).
std::vector<unsigned char> found_twice(const TracedRay& ray, const std::vector<Crossing>& crossings) {
    std::vector<unsigned char> beside(crossings.size()), twice(crossings.size(), 0);
    for (std::size_t i = 0; i < crossings.size(); ++i)
        if (const Crossing& c = crossings[i]; c.at_edge)
            beside[i] =
                crosses_beside(*c.traced->object, std::get<scene::Mesh>(c.traced->object->shape), c.primitive, ray);
    const auto met = [&](const Crossing& a, const Crossing& b) {
        return b.at_edge && a.geometry == b.geometry && std::abs(a.depth - b.depth) <= same_place * std::abs(a.depth);
    };
    for (std::size_t i = 0; i < crossings.size(); ++i)
        for (std::size_t j = 0; j < crossings.size() && crossings[i].at_edge && !beside[i] && !twice[i]; ++j)
            twice[i] = j != i && met(crossings[i], crossings[j]) && (beside[j] || j < i);
    return twice;
}

void complete(const TracedRay& ray, SurfaceHit& hit) {
    hit.position = ray.origin + ray.direction * hit.t;
    if (hit.tangent != Vec3d(0.0)) hit.normal = hit.tangent * hit.tangent.dot(ray.direction) - ray.direction;
    if (hit.normal.dot(ray.direction) > 0.0) hit.normal = -hit.normal;
    const double length = hit.normal.length();
    hit.normal = length > 0.0 ? hit.normal / length : -ray.direction.normalized();
}

}  // namespace

void order_crossings(const TracedRay& ray, std::vector<Crossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return std::tie(a.depth, a.geometry, a.primitive) < std::tie(b.depth, b.geometry, b.primitive);
    });
    if (std::count_if(crossings.begin(), crossings.end(), [](const Crossing& c) { return c.at_edge; }) < 2) return;
    const std::vector<unsigned char> twice = found_twice(ray, crossings);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i)
        if (!twice[i]) crossings[kept++] = crossings[i];
    crossings.resize(kept);
}

bool take_surfaces(const TracedRay& ray, const std::vector<Crossing>& crossings, std::vector<SurfaceHit>& out) {
    Vec3d left(1.0);
    for (const Crossing& crossing : crossings) {
        out.push_back(crossing.hit);
        complete(ray, out.back());
        left *= Vec3d(1.0) - crossing.hit.opacity;
        if (left == Vec3d(0.0)) return true;
    }
    return false;
}

}  // namespace shadowbench::rays

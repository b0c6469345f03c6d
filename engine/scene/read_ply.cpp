// The Stanford polygon format (Greg Turk, The PLY Polygon File Format, 1994), ASCII and binary of both byte orders.
// Elements other than vertices and faces are read past.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/ply_source.h"
#include "scene/read_mesh.h"

namespace shadowbench::scene {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

// Where in an element the property with one of these names stands.
std::size_t find(const PlyElement& element, std::initializer_list<const char*> names) {
    for (const char* name : names)
        for (std::size_t i = 0; i < element.properties.size(); ++i)
            if (element.properties[i].name == name) return i;
    return none;
}

struct Vertices {
    std::vector<Vec3f> positions;
    std::vector<Vec2f> uv;  // one a vertex, or empty
};

Vertices read_vertices(PlySource& source, const PlyElement& element) {
    const std::array at{find(element, {"x"}), find(element, {"y"}), find(element, {"z"})};
    const std::array uv_at{find(element, {"u", "s", "texture_u"}), find(element, {"v", "t", "texture_v"})};
    for (const std::size_t place : at)
        if (place == none || element.properties[place].is_list) source.fail("vertices need the numbers x, y and z");
    const bool textured = uv_at[0] != none && uv_at[1] != none;
    Vertices vertices;
    vertices.positions.reserve(element.count);
    std::vector<double> row(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.is_list) {
                source.skip(property);
                continue;
            }
            row[p] = source.value(property.type);
            const bool needed = std::find(at.begin(), at.end(), p) != at.end() ||
                                (textured && std::find(uv_at.begin(), uv_at.end(), p) != uv_at.end());
            if (needed && !(std::abs(row[p]) <= max_coordinate))
                source.fail(fmt::format("vertex {}: {} is {}, not a finite number below {}", i, property.name, row[p],
                                        max_coordinate));
        }
        vertices.positions.emplace_back(Vec3d(row[at[0]], row[at[1]], row[at[2]]));
        if (textured) vertices.uv.emplace_back(Vec2d(row[uv_at[0]], row[uv_at[1]]));
    }
    return vertices;
}

std::vector<int> read_corners(PlySource& source, const PlyProperty& property, std::size_t vertices,
                              std::uint64_t face) {
    const std::uint64_t count = source.list_size(property);
    if (count < 3) source.fail(fmt::format("face {} has {} corners", face, count));
    std::vector<int> corners;
    corners.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        const double index = source.value(property.type);
        if (!(index >= 0.0 && index < static_cast<double>(vertices)) || index != std::floor(index))
            source.fail(fmt::format("face {} names vertex {}, but there are {}", face, index, vertices));
        corners.push_back(static_cast<int>(index));
    }
    return corners;
}

void read_faces(PlySource& source, const PlyElement& element, const Vertices& vertices, Mesh& mesh) {
    const std::size_t at = find(element, {"vertex_indices", "vertex_index"});
    if (at == none || !element.properties[at].is_list) source.fail("faces need the list vertex_indices");
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            if (p != at) {
                source.skip(element.properties[p]);
                continue;
            }
            const std::vector<int> corners = read_corners(source, element.properties[p], vertices.positions.size(), i);
            std::vector<Vec2f> uv;
            if (!vertices.uv.empty())
                for (const int corner : corners) uv.push_back(vertices.uv[static_cast<std::size_t>(corner)]);
            add_fan(mesh, corners, uv);
            if (mesh.triangles.size() > max_mesh_elements)
                source.fail(fmt::format("over {} triangles", max_mesh_elements));
        }
}

}  // namespace

Mesh read_ply(const std::filesystem::path& file) {
    PlySource source(file);
    Mesh mesh;
    std::optional<Vertices> vertices;
    for (const PlyElement& element : source.elements()) {
        source.check_length(element);
        if (element.name == "vertex") {
            // Faces name the vertices of the first.
            if (vertices) source.fail("a second element \"vertex\"; one is read");
            vertices = read_vertices(source, element);
        } else if (element.name == "face") {
            if (!vertices) source.fail("faces stand before the vertices");
            read_faces(source, element, *vertices, mesh);
        } else if (!element.properties.empty()) {
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const PlyProperty& property : element.properties) source.skip(property);
        }
    }
    if (!vertices) source.fail("there are no vertices");
    mesh.positions = std::move(vertices->positions);
    return mesh;
}

}  // namespace shadowbench::scene

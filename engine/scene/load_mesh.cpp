#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

Mesh inline_mesh(const json& from, const std::string& where) {
    for (const char* key : {"vertices", "triangles"})
        if (!from.contains(key))
            refuse(where, fmt::format("\"{}\" is missing: a mesh has a file, or vertices and triangles", key));
    Mesh mesh;
    read(from, "vertices", mesh.positions);
    read(from, "triangles", mesh.triangles);
    const auto count = static_cast<int>(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            if (mesh.triangles[i][corner] >= count)
                refuse(fmt::format("{}/triangles/{}/{}", where, i, corner),
                       fmt::format("index {}, but there are {} vertices", mesh.triangles[i][corner], count));
    std::vector<Vec2f> uvs;
    read(from, "uvs", uvs);
    if (uvs.empty()) return mesh;
    if (uvs.size() != mesh.positions.size())
        refuse(where + "/uvs",
               fmt::format("{} pairs for {} vertices; give one for each vertex", uvs.size(), mesh.positions.size()));
    for (const Vec3i& triangle : mesh.triangles)
        for (const int index : {triangle.x, triangle.y, triangle.z})
            mesh.corner_uv.push_back(uvs[static_cast<std::size_t>(index)]);
    return mesh;
}

std::string no_triangles(const MeshFile& file) {
    if (file.passed_over.empty() && !file.mesh.positions.empty())
        return fmt::format(
            "a point cloud: {} vertices and no faces; a mesh needs faces, and points are drawn by an object of type "
            "particles, which takes a .ply file and a radius, or by one of type spheres",
            file.mesh.positions.size());
    std::string message = "the mesh has no triangles";
    for (const PassedOver& each : file.passed_over)
        message += fmt::format("{}{} ({})", &each == file.passed_over.data() ? "; passed over: " : ", ", each.what,
                               each.count);
    return message;
}

bool in_range(const Vec3d& position) {
    return std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) <= max_coordinate;
}

void load_alpha(const json& from, const SearchPath& path, const std::string& where, Mesh& mesh) {
    std::string name;
    read(from, "alpha_texture", name);
    if (name.empty()) {
        if (!mesh.alpha) mesh.corner_uv.clear();
        return;
    }
    if (mesh.alpha)
        refuse(where + "/alpha_texture", "the materials of the file have an alpha texture already; remove this one");
    if (mesh.corner_uv.empty())
        refuse(where + "/alpha_texture", "the mesh has no texture coordinates to place the texture");
    mesh.alpha = std::make_shared<const AlphaTexture>(read_alpha(find_file(path, name, where + "/alpha_texture")));
}

struct Parallelogram {
    Vec3d corner{0, 0, 0}, edge_u{0, 0, 0}, edge_v{0, 0, 0};
};

Parallelogram read_parallelogram(const json& from, const std::string& where) {
    Parallelogram shape;
    read(from, "corner", shape.corner);
    read(from, "edge_u", shape.edge_u);
    read(from, "edge_v", shape.edge_v);
    check_direction(shape.edge_u, where + "/edge_u");
    check_direction(shape.edge_v, where + "/edge_v");
    check_not_parallel(shape.edge_u, shape.edge_v, where + "/edge_v",
                       "edge_u and edge_v lie along one line: no area between them");
    return shape;
}

// The corners in the order of the outline.
std::array<Vec3d, 4> corners(const Parallelogram& shape) {
    const Vec3d& corner = shape.corner;
    return {corner, corner + shape.edge_u, corner + shape.edge_u + shape.edge_v, corner + shape.edge_v};
}

}  // namespace

MeshFile load_mesh(const json& from, const SearchPath& path, const std::string& where) {
    const bool from_file = from.contains("file");
    if (from_file)
        for (const char* key : {"vertices", "triangles", "uvs"})
            if (from.contains(key))
                refuse(fmt::format("{}/{}", where, key), "the mesh already has a file; remove one of the two");
    MeshFile file;
    if (from_file) {
        const std::filesystem::path name = find_file(path, from["file"].get<std::string>(), where + "/file");
        file = read_mesh(name);
        if (file.mesh.triangles.empty())
            throw base::Error(base::ErrorCode::bad_input, name.string(), no_triangles(file));
    } else {
        file.mesh = inline_mesh(from, where);
    }
    load_alpha(from, path, where, file.mesh);
    return file;
}

Mesh load_quad(const json& from, const SearchPath& path, const std::string& where) {
    const Parallelogram quad = read_parallelogram(from, where);
    Mesh mesh;
    for (const Vec3d& point : corners(quad)) {
        if (!in_range(point)) refuse(where, fmt::format("corner and edges reach beyond {}", max_coordinate));
        mesh.positions.emplace_back(point);
    }
    mesh.triangles = {Vec3i(0, 1, 2), Vec3i(0, 2, 3)};
    mesh.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    load_alpha(from, path, where, mesh);
    return mesh;
}

Mesh load_layers(const json& from, const std::string& where) {
    const Parallelogram first = read_parallelogram(from, where);
    Vec3d offset(0, 0, 0);
    int count = 0;
    read(from, "offset", offset);
    read(from, "count", count);
    Mesh mesh;
    mesh.positions.reserve(4 * static_cast<std::size_t>(count));
    mesh.triangles.reserve(2 * static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const int at = 4 * i;
        for (const Vec3d& point : corners(first)) mesh.positions.emplace_back(point + offset * i);
        mesh.triangles.emplace_back(at, at + 1, at + 2);
        mesh.triangles.emplace_back(at, at + 2, at + 3);
    }
    for (const Vec3f& position : mesh.positions)
        if (!in_range(Vec3d(position))) refuse(where, fmt::format("the layers reach beyond {}", max_coordinate));
    return mesh;
}

}  // namespace shadowbench::scene

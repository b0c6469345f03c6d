// The Stanford polygon format (Greg Turk, The PLY Polygon File Format, 1994), ASCII and binary of both byte orders.
// Elements other than vertices, faces and triangle strips are passed over.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/ply_source.h"
#include "scene/readers/read_mesh.h"

namespace shadowbench::scene {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

// The index in an element of the property with one of these names.
std::size_t find(const PlyElement& element, std::initializer_list<const char*> names) {
    for (const char* name : names)
        for (std::size_t i = 0; i < element.properties.size(); ++i)
            if (element.properties[i].name == name) return i;
    return none;
}

// Returns the texture coordinates: one for each vertex, or none.
std::vector<Vec2f> read_vertices(PlySource& source, const PlyElement& element, std::vector<Vec3f>& positions) {
    const std::array at{find(element, {"x"}), find(element, {"y"}), find(element, {"z"})};
    const std::array uv_at{find(element, {"u", "s", "texture_u"}), find(element, {"v", "t", "texture_v"})};
    for (const std::size_t place : at)
        if (place == none || element.properties[place].is_list) source.fail("vertices need the numbers x, y and z");
    const bool textured = uv_at[0] != none && uv_at[1] != none;
    std::vector<Vec2f> uvs;
    positions.reserve(element.count);
    if (textured) uvs.reserve(element.count);
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
        positions.emplace_back(Vec3d(row[at[0]], row[at[1]], row[at[2]]));
        if (textured) uvs.emplace_back(Vec2d(row[uv_at[0]], row[uv_at[1]]));
    }
    return uvs;
}

struct List {
    const PlyElement& element;
    std::uint64_t number;
};
std::string name(const List& list) {
    return fmt::format("{} {}", list.element.name, list.number);
}

constexpr int strip_end = -1;

int read_index(PlySource& source, PlyType type, std::size_t vertices, const List& list, bool strip) {
    const double index = source.value(type);
    // Read as unsigned, -1 is the largest number; no file has so many vertices.
    constexpr double unsigned_end = std::numeric_limits<std::uint32_t>::max();
    if (strip && (index == strip_end || index == unsigned_end)) return strip_end;
    if (!(index >= 0.0 && index < static_cast<double>(vertices)) || index != std::floor(index))
        source.fail(fmt::format("{} names vertex {}, but there are {}", name(list), index, vertices));
    return static_cast<int>(index);
}

void add_face(PlySource& source, const std::vector<Vec2f>& uvs, const std::vector<int>& corners, const List& list,
              MeshFile& file) {
    std::vector<Vec2f> uv;
    if (!uvs.empty())
        for (const int corner : corners) uv.push_back(uvs[static_cast<std::size_t>(corner)]);
    const std::string fault = add_polygon(file, corners, uv);
    if (!fault.empty()) source.fail(fmt::format("{}: {}", name(list), fault));
    if (file.mesh.triangles.size() > max_mesh_elements)
        source.fail(fmt::format("over {} triangles", max_mesh_elements));
}

// Every vertex from the third on makes a triangle with the two before it, with alternating orientation. A strip repeats
// vertices to continue elsewhere: those triangles are degenerate and are dropped.
void add_strips(PlySource& source, const std::vector<Vec2f>& uvs, const std::vector<int>& strips, const List& list,
                MeshFile& file) {
    const auto end_of_strip = [&](std::size_t vertices) {
        if (vertices == 1 || vertices == 2) pass_over(file, "strips of fewer than 3 vertices");
    };
    std::size_t begin = 0;
    for (std::size_t i = 0; i < strips.size(); ++i) {
        if (strips[i] == strip_end) {
            end_of_strip(i - begin);
            begin = i + 1;
            continue;
        }
        if (i < begin + 2) continue;
        const int a = strips[i - 2], b = strips[i - 1], c = strips[i];
        if (a == b || b == c || c == a) continue;
        const bool odd = (i - begin) % 2 == 1;
        add_face(source, uvs, odd ? std::vector{b, a, c} : std::vector{a, b, c}, list, file);
    }
    end_of_strip(strips.size() - begin);
}

// Reads faces or, with `strips`, triangle strips.
void read_faces(PlySource& source, const PlyElement& element, bool strips, const std::vector<Vec2f>& uvs,
                MeshFile& file) {
    const std::size_t at = find(element, {"vertex_indices", "vertex_index"});
    if (at == none || !element.properties[at].is_list) source.fail(element.name + " needs the list vertex_indices");
    if (!strips) {
        const auto triangles = static_cast<std::size_t>(source.most_of(element, 3));
        file.mesh.triangles.reserve(triangles);
        if (!uvs.empty()) file.mesh.corner_uv.reserve(3 * triangles);
    }
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (p != at) {
                source.skip(property);
                continue;
            }
            const List list{element, i};
            std::vector<int> corners(source.list_size(property));
            for (int& corner : corners)
                corner = read_index(source, property.type, file.mesh.positions.size(), list, strips);
            (strips ? add_strips : add_face)(source, uvs, corners, list, file);
        }
}

}  // namespace

MeshFile read_ply(const std::filesystem::path& file) {
    PlySource source(file);
    MeshFile result;
    std::optional<std::vector<Vec2f>> uvs;
    for (const PlyElement& element : source.elements()) {
        source.check_length(element);
        if (element.name == "vertex") {
            // Faces refer to the vertices of the first element.
            if (uvs) source.fail("a second element \"vertex\"; one is read");
            uvs = read_vertices(source, element, result.mesh.positions);
        } else if (element.name == "face" || element.name == "tristrips") {
            if (!uvs) source.fail("faces stand before the vertices");
            read_faces(source, element, element.name == "tristrips", *uvs, result);
        } else if (!element.properties.empty()) {
            const std::string name = is_word(element.name) ? fmt::format("\"{}\"", element.name) : "of another name";
            if (element.count > 0) pass_over(result, "elements " + name, element.count);
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const PlyProperty& property : element.properties) source.skip(property);
        }
    }
    if (!uvs) source.fail("there are no vertices");
    source.finish();
    return result;
}

}  // namespace shadowbench::scene

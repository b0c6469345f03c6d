// Wavefront OBJ through tinyobjloader. The library reads a word that is not a number as 0, drops faces it cannot use,
// and allocates memory for counts that stand in other lines. So it gets only vertices, texture coordinates and faces,
// which have been checked; that check also gives faults their line. The library reports them one by one, because its
// own meshes hold the number of a polygon's corners in a byte.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "base/error.h"
#include "base/read_text.h"
#include "scene/limits.h"
#include "scene/readers/obj_lines.h"
#include "scene/readers/read_mesh.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

constexpr int no_uv = -1;

// Faces may stand before their vertices, so they are split when everything has been read.
struct Content {
    std::vector<Vec3f> positions;
    std::vector<Vec2f> uvs;
    std::vector<int> vertex, uv;    // of the corners of all faces
    std::vector<std::size_t> ends;  // of the faces among the corners
};

// The library counts from 1, or back from the last one so far.
int index(int named, std::size_t so_far) {
    return named > 0 ? named - 1 : static_cast<int>(so_far) + named;
}

void take_vertex(void* to, float x, float y, float z, float) {
    static_cast<Content*>(to)->positions.emplace_back(x, y, z);
}

void take_uv(void* to, float u, float v, float) {
    static_cast<Content*>(to)->uvs.emplace_back(u, v);
}

void take_face(void* to, tinyobj::index_t* corners, int count) {
    auto& content = *static_cast<Content*>(to);
    for (int i = 0; i < count; ++i) {
        content.vertex.push_back(index(corners[i].vertex_index, content.positions.size()));
        const int uv = corners[i].texcoord_index;
        content.uv.push_back(uv == 0 ? no_uv : index(uv, content.uvs.size()));
    }
    content.ends.push_back(content.vertex.size());
}

Content read_content(std::string lines) {
    Content content;
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = take_vertex;
    callbacks.texcoord_cb = take_uv;
    callbacks.index_cb = take_face;
    std::istringstream stream(std::move(lines));
    tinyobj::LoadObjWithCallback(stream, callbacks, &content);
    return content;
}

void check_content(const Content& content, const std::filesystem::path& name) {
    const auto fail = [&](const std::string& message) { throw Error(ErrorCode::bad_input, name.string(), message); };
    if (content.vertex.size() > 3 * max_mesh_elements) fail(fmt::format("over {} triangles", max_mesh_elements));
    // The library parses digits and exponents in its own way and can lose numbers that the lines hold.
    const auto finite = [](const auto& at) { return std::isfinite(at.x) && std::isfinite(at.y); };
    for (const Vec3f& at : content.positions)
        if (!finite(at) || !std::isfinite(at.z)) fail("a number has more digits or a larger exponent than can be read");
    for (const Vec2f& at : content.uvs)
        if (!finite(at)) fail("a number has more digits or a larger exponent than can be read");
}

}  // namespace

MeshFile read_obj(const std::filesystem::path& name) {
    const std::string text = base::read_text(name);
    if (text.empty()) throw Error(ErrorCode::bad_input, name.string(), "the file is empty");
    MeshFile file;
    ObjLines lines = check_obj(text, name, file);
    Content content = read_content(std::move(lines.kept));
    check_content(content, name);
    file.mesh.positions = std::move(content.positions);
    // Texture coordinates are kept if every corner has them.
    bool textured = true;
    std::vector<int> corners;
    std::vector<Vec2f> uv;
    for (std::size_t face = 0, corner = 0; face < content.ends.size(); ++face) {
        corners.assign(content.vertex.begin() + static_cast<std::ptrdiff_t>(corner),
                       content.vertex.begin() + static_cast<std::ptrdiff_t>(content.ends[face]));
        uv.clear();
        for (; corner < content.ends[face]; ++corner)
            if (content.uv[corner] != no_uv) uv.push_back(content.uvs[static_cast<std::size_t>(content.uv[corner])]);
        if (uv.size() != corners.size()) {
            textured = false;
            uv.clear();
        }
        const std::string fault = add_polygon(file, corners, uv);
        if (!fault.empty())
            throw Error(ErrorCode::bad_input, fmt::format("{}:{}", name.string(), lines.line_of_face[face]), fault);
    }
    if (!textured) file.mesh.corner_uv.clear();
    return file;
}

}  // namespace shadowbench::scene

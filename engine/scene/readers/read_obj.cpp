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

// The library counts from 1, or back from the last one so far.
int index(int named, std::size_t so_far) {
    return named > 0 ? named - 1 : static_cast<int>(so_far) + named;
}

class ObjReader {
public:
    explicit ObjReader(const std::filesystem::path& name) : name_(name) {}

    MeshFile read() {
        const std::string text = base::read_text(name_);
        if (text.empty()) fail("the file is empty");
        check_obj(text, name_, file_, [&](ObjLines& lines) { take(lines); });
        add_faces();
        if (!textured_) file_.mesh.corner_uv.clear();
        return std::move(file_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorCode::bad_input, name_.string(), message);
    }

    static ObjReader& reader(void* to) { return *static_cast<ObjReader*>(to); }

    static void take_vertex(void* to, float x, float y, float z, float) {
        reader(to).file_.mesh.positions.emplace_back(x, y, z);
    }

    static void take_uv(void* to, float u, float v, float) { reader(to).uvs_.emplace_back(u, v); }

    static void take_face(void* to, tinyobj::index_t* corners, int count) {
        ObjReader& from = reader(to);
        for (int i = 0; i < count; ++i) {
            from.vertex_.push_back(index(corners[i].vertex_index, from.file_.mesh.positions.size()));
            const int uv = corners[i].texcoord_index;
            from.uv_.push_back(uv == 0 ? no_uv : index(uv, from.uvs_.size()));
        }
        from.ends_.push_back(from.vertex_.size());
    }

    void take(ObjLines& lines) {
        const std::size_t positions = file_.mesh.positions.size(), uvs = uvs_.size(), corners = vertex_.size();
        tinyobj::callback_t callbacks;
        callbacks.vertex_cb = take_vertex;
        callbacks.texcoord_cb = take_uv;
        callbacks.index_cb = take_face;
        std::istringstream stream(std::move(lines.kept));
        tinyobj::LoadObjWithCallback(stream, callbacks, this);
        line_of_face_.insert(line_of_face_.end(), lines.line_of_face.begin(), lines.line_of_face.end());
        corners_ += vertex_.size() - corners;
        if (corners_ > 3 * max_mesh_elements) fail(fmt::format("over {} triangles", max_mesh_elements));
        check_numbers(positions, uvs);
        // The others wait for vertices that stand behind them, and are split when everything has been read.
        wait_ = wait_ || !all_there();
        if (!wait_) add_faces();
    }

    // The library parses digits and exponents in its own way and can lose numbers that the lines hold.
    void check_numbers(std::size_t first_position, std::size_t first_uv) const {
        const auto check = [&](float number) {
            if (!std::isfinite(number)) fail("a number has more digits or a larger exponent than can be read");
        };
        const std::vector<Vec3f>& positions = file_.mesh.positions;
        for (std::size_t i = first_position; i < positions.size(); ++i)
            for (int axis = 0; axis < 3; ++axis) check(positions[i][axis]);
        for (std::size_t i = first_uv; i < uvs_.size(); ++i)
            for (int axis = 0; axis < 2; ++axis) check(uvs_[i][axis]);
    }

    bool all_there() const {
        const auto there = [](int number, std::size_t count) {
            return number >= 0 && static_cast<std::size_t>(number) < count;
        };
        for (std::size_t i = 0; i < vertex_.size(); ++i)
            if (!there(vertex_[i], file_.mesh.positions.size()) || (uv_[i] != no_uv && !there(uv_[i], uvs_.size())))
                return false;
        return true;
    }

    void add_faces() {
        std::vector<int> corners;
        std::vector<Vec2f> uv;
        for (std::size_t face = 0, corner = 0; face < ends_.size(); ++face) {
            corners.assign(vertex_.begin() + static_cast<std::ptrdiff_t>(corner),
                           vertex_.begin() + static_cast<std::ptrdiff_t>(ends_[face]));
            uv.clear();
            for (; corner < ends_[face]; ++corner)
                if (uv_[corner] != no_uv) uv.push_back(uvs_[static_cast<std::size_t>(uv_[corner])]);
            if (uv.size() != corners.size()) {
                textured_ = false;
                uv.clear();
            }
            const std::string fault = add_polygon(file_, corners, uv);
            if (!fault.empty())
                throw Error(ErrorCode::bad_input, fmt::format("{}:{}", name_.string(), line_of_face_[face]), fault);
        }
        vertex_.clear();
        uv_.clear();
        ends_.clear();
        line_of_face_.clear();
    }

    const std::filesystem::path& name_;
    MeshFile file_;
    std::vector<Vec2f> uvs_;
    // The faces that are not in the mesh yet.
    std::vector<int> vertex_, uv_;           // of the corners of all
    std::vector<std::size_t> ends_;          // of each among the corners
    std::vector<std::size_t> line_of_face_;  // of each
    std::uint64_t corners_ = 0;              // of all faces of the file so far
    bool wait_ = false;
    bool textured_ = true;  // texture coordinates are kept if every corner has them
};

}  // namespace

MeshFile read_obj(const std::filesystem::path& name) {
    return ObjReader(name).read();
}

}  // namespace shadowbench::scene

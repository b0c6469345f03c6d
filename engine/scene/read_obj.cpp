// Wavefront OBJ through tinyobjloader. The library takes what is not a number as 0, drops faces it cannot use, and
// takes memory for counts that stand in other lines. So it is given vertices, texture coordinates and faces alone,
// checked; that also gives faults their line.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "base/error.h"
#include "base/read_text.h"
#include "scene/limits.h"
#include "scene/read_mesh.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

// The words of a line, taken one by one; empty at its end.
std::string_view next_word(std::string_view& line) {
    const std::size_t from = line.find_first_not_of(" \t\r");
    if (from == std::string_view::npos) return {};
    const std::size_t to = std::min(line.find_first_of(" \t\r", from), line.size());
    const std::string_view word = line.substr(from, to - from);
    line.remove_prefix(to);
    return word;
}

class LineCheck {
public:
    explicit LineCheck(const std::filesystem::path& file) : file_(file) {}

    void check(std::string_view line) {
        ++number_;
        const std::string_view keyword = next_word(line);
        if (keyword != "v" && keyword != "vt" && keyword != "f") return;
        kept_ += keyword;
        if (keyword == "v") {
            numbers(line, 3);
            ++vertices_;
        }
        if (keyword == "vt") numbers(line, 1);
        if (keyword == "f") corners(line);
        kept_ += '\n';
    }

    // The checked lines. Faces may stand before their vertices, so whether all of these are there is known at the end
    // only.
    std::string finish() {
        if (highest_ <= vertices_) return std::move(kept_);
        number_ = highest_at_;
        fail(fmt::format("a face names vertex {}, but there are {}", highest_, vertices_));
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorCode::bad_input, fmt::format("{}:{}", file_.string(), number_), message);
    }

    void numbers(std::string_view line, int least) {
        int count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
            if (word.front() == '+') word.remove_prefix(1);
            double value = 0.0;
            const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (fault != std::errc() || end != word.data() + word.size() || !(std::abs(value) <= max_coordinate))
                fail(fmt::format("\"{}\" is not a finite number below {}", word.substr(0, 40), max_coordinate));
            kept_.append(1, ' ').append(word);
        }
        if (count < least) fail(fmt::format("{} numbers where {} are needed", count, least));
    }

    void corners(std::string_view line) {
        // The library holds a polygon's corners in a byte.
        constexpr int most = 255;
        int count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
            std::int64_t vertex = 0, uv = 0;
            const char* const last = word.data() + word.size();
            std::from_chars_result read = std::from_chars(word.data(), last, vertex);
            const bool has_uv =
                read.ec == std::errc() && last - read.ptr > 1 && read.ptr[0] == '/' && read.ptr[1] != '/';
            if (has_uv) read = std::from_chars(read.ptr + 1, last, uv);
            // The index of a normal may follow.
            if (read.ec != std::errc() || (read.ptr != last && *read.ptr != '/') || uv != static_cast<int>(uv) ||
                word.find_first_not_of("0123456789-/") != std::string_view::npos)
                fail(fmt::format("\"{}\" is not a face's corner", word.substr(0, 40)));
            // Negative numbers count back from the last vertex so far.
            if (vertex == 0 || vertex < -vertices_)
                fail(fmt::format("a face names vertex {}, but there are {} so far", vertex, vertices_));
            kept_ += has_uv ? fmt::format(" {}/{}", vertex, uv) : fmt::format(" {}", vertex);
            if (vertex <= highest_) continue;
            highest_ = vertex;
            highest_at_ = number_;
        }
        if (count < 3 || count > most) fail(fmt::format("a face of {} corners; 3 to {} are read", count, most));
    }

    const std::filesystem::path& file_;
    std::size_t number_ = 0;
    std::int64_t vertices_ = 0;
    std::int64_t highest_ = 0;  // vertex that a face names, and the line of that face
    std::size_t highest_at_ = 0;
    std::string kept_;
};

std::string checked_lines(const std::string& text, const std::filesystem::path& file) {
    LineCheck check(file);
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t to = std::min(text.find('\n', from), text.size());
        check.check(std::string_view(text).substr(from, to - from));
        from = to + 1;
    }
    return check.finish();
}

class Converter {
public:
    Converter(const tinyobj::attrib_t& attributes, const std::filesystem::path& file)
        : attributes_(attributes), file_(file) {
        const std::vector<tinyobj::real_t>& v = attributes.vertices;
        if (v.size() / 3 > max_mesh_elements) fail(fmt::format("over {} vertices", max_mesh_elements));
        // The library's own reading of digits and exponents: it can lose numbers that the lines hold.
        for (const auto* numbers : {&attributes.vertices, &attributes.texcoords})
            for (const tinyobj::real_t number : *numbers)
                if (!std::isfinite(number)) fail("a number has more digits or a larger exponent than can be read");
        for (std::size_t i = 0; i + 2 < v.size(); i += 3) mesh_.positions.emplace_back(v[i], v[i + 1], v[i + 2]);
    }

    void add(const tinyobj::mesh_t& part) {
        std::size_t next = 0;
        for (const std::size_t count : part.num_face_vertices) {
            std::vector<int> corners;
            std::vector<Vec2f> uv;
            for (std::size_t i = 0; i < count; ++i) {
                const tinyobj::index_t& index = part.indices.at(next++);
                corners.push_back(checked(index.vertex_index, mesh_.positions.size(), "vertex"));
                if (index.texcoord_index < 0) continue;
                const int at = checked(index.texcoord_index, attributes_.texcoords.size() / 2, "texture coordinate");
                uv.emplace_back(attributes_.texcoords[static_cast<std::size_t>(at) * 2],
                                attributes_.texcoords[static_cast<std::size_t>(at) * 2 + 1]);
            }
            textured_ = textured_ && uv.size() == count;
            if (!textured_) uv.clear();
            add_fan(mesh_, corners, uv);
        }
    }

    // Texture coordinates are kept when every corner has them.
    Mesh take() {
        if (!textured_) mesh_.corner_uv.clear();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorCode::bad_input, file_.string(), message);
    }

    int checked(int index, std::size_t count, const char* what) const {
        if (index < 0 || static_cast<std::size_t>(index) >= count)
            fail(fmt::format("a face names {} {}, but there are {}", what, index + 1, count));
        return index;
    }

    const tinyobj::attrib_t& attributes_;
    const std::filesystem::path& file_;
    Mesh mesh_;
    bool textured_ = true;
};

}  // namespace

Mesh read_obj(const std::filesystem::path& file) {
    const std::string text = base::read_text(file);
    if (text.empty()) throw Error(ErrorCode::bad_input, file.string(), "the file is empty");
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, faults;
    std::istringstream stream(checked_lines(text, file));
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &faults, &stream, nullptr, false, false))
        throw Error(ErrorCode::bad_input, file.string(), "not a readable OBJ file: " + faults);
    Converter converter(attributes, file);
    for (const tinyobj::shape_t& shape : shapes) converter.add(shape.mesh);
    return converter.take();
}

}  // namespace shadowbench::scene

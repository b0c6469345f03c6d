// The STL format (3D Systems, Stereolithography Interface Specification, 1989), text and binary. A file lists the
// corners of its triangles by their positions, three each. Normals and the attributes of binary triangles are not read.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"
#include "scene/limits.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/read_mesh.h"
#include "scene/readers/text_lines.h"

namespace shadowbench::scene {
namespace {

struct Corner {
    Vec3f at;
    std::uint32_t number = 0;  // among the corners of the file: three times that of the triangle, and 0, 1 or 2
};
static_assert(3 * max_mesh_elements < (std::uint64_t{1} << 31), "corners and vertices are counted in 31 bits");

void add(std::vector<Corner>& corners, const Vec3f& at) {
    corners.push_back({at, static_cast<std::uint32_t>(corners.size())});
}

// A text consists of solids, and these of facets:
//
//   solid name
//     facet normal 0 0 1
//       outer loop
//         vertex 0 0 0
//         vertex 1 0 0
//         vertex 0 1 0
//       endloop
//     endfacet
//   endsolid name
class StlText {
public:
    StlText(const std::filesystem::path& name, MeshFile& file) : name_(name), file_(file) {}

    std::vector<Corner> read(std::string_view text) {
        while (!text.empty()) {
            ++number_;
            take(next_line(text));
        }
        if (place_ != Place::outside) fail("the file ends before endsolid");
        return std::move(corners_);
    }

private:
    enum class Place { outside, solid, facet };

    void take(std::string_view line) {
        const std::string keyword = lower_case(next_word(line));
        if (keyword.empty()) return;
        if (keyword == "vertex") {
            need(Place::facet, keyword);
            vertex(line);
        } else if (keyword == "outer" || keyword == "endloop") {
            need(Place::facet, keyword);
        } else if (keyword == "facet") {
            move(Place::solid, Place::facet, keyword);
            if (corners_.size() >= 3 * max_mesh_elements) fail(fmt::format("over {} triangles", max_mesh_elements));
        } else if (keyword == "endfacet") {
            move(Place::facet, Place::solid, keyword);
            if (vertices_ != 3) fail(fmt::format("the facet has {} vertices; it needs 3", vertices_));
            vertices_ = 0;
        } else if (keyword == "solid") {
            move(Place::outside, Place::solid, keyword);
        } else if (keyword == "endsolid") {
            move(Place::solid, Place::outside, keyword);
        } else if (is_word(keyword)) {
            pass_over(file_, fmt::format("lines of the unknown keyword \"{}\"", keyword));
        } else {
            fail(
                fmt::format("\"{}\" is not a keyword: the file is damaged, or not an STL file", keyword.substr(0, 40)));
        }
    }

    void vertex(std::string_view line) {
        if (++vertices_ > 3) fail("the facet has more than 3 vertices");
        std::array<double, 3> at{};
        std::size_t count = 0;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
            const std::optional<double> value = coordinate(word);
            if (!value) fail(fmt::format("\"{}\" is not a finite number below {}", word.substr(0, 40), max_coordinate));
            if (count < at.size()) at[count] = *value;
        }
        if (count != at.size()) fail(fmt::format("the vertex has {} numbers; it needs 3", count));
        add(corners_, Vec3f(Vec3d(at[0], at[1], at[2])));
    }

    void need(Place place, const std::string& keyword) const {
        constexpr std::array places{"outside of a solid", "in a solid", "in a facet"};
        if (place_ != place)
            fail(fmt::format("{} stands {}; its place is {}", keyword, places[static_cast<std::size_t>(place_)],
                             places[static_cast<std::size_t>(place)]));
    }

    void move(Place from, Place to, const std::string& keyword) {
        need(from, keyword);
        place_ = to;
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw base::Error(base::ErrorCode::bad_input, fmt::format("{}:{}", name_.string(), number_), message);
    }

    const std::filesystem::path& name_;
    MeshFile& file_;
    std::vector<Corner> corners_;
    std::size_t number_ = 0;  // of the line
    Place place_ = Place::outside;
    int vertices_ = 0;  // of the facet
};

constexpr std::uint64_t header_bytes = 84;    // with the number of triangles
constexpr std::uint64_t triangle_bytes = 50;  // normal, three corners and two bytes of attributes
constexpr std::uint64_t normal_bytes = 12, corner_bytes = 12;

std::uint32_t read_count(FileReader& reader) {
    if (reader.size() < header_bytes)
        reader.fail(reader.size(), fmt::format("not an STL file: it does not begin with solid, as text does, and is "
                                               "shorter than the {} bytes of a binary header",
                                               header_bytes));
    constexpr std::uint64_t at = header_bytes - sizeof(std::uint32_t);
    reader.seek(at, "number of triangles");
    const auto count = reader.value<std::uint32_t>("number of triangles");
    const std::uint64_t left = reader.size() - header_bytes;
    if (count > left / triangle_bytes)
        reader.fail(
            at, fmt::format("{} triangles of {} bytes, but {} bytes follow: the file is cut, or not an STL file", count,
                            triangle_bytes, left));
    if (count > max_mesh_elements)
        reader.fail(at, fmt::format("{} triangles; the limit is {}", count, max_mesh_elements));
    return count;
}

std::vector<Corner> read_binary(FileReader& reader, MeshFile& file) {
    const std::uint32_t count = read_count(reader);
    const std::uint64_t rest = reader.size() - header_bytes - count * triangle_bytes;
    if (rest > 0) pass_over(file, "bytes after the last triangle", rest);
    std::vector<Corner> corners;
    corners.reserve(std::size_t{3} * count);
    constexpr std::uint32_t most_at_once = 1 << 16;
    for (std::uint32_t first = 0; first < count; first += most_at_once) {
        const std::uint64_t begin = reader.position();
        const std::uint32_t triangles = std::min(most_at_once, count - first);
        const std::vector<char> bytes = reader.array<char>(triangles * triangle_bytes, "triangles");
        for (std::uint64_t corner = 0; corner < std::uint64_t{3} * triangles; ++corner) {
            const std::uint64_t at = corner / 3 * triangle_bytes + normal_bytes + corner % 3 * corner_bytes;
            std::array<float, 3> point{};
            std::memcpy(point.data(), bytes.data() + at, corner_bytes);
            for (std::size_t axis = 0; axis < point.size(); ++axis)
                if (!(std::abs(point[axis]) <= static_cast<float>(max_coordinate)))
                    reader.fail(begin + at + axis * sizeof(float),
                                fmt::format("triangle {}: {} is not a finite number below {}", first + corner / 3,
                                            point[axis], max_coordinate));
            add(corners, Vec3f(point[0], point[1], point[2]));
        }
    }
    return corners;
}

// The headers of some binary files begin with "solid" too, but those have bytes of 0, which a text has not.
bool is_text(FileReader& reader) {
    constexpr std::uint64_t most = 1024;
    const std::vector<char> bytes = reader.array<char>(std::min(reader.size(), most), "header");
    std::string_view begin(bytes.data(), bytes.size());
    constexpr std::string_view mark = "\xef\xbb\xbf", word = "solid";
    if (begin.find('\0') != std::string_view::npos) return false;
    if (begin.starts_with(mark)) begin.remove_prefix(mark.size());
    begin.remove_prefix(std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
    return lower_case(begin.substr(0, word.size())) == word;
}

// Sorted, not hashed: no file makes it slow.
void merge_equal_corners(std::vector<Corner> corners, MeshFile& file) {
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return std::tie(a.at.x, a.at.y, a.at.z, a.number) < std::tie(b.at.x, b.at.y, b.at.z, b.number);
    });
    Mesh& mesh = file.mesh;
    mesh.triangles.resize(corners.size() / 3);
    for (const Corner& corner : corners) {
        if (mesh.positions.empty() || mesh.positions.back() != corner.at) mesh.positions.push_back(corner.at);
        const auto vertex = static_cast<int>(mesh.positions.size() - 1);
        mesh.triangles[corner.number / 3][static_cast<int>(corner.number % 3)] = vertex;
    }
    const auto removed = std::erase_if(
        mesh.triangles, [](const Vec3i& each) { return each.x == each.y || each.y == each.z || each.z == each.x; });
    if (removed > 0) pass_over(file, without_area, removed);
}

}  // namespace

MeshFile read_stl(const std::filesystem::path& name) {
    FileReader reader(name);
    MeshFile file;
    std::vector<Corner> corners =
        is_text(reader) ? StlText(name, file).read(base::read_text(name)) : read_binary(reader, file);
    merge_equal_corners(std::move(corners), file);
    if (file.mesh.positions.size() > max_mesh_elements)
        reader.fail(0, fmt::format("over {} vertices", max_mesh_elements));
    return file;
}

}  // namespace shadowbench::scene

// Point clouds: the vertices of a PLY file without faces. Tools call the radius of a point "radius", "pscale" (Houdini)
// or "width", which is twice as much.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/kinds.h"
#include "scene/readers/ply_source.h"
#include "scene/readers/point_files.h"
#include "scene/readers/read_mesh.h"
#include "scene/readers/text_lines.h"

namespace shadowbench::scene {
namespace {

// The columns of a vertex that are read.
struct Columns {
    std::array<std::optional<std::size_t>, 3> position;
    std::optional<std::size_t> radius, density;
    double radius_unit = 1.0;
};

Columns find_columns(const PlyElement& element) {
    const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < element.properties.size(); ++i)
            if (element.properties[i].name == name && !element.properties[i].is_list) return i;
        return std::nullopt;
    };
    Columns columns{{find("x"), find("y"), find("z")}, find("radius"), find("density")};
    if (!columns.radius) columns.radius = find("pscale");
    if (columns.radius) return columns;
    columns.radius = find("width");
    columns.radius_unit = 0.5;
    return columns;
}

void read_row(PlySource& source, const PlyElement& element, std::vector<double>& row) {
    for (std::size_t p = 0; p < element.properties.size(); ++p)
        if (element.properties[p].is_list)
            source.skip(element.properties[p]);
        else
            row[p] = source.value(element.properties[p].type);
}

void read_points_of(PlySource& source, const PlyElement& element, float radius, PointFile& file) {
    const Columns columns = find_columns(element);
    for (const auto& axis : columns.position)
        if (!axis) source.fail("points need the numbers x, y and z");
    file.has_radii = columns.radius.has_value();
    std::vector<double> row(element.properties.size());
    const auto number = [&](std::uint64_t point, std::size_t at, double least) {
        if (!(row[at] >= least && row[at] <= max_coordinate))
            source.fail(fmt::format("point {}: {} is {}, not a finite number from {} to {}", point,
                                    element.properties[at].name, row[at], least, max_coordinate));
        return row[at];
    };
    Particles& points = file.points;
    points.centres.reserve(static_cast<std::size_t>(element.count));
    points.radii.reserve(static_cast<std::size_t>(element.count));
    points.density.reserve(static_cast<std::size_t>(element.count));
    std::uint64_t without_radius = 0;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        read_row(source, element, row);
        Vec3d at;
        for (int axis = 0; axis < 3; ++axis)
            at[axis] = number(i, *columns.position[static_cast<std::size_t>(axis)], -max_coordinate);
        double own = radius;
        if (radius == 0.0f && columns.radius) own = columns.radius_unit * number(i, *columns.radius, 0.0);
        if (columns.radius && static_cast<float>(own) == 0.0f) {
            ++without_radius;
            continue;
        }
        points.centres.emplace_back(at);
        points.radii.push_back(static_cast<float>(own));
        points.density.push_back(columns.density ? static_cast<float>(number(i, *columns.density, 0.0)) : 1.0f);
    }
    if (without_radius > 0) file.passed_over.push_back({"points of radius 0", without_radius});
}

}  // namespace

// Only the header is looked at, which a reader has yet to check.
bool is_point_cloud(const std::filesystem::path& file) {
    std::string head(1 << 16, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(stream.gcount()));
    bool points = false;
    for (std::string_view left = head; !left.empty();) {
        std::string_view line = next_line(left);
        const std::string_view keyword = next_word(line);
        if (keyword == "end_header") return points;
        if (keyword != "element") continue;
        const std::string_view name = next_word(line), count = next_word(line);
        if (count.find_first_not_of('0') == std::string_view::npos) continue;
        if (name == "face" || name == "tristrips") return false;
        if (name == "vertex") points = true;
    }
    return false;
}

PointFile read_points(const std::filesystem::path& name, float radius) {
    PlySource source(name);
    PointFile file;
    bool found = false;
    for (const PlyElement& element : source.elements()) {
        source.check_length(element);
        if (element.name == "vertex") {
            if (found) source.fail("a second element \"vertex\"; one is read");
            found = true;
            read_points_of(source, element, radius, file);
            continue;
        }
        if (element.count > 0 && !element.properties.empty())
            file.passed_over.push_back(
                {is_word(element.name) ? fmt::format("elements \"{}\"", element.name) : "elements of another name",
                 element.count});
        if (file.passed_over.size() > 16) source.fail("over 16 kinds of elements; points are of one kind");
        if (element.properties.empty()) continue;
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties) source.skip(property);
    }
    if (!found) source.fail("there are no vertices");
    source.finish();
    return file;
}

}  // namespace shadowbench::scene

#include "scene/describe_file.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/printable.h"
#include "base/table.h"

namespace shadowbench::scene {
namespace {

// The least, mean and largest of some values.
struct Spread {
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0.0;
    std::size_t count = 0;

    void add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
        sum += value;
        ++count;
    }
    std::string text() const {
        if (count == 0) return "none";
        if (least == most) return fmt::format("{:.6g}", least);
        return fmt::format("{:.6g} to {:.6g}, mean {:.4g}", least, most, sum / static_cast<double>(count));
    }
};

Spread spread_of(const std::vector<float>& values) {
    Spread spread;
    for (const float value : values) spread.add(value);
    return spread;
}

std::string counted(std::uint64_t count, const char* one, const char* several) {
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string point_text(const Vec3d& point) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", point.x, point.y, point.z);
}

std::string describe_texture(const AlphaTexture& texture) {
    return fmt::format("  {} x {} pixels, alpha {}\n", texture.width, texture.height, spread_of(texture.alpha).text());
}

std::string describe_shape(const Mesh& mesh) {
    if (mesh.triangles.empty() && !mesh.positions.empty())
        return fmt::format("  a point cloud: {} and no faces\n", counted(mesh.positions.size(), "point", "points"));
    const std::string counts = fmt::format("  {}, {}{}\n", counted(mesh.positions.size(), "vertex", "vertices"),
                                           counted(mesh.triangles.size(), "triangle", "triangles"),
                                           mesh.corner_uv.empty() || mesh.alpha ? "" : ", with texture coordinates");
    return mesh.alpha ? counts + "  the materials as one alpha texture:" + describe_texture(*mesh.alpha).substr(1)
                      : counts;
}

std::string describe_shape(const Hair& hair) {
    Spread points;
    for (std::size_t strand = 0; strand + 1 < hair.strand_begin.size(); ++strand)
        points.add(hair.strand_begin[strand + 1] - hair.strand_begin[strand]);
    return fmt::format("  {}, {}; {} a strand\n", counted(points.count, "strand", "strands"),
                       counted(hair.points.size(), "point", "points"), points.text());
}

std::string describe_shape(const GridVolume& volume) {
    const auto dense = static_cast<std::uint64_t>(
        std::count_if(volume.density.begin(), volume.density.end(), [](float density) { return density > 0.0f; }));
    const Vec3d extent = volume.upper - volume.lower;
    const Vec3d edges(extent.x / volume.size.x, extent.y / volume.size.y, extent.z / volume.size.z);
    return fmt::format("  {} x {} x {} voxels, {} in all, {} above 0; edges {}\n  density {}\n", volume.size.x,
                       volume.size.y, volume.size.z, volume.density.size(), dense, point_text(edges),
                       spread_of(volume.density).text());
}

std::string describe_shape(const Particles& points) {
    return fmt::format("  {}, density {}\n", counted(points.centres.size(), "point", "points"),
                       spread_of(points.density).text());
}

// No file gives these.
std::string describe_shape(const Spheres&) {
    return "";
}

std::string describe_deep(const DeepImage& image) {
    Spread samples, front, alpha;
    std::size_t empty = 0, surfaces = 0, behind = 0;
    for (std::size_t pixel = 0; pixel + 1 < image.begin.size(); ++pixel) {
        const std::uint64_t here = image.begin[pixel + 1] - image.begin[pixel];
        samples.add(static_cast<double>(here));
        empty += here == 0;
    }
    for (std::size_t sample = 0; sample < image.z_front.size(); ++sample) {
        if (behind_everything(image, sample)) {
            ++behind;
            continue;
        }
        front.add(image.z_front[sample]);
        surfaces += image.z_back[sample] == image.z_front[sample];
    }
    for (const float transmittance : image.transmittance) alpha.add(1.0 - transmittance);
    const std::string sizes =
        fmt::format("  {} x {} pixels, {} without samples; {}, {} a pixel; {}\n", image.width, image.height, empty,
                    counted(image.z_front.size(), "sample", "samples"), samples.text(),
                    counted(static_cast<std::uint64_t>(image.channels), "channel of alpha", "channels of alpha"));
    const std::string depths =
        fmt::format("  Z {}; {}, {}, {} behind everything\n", front.text(), counted(surfaces, "surface", "surfaces"),
                    counted(front.count - surfaces, "slab", "slabs"), behind);
    return sizes + depths + fmt::format("  alpha {}\n", alpha.text());
}

// Images lie nowhere before a scenario places them.
std::string describe_box(const DataFile& data) {
    const Box3d box = bounds(data);
    if (box.isEmpty() || data.format->loader == "quad") return "";
    return fmt::format("  bounds {} to {}, size {}\n", point_text(box.min), point_text(box.max),
                       point_text(box.max - box.min));
}

std::string describe_width(const DataFile& data, const Object& object) {
    const auto* hair = std::get_if<Hair>(&object.shape);
    const auto* points = std::get_if<Particles>(&object.shape);
    if (!hair && !points) return "";
    const std::vector<float>& radii = hair ? hair->radii : points->radii;
    const char* const name = hair ? "half-width" : "radius";
    if (!data.guessed_radius) return fmt::format("  {} {}\n", name, spread_of(radii).text());
    return fmt::format("  the file has no {}; a {} of {} is a guess, by its size\n",
                       hair ? "width of hair" : "radius of points", name, radii.empty() ? 0.0f : radii[0]);
}

std::string describe_object(const DataFile& data, const Object& object) {
    const std::string shape = std::visit([](const auto& each) { return describe_shape(each); }, object.shape);
    const std::string name = object.name.empty() ? "" : fmt::format("  medium \"{}\":\n", object.name);
    return name + shape + describe_width(data, object);
}

// What the file says, or does not say, besides its values.
std::string describe_source(const DataFile& data) {
    std::string text;
    if (data.vdb)
        text += fmt::format("  grid \"{}\", {}{}\n", data.vdb->grid,
                            counted(data.vdb->active, "active voxel", "active voxels"),
                            data.vdb->axes.empty() ? "" : "; its axes run along " + data.vdb->axes);
    if (data.no_box) text += "  the file has no box: its voxels are taken to have edges of 1\n";
    for (const std::string& fact : data.facts) text += fmt::format("  {}\n", fact);
    return text;
}

std::string describe_notes(const DataFile& data) {
    std::string text;
    // Each line begins with its place in a scenario.
    for (const std::string& line : read_notes(data.scene))
        text += fmt::format("  note: {}\n", line.substr(line.find(": ") + 2));
    if (data.short_strands > 0)
        text += fmt::format("  note: left out: {}\n",
                            counted(data.short_strands, "strand without length", "strands without length"));
    return text;
}

}  // namespace

std::string describe_file(const DataFile& data) {
    std::string text =
        fmt::format("{}: {}, {}\n", data.file.string(), data.format->title, base::bytes_text(data.bytes));
    if (data.scene.deep_image)
        text += describe_deep(*data.scene.deep_image);
    else if (data.format->loader == "quad")
        text += describe_texture(*std::get<Mesh>(data.scene.objects[0].shape).alpha);
    else
        for (const Object& object : data.scene.objects) text += describe_object(data, object);
    text += describe_box(data) + describe_source(data) + describe_notes(data);
    std::string shown;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = text.find('\n', begin);
        shown += base::printable(std::string_view(text).substr(begin, end - begin)) + "\n";
        begin = end + 1;
    }
    return shown;
}

}  // namespace shadowbench::scene

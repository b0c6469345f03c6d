#include "scene/file_lines.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/printable.h"

namespace shadowbench::scene {
namespace {

std::string range_text(const std::vector<float>& values) {
    if (values.empty()) return "none";
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return *least == *most ? fmt::format("{:.6g}", *least) : fmt::format("{:.6g} to {:.6g}", *least, *most);
}

std::string brief(const Mesh& mesh) {
    return fmt::format("{} vertices, {} triangles", mesh.positions.size(), mesh.triangles.size());
}
std::string brief(const Hair& hair) {
    return fmt::format("{} strands, {} points, half-width {}",
                       hair.strand_begin.empty() ? 0 : hair.strand_begin.size() - 1, hair.points.size(),
                       range_text(hair.radii));
}
std::string brief(const GridVolume& volume) {
    return fmt::format("{} x {} x {} voxels, density {}", volume.size.x, volume.size.y, volume.size.z,
                       range_text(volume.density));
}
std::string brief(const Spheres& spheres) {
    return fmt::format("{} spheres, radius {}", spheres.centres.size(), range_text(spheres.radii));
}
std::string brief(const Particles& particles) {
    return fmt::format("{} particles, radius {}", particles.centres.size(), range_text(particles.radii));
}
std::string brief(const AlphaTexture& texture) {
    return fmt::format("{} x {} pixels, alpha {}", texture.width, texture.height, range_text(texture.alpha));
}
std::string brief(const DeepImage& image) {
    return fmt::format("{} x {} pixels, {} samples, Z {}", image.width, image.height, image.z_front.size(),
                       range_text(image.z_front));
}

std::string corner_text(const Vec3d& point) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", point.x, point.y, point.z);
}

// Of the file that a key names; 0 if there is none.
std::uint64_t bytes_of_file(const nlohmann::json& from, const char* key, const SearchPath& path) {
    const auto name = from.find(key);
    if (name == from.end() || !name->is_string()) return 0;
    try {
        std::error_code gone;
        const std::uintmax_t bytes = std::filesystem::file_size(find_file(path, name->get<std::string>(), ""), gone);
        return gone ? 0 : bytes;
    } catch (const base::Error&) {
        return 0;
    }
}

std::string box_text(const Object& object) {
    const Box3d box = bounds(object);
    return box.isEmpty() ? "" : fmt::format("; box {} to {}", corner_text(box.min), corner_text(box.max));
}

}  // namespace

std::vector<std::string> file_lines(const nlohmann::json& document, const Scene& scene) {
    std::vector<std::string> lines;
    const auto add = [&](const nlohmann::json& from, const char* key, const std::string& where,
                         const std::string& text) {
        if (from.contains(key) && from[key].is_string())
            lines.push_back(
                base::printable(fmt::format("{}/{}: {}: {}", where, key, from[key].get<std::string>(), text)));
    };
    const nlohmann::json& from = document.at("scene");
    if (scene.deep_image) add(from.at("deep_image"), "file", "/scene/deep_image", brief(*scene.deep_image));
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const nlohmann::json& object_from = from.at("objects").at(i);
        const std::string where = fmt::format("/scene/objects/{}", i);
        if (object_from.contains("file"))
            add(object_from, "file", where,
                std::visit([](const auto& shape) { return brief(shape); }, object.shape) + box_text(object));
        const auto* mesh = std::get_if<Mesh>(&object.shape);
        if (mesh && mesh->alpha) add(object_from, "alpha_texture", where, brief(*mesh->alpha));
    }
    return lines;
}

std::uint64_t file_bytes(const nlohmann::json& document, const SearchPath& path) {
    const nlohmann::json& from = document.at("scene");
    if (from.contains("deep_image")) return bytes_of_file(from["deep_image"], "file", path);
    std::uint64_t bytes = 0;
    for (const nlohmann::json& object : from.at("objects"))
        bytes += bytes_of_file(object, "file", path) + bytes_of_file(object, "alpha_texture", path);
    return bytes;
}

}  // namespace shadowbench::scene

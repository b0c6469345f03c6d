#include "scene/readers/read_mesh.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/polygon/triangulate.h"
#include "scene/readers/extension.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

struct MeshFormat {
    std::string_view extension;
    MeshFile (*read)(const std::filesystem::path& file);
};
constexpr std::array mesh_formats{MeshFormat{".obj", read_obj},  MeshFormat{".ply", read_ply},
                                  MeshFormat{".stl", read_stl},  MeshFormat{".gltf", read_gltf},
                                  MeshFormat{".glb", read_gltf}, MeshFormat{".pbrt", read_pbrt_mesh}};

}  // namespace

MeshFile read_mesh(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    std::vector<std::string_view> known;
    for (const MeshFormat& format : mesh_formats) {
        if (extension == format.extension) return format.read(file);
        known.push_back(format.extension);
    }
    throw base::Error(base::ErrorCode::bad_input, file.string(), unknown_extension(file, "mesh", known));
}

void pass_over(MeshFile& file, std::string_view what, std::uint64_t count) {
    const auto known = std::find_if(file.passed_over.begin(), file.passed_over.end(),
                                    [&](const PassedOver& each) { return each.what == what; });
    constexpr std::size_t most_kinds = 16;
    constexpr std::string_view others = "other things";
    if (known == file.passed_over.end() && file.passed_over.size() + 1 >= most_kinds && what != others)
        pass_over(file, others, count);
    else if (known == file.passed_over.end())
        file.passed_over.push_back({std::string(what), count});
    else
        known->count += count;
}

bool is_word(std::string_view text) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
    return !text.empty() && text.size() <= 32 && letter(text.front()) && std::all_of(text.begin(), text.end(), inner);
}

std::string add_polygon(MeshFile& file, const std::vector<int>& corners, const std::vector<Vec2f>& uv) {
    if (corners.size() < 3) {
        pass_over(file, fewer_corners);
        return {};
    }
    Mesh& mesh = file.mesh;
    if (corners.size() == 3) {
        mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
        mesh.corner_uv.insert(mesh.corner_uv.end(), uv.begin(), uv.end());
        return {};
    }
    Polygon polygon{{}, uv};
    for (const int corner : corners) polygon.positions.push_back(mesh.positions[static_cast<std::size_t>(corner)]);
    const Triangulation result = triangulate(polygon);
    if (!result.fault.empty())
        return fmt::format("the face {}; split it in the program that wrote the file", result.fault);
    if (result.triangles.empty()) pass_over(file, without_area);
    for (const auto& [a, b, c] : result.triangles) {
        mesh.triangles.emplace_back(corners[a], corners[b], corners[c]);
        if (!uv.empty())
            for (const std::uint32_t corner : {a, b, c}) mesh.corner_uv.push_back(uv[corner]);
    }
    return {};
}

}  // namespace shadowbench::scene

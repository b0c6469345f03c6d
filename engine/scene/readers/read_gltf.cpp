// glTF 2.0 (ISO/IEC 12113:2022), text and binary: the meshes of the scene that the file shows, where its nodes put
// them, as one mesh. Cameras, lights, normals and colours do not matter to shadows. Animations, morph targets, skins
// and instances are passed over and counted: a mesh with a skin stays as it was modelled, at its node.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/gltf_accessor.h"
#include "scene/readers/gltf_alpha.h"
#include "scene/readers/gltf_model.h"
#include "scene/readers/read_mesh.h"

namespace shadowbench::scene {
namespace {

// A small file can name the same arrays many times.
constexpr std::uint64_t most_values = 4 * max_mesh_elements;

struct Place {
    std::size_t node = 0;
    GltfTransform transform;
};

// What reading a mesh once takes; every accessor counts once.
struct Cost {
    std::uint64_t vertices = 0, triangles = 0, values = 0;
};

std::uint64_t triangles_of(GltfMode mode, std::uint64_t corners) {
    if (mode == GltfMode::triangles) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

bool in_range(double coordinate) {
    return std::abs(coordinate) <= max_coordinate;
}

class GltfReader {
public:
    explicit GltfReader(const GltfModel& model) : model_(model), places_(model.meshes.size()) {}

    MeshFile read() {
        place_meshes();
        check_costs();
        for (std::size_t mesh = 0; mesh < places_.size(); ++mesh)
            if (!places_[mesh].empty()) add_mesh(mesh);
        pass_over_some("animations", model_.animations);
        pass_over_some("other scenes", model_.other_scenes);
        pass_over_some("materials that transmit light", model_.transmitting_materials);
        if (keeps_uv_) add_gltf_alpha(model_, materials_, file_);
        // Corners of opaque materials got none, since a texture was expected.
        if (alpha_ && !file_.mesh.alpha) file_.mesh.corner_uv.clear();
        return std::move(file_);
    }

private:
    void pass_over_some(const char* what, std::uint64_t count) {
        if (count > 0) pass_over(file_, what, count);
    }

    // Without recursion: no file makes it too deep.
    void place_meshes() {
        std::vector<Place> waiting;
        for (const std::size_t root : model_.roots) waiting.push_back({root, {}});
        std::reverse(waiting.begin(), waiting.end());
        std::vector<bool> reached(model_.nodes.size());
        while (!waiting.empty()) {
            const Place parent = waiting.back();
            waiting.pop_back();
            const GltfNode& node = model_.nodes[parent.node];
            if (reached[parent.node])
                fail(model_, fmt::format("/nodes/{}", parent.node),
                     "it is reached twice; the nodes of a scene must be a tree");
            reached[parent.node] = true;
            const GltfTransform transform = combined(parent.transform, node.local);
            if (node.mesh) places_[*node.mesh].push_back({parent.node, transform});
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                waiting.push_back({*child, transform});
            pass_over_some("skins", node.skinned);
            pass_over_some("nodes with instances (EXT_mesh_gpu_instancing)", node.instanced);
        }
    }

    bool is_opaque(const GltfPrimitive& primitive) const {
        return !primitive.material || model_.materials[*primitive.material].mode == GltfAlphaMode::opaque;
    }

    static bool has_triangles(const GltfPrimitive& primitive) {
        return primitive.mode >= GltfMode::triangles && primitive.positions;
    }

    std::uint64_t corners_of(const GltfPrimitive& primitive) const {
        return model_.accessors[primitive.indices ? *primitive.indices : *primitive.positions].count;
    }

    // Refuses what is too large before anything is read.
    void check_costs() {
        Cost all;
        for (std::size_t mesh = 0; mesh < places_.size(); ++mesh) {
            if (places_[mesh].empty()) continue;
            const Cost cost = cost_of(mesh);
            const auto times = static_cast<std::uint64_t>(places_[mesh].size());
            // Compared by division, since the products could overflow.
            if (std::max(cost.vertices, cost.triangles) > max_mesh_elements / times) too_large();
            all.vertices += times * cost.vertices;
            all.triangles += times * cost.triangles;
            all.values += cost.values;
            if (std::max({all.vertices, all.triangles, all.values / 4}) > max_mesh_elements) too_large();
        }
        file_.mesh.positions.reserve(all.vertices);
        file_.mesh.triangles.reserve(all.triangles);
        keeps_uv_ = alpha_ || all_uv_;
        if (keeps_uv_) file_.mesh.corner_uv.reserve(3 * all.triangles);
        if (keeps_uv_) materials_.reserve(all.triangles);
    }

    [[noreturn]] void too_large() const {
        fail(model_, "/meshes",
             fmt::format("over {} vertices or triangles, as often as the nodes repeat them, or over {} values to read",
                         max_mesh_elements, most_values));
    }

    Cost cost_of(std::size_t mesh) {
        Cost cost;
        std::set<std::size_t> counted;
        const auto add = [&](std::size_t accessor) {
            if (!counted.insert(accessor).second) return std::uint64_t{0};
            check_gltf_accessor(model_, accessor);
            cost.values += model_.accessors[accessor].count;
            return model_.accessors[accessor].count;
        };
        for (const GltfPrimitive& primitive : model_.meshes[mesh]) {
            ++cost.values;
            if (!has_triangles(primitive)) continue;
            if (!primitive.compression.empty() && !model_.accessors[*primitive.positions].view)
                fail(model_, fmt::format("/meshes/{}", mesh),
                     fmt::format("it is compressed by {}, which is not read: write the file without",
                                 primitive.compression));
            cost.vertices += add(*primitive.positions);
            for (const auto& [set, accessor] : primitive.uvs) add(accessor);
            if (primitive.indices) check_gltf_accessor(model_, *primitive.indices);
            cost.triangles += triangles_of(primitive.mode, corners_of(primitive));
            cost.values += corners_of(primitive);
            if (!is_opaque(primitive)) alpha_ = true;
            if (!primitive.uvs.contains(0)) all_uv_ = false;
            if (std::max(cost.vertices, cost.values / 4) > max_mesh_elements) too_large();
        }
        return cost;
    }

    // Reads a mesh into the place of the first node that shows it, and copies it from there for the others, since a
    // file's largest mesh may be all of it.
    void add_mesh(std::size_t number) {
        Mesh& mesh = file_.mesh;
        const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size(),
                          uvs = mesh.corner_uv.size(), materials = materials_.size();
        read_mesh_of(number);
        const std::size_t vertices_end = mesh.positions.size(), triangles_end = mesh.triangles.size(),
                          uvs_end = mesh.corner_uv.size(), materials_end = materials_.size();
        const std::vector<Place>& places = places_[number];
        for (std::size_t i = 1; i < places.size(); ++i) {
            const auto offset = static_cast<int>(mesh.positions.size() - vertices);
            for (std::size_t v = vertices; v < vertices_end; ++v)
                mesh.positions.push_back(moved(mesh.positions[v], places[i]));
            for (std::size_t t = triangles; t < triangles_end; ++t)
                mesh.triangles.push_back(mesh.triangles[t] + Vec3i(offset, offset, offset));
            for (std::size_t c = uvs; c < uvs_end; ++c) mesh.corner_uv.push_back(mesh.corner_uv[c]);
            for (std::size_t t = materials; t < materials_end; ++t) materials_.push_back(materials_[t]);
        }
        for (std::size_t v = vertices; v < vertices_end; ++v) mesh.positions[v] = moved(mesh.positions[v], places[0]);
    }

    Vec3f moved(const Vec3f& position, const Place& place) const {
        const Vec3d at = apply(place.transform, Vec3d(position));
        if (!in_range(at.x) || !in_range(at.y) || !in_range(at.z))
            fail(model_, fmt::format("/nodes/{}", place.node),
                 fmt::format("it moves a vertex beyond {}", max_coordinate));
        return Vec3f(at);
    }

    // Appends it in its own space.
    void read_mesh_of(std::size_t number) {
        std::map<std::size_t, std::size_t> first_of;       // vertex, by the accessor of the positions
        std::map<std::size_t, std::vector<Vec2f>> uvs_of;  // by their accessor
        for (std::size_t i = 0; i < model_.meshes[number].size(); ++i) {
            const GltfPrimitive& primitive = model_.meshes[number][i];
            const std::string at = fmt::format("/meshes/{}/primitives/{}", number, i);
            pass_over_some("morph targets", primitive.morphs);
            if (primitive.mode < GltfMode::triangles) {
                pass_over(file_, primitive.mode == GltfMode::points ? "primitives of points" : "primitives of lines");
                continue;
            }
            if (!primitive.positions) {
                pass_over(file_, "primitives without positions");
                continue;
            }
            const auto [first, added] = first_of.try_emplace(*primitive.positions, file_.mesh.positions.size());
            if (added) add_gltf_points(model_, *primitive.positions, file_.mesh.positions);
            const std::vector<Vec2f>* uvs = nullptr;
            if (keeps_uv_) uvs = uvs_for(primitive, at, uvs_of);
            add_primitive(primitive, at, first->second, uvs);
        }
    }

    // Null if the primitive has none that matter.
    const std::vector<Vec2f>* uvs_for(const GltfPrimitive& primitive, const std::string& at,
                                      std::map<std::size_t, std::vector<Vec2f>>& uvs_of) {
        const bool opaque = is_opaque(primitive);
        const bool textured = !opaque && model_.materials[*primitive.material].texture;
        if (alpha_ && !textured) return nullptr;
        const std::uint64_t set = opaque ? 0 : model_.materials[*primitive.material].uv_set;
        const auto named = primitive.uvs.find(set);
        if (named == primitive.uvs.end()) {
            pass_over(file_, "alpha textures without texture coordinates");
            return nullptr;
        }
        const auto [known, added] = uvs_of.try_emplace(named->second);
        if (added) known->second = read_gltf_uvs(model_, named->second);
        if (known->second.size() != model_.accessors[*primitive.positions].count)
            fail(model_, at,
                 fmt::format("{} texture coordinates for {} positions", known->second.size(),
                             model_.accessors[*primitive.positions].count));
        return &known->second;
    }

    void add_primitive(const GltfPrimitive& primitive, const std::string& at, std::size_t first,
                       const std::vector<Vec2f>* uvs) {
        if (!is_opaque(primitive) && primitive.colours && model_.accessors[*primitive.colours].components == 4)
            pass_over(file_, "alphas of vertices (COLOR_0)");
        const std::uint64_t vertices = model_.accessors[*primitive.positions].count, corners = corners_of(primitive);
        std::optional<GltfIndices> indices;
        if (primitive.indices) indices.emplace(model_, *primitive.indices);
        const auto corner = [&](std::uint64_t number) {
            const std::uint64_t vertex = indices ? (*indices)[number] : number;
            if (vertex >= vertices)
                fail(model_, at, fmt::format("corner {} names vertex {}, but there are {}", number, vertex, vertices));
            return vertex;
        };
        const std::uint64_t count = triangles_of(primitive.mode, corners);
        if (count == 0) pass_over(file_, fewer_corners);
        if (primitive.mode == GltfMode::triangles && count > 0)
            pass_over_some("corners after the last triangle", corners % 3);
        const std::uint32_t material =
            primitive.material ? static_cast<std::uint32_t>(*primitive.material) : no_material;
        for (std::uint64_t i = 0; i < count; ++i) {
            std::uint64_t a = i, b = i + 1, c = i + 2;
            if (primitive.mode == GltfMode::triangles) {
                a = 3 * i;
                b = a + 1;
                c = a + 2;
            } else if (primitive.mode == GltfMode::fan) {
                a = 0;
            } else if (i % 2 == 1) {
                std::swap(a, b);
            }
            const std::uint64_t vertex_a = corner(a), vertex_b = corner(b), vertex_c = corner(c);
            if (vertex_a == vertex_b || vertex_b == vertex_c || vertex_c == vertex_a) {
                // A strip repeats vertices to continue elsewhere.
                if (primitive.mode != GltfMode::strip) pass_over(file_, without_area);
                continue;
            }
            file_.mesh.triangles.emplace_back(static_cast<int>(first + vertex_a), static_cast<int>(first + vertex_b),
                                              static_cast<int>(first + vertex_c));
            if (!keeps_uv_) continue;
            materials_.push_back(material);
            for (const std::uint64_t vertex : {vertex_a, vertex_b, vertex_c})
                file_.mesh.corner_uv.push_back(uvs ? (*uvs)[vertex] : Vec2f(0.0f, 0.0f));
        }
    }

    const GltfModel& model_;
    std::vector<std::vector<Place>> places_;  // of each mesh
    MeshFile file_;
    std::vector<std::uint32_t> materials_;  // one a triangle
    bool alpha_ = false;                    // whether any material is not opaque
    bool all_uv_ = true;                    // whether every triangle has texture coordinates
    bool keeps_uv_ = false;
};

}  // namespace

MeshFile read_gltf(const std::filesystem::path& name) {
    const GltfModel model = open_gltf(name);
    return GltfReader(model).read();
}

}  // namespace shadowbench::scene

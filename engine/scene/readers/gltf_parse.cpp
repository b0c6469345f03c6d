// The JSON document of a glTF 2.0 file (ISO/IEC 12113:2022) as plain values. Debian's library for it, tinygltf 2.7, was
// not taken: it replaces values of a wrong type by their defaults and drops primitives without a word, copies the bytes
// of a binary file for every buffer, and also looks for files in the working folder.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/readers/gltf_json.h"
#include "scene/readers/gltf_model.h"
#include "scene/readers/gltf_uri.h"
#include "scene/parse_json.h"

namespace shadowbench::scene {
namespace {

class GltfParser : private GltfJson {
public:
    GltfParser(const std::filesystem::path& file, const Json& root, std::optional<GltfBuffer> chunk)
        : GltfJson(file, root), chunk_(std::move(chunk)) {
        model_.file = file;
    }

    GltfModel parse() {
        check_version();
        check_extensions();
        each(root(), "", "buffers", [&](const Json& from, const std::string& at) {
            model_.buffers.push_back(parse_buffer(from, at, model_.buffers.empty()));
        });
        each(root(), "", "bufferViews", [&](const Json& from, const std::string& at) {
            model_.views.push_back({needed_index(from, at, "buffer", "buffers"), size(from, at, "byteOffset", 0),
                                    needed_size(from, at, "byteLength"), size(from, at, "byteStride", 0)});
        });
        each(root(), "", "accessors",
             [&](const Json& from, const std::string& at) { model_.accessors.push_back(parse_accessor(from, at)); });
        each(root(), "", "images", [&](const Json& from, const std::string& at) {
            model_.images.push_back({text(from, at, "uri", ""), index(from, at, "bufferView", "bufferViews")});
        });
        each(root(), "", "textures",
             [&](const Json& from, const std::string& at) { model_.textures.push_back(parse_texture(from, at)); });
        each(root(), "", "materials",
             [&](const Json& from, const std::string& at) { model_.materials.push_back(parse_material(from, at)); });
        each(root(), "", "meshes", [&](const Json& from, const std::string& at) {
            std::vector<GltfPrimitive>& mesh = model_.meshes.emplace_back();
            each(from, at, "primitives", [&](const Json& primitive, const std::string& where) {
                mesh.push_back(parse_primitive(primitive, where));
            });
        });
        each(root(), "", "nodes",
             [&](const Json& from, const std::string& at) { model_.nodes.push_back(parse_node(from, at)); });
        parse_scene();
        model_.animations = count("animations");
        return std::move(model_);
    }

private:
    void check_version() const {
        if (!root().is_object()) refuse_at("", "not a glTF file: it must be a JSON object");
        const Json* asset = find_object(root(), "", "asset");
        if (!asset) refuse_at("", "not a glTF file: \"asset\" is missing");
        const std::string version = text(*asset, "/asset", "version", "");
        if (!version.starts_with("2."))
            refuse_at("/asset/version",
                      fmt::format("version \"{}\"; 2.0 is read: write the file as glTF 2.0", version.substr(0, 20)));
    }

    // A file needs them to be read right.
    void check_extensions() const {
        constexpr std::array known{"KHR_lights_punctual", "KHR_mesh_quantization", "KHR_texture_transform",
                                   "KHR_xmp_json_ld"};
        const Json* required = find_array(root(), "", "extensionsRequired");
        for (std::size_t i = 0; required && i < required->size(); ++i) {
            const std::string at = fmt::format("/extensionsRequired/{}", i);
            if (!(*required)[i].is_string()) refuse_at(at, "must be a text");
            const std::string name = (*required)[i].get<std::string>();
            bool harmless = name.starts_with("KHR_materials_");
            for (const std::string_view each_known : known) harmless = harmless || name == each_known;
            if (!harmless)
                refuse_at(at, fmt::format("the file needs the extension {}, which is not read: write it without",
                                          name.substr(0, 60)));
        }
    }

    GltfBuffer parse_buffer(const Json& from, const std::string& at, bool first) const {
        GltfBuffer buffer;
        buffer.size = needed_size(from, at, "byteLength");
        const std::string uri = text(from, at, "uri", "");
        std::uint64_t there = 0;
        if (is_data_uri(uri)) {
            std::optional<std::vector<char>> bytes = data_of_uri(uri);
            if (!bytes) refuse_at(at + "/uri", "a data URI that is damaged, or not in base64");
            buffer.bytes = std::move(*bytes);
            there = buffer.bytes.size();
        } else if (!uri.empty()) {
            const std::string where = fmt::format("{}: {}/uri", model_.file.string(), at);
            buffer.file = file_of_uri(model_.file, uri, where);
            std::error_code fault;
            there = std::filesystem::file_size(buffer.file, fault);
            if (fault) throw base::Error(base::ErrorCode::io, where, "cannot be read: " + fault.message());
        } else if (first && chunk_) {
            buffer.file = chunk_->file;
            buffer.begin = chunk_->begin;
            there = chunk_->size;
        } else {
            // The bytes of such a buffer come from an extension. Views of it are refused where they are used.
            buffer.size = 0;
        }
        if (buffer.size > there)
            refuse_at(at + "/byteLength",
                      fmt::format("{} bytes, but there are {}: the file is damaged or cut", buffer.size, there));
        return buffer;
    }

    GltfComponent parse_component(const Json& from, const std::string& at) const {
        const std::uint64_t type = needed_size(from, at, "componentType");
        for (const GltfComponent known : {GltfComponent::int8, GltfComponent::uint8, GltfComponent::int16,
                                          GltfComponent::uint16, GltfComponent::uint32, GltfComponent::float32})
            if (type == static_cast<std::uint64_t>(known)) return known;
        refuse_at(at + "/componentType", fmt::format("{} is no type of glTF 2.0", type));
    }

    GltfAccessor parse_accessor(const Json& from, const std::string& at) const {
        GltfAccessor accessor;
        accessor.view = index(from, at, "bufferView", "bufferViews");
        accessor.offset = size(from, at, "byteOffset", 0);
        accessor.count = needed_size(from, at, "count");
        accessor.type = parse_component(from, at);
        accessor.normalized = flag(from, at, "normalized");
        const std::string type = text(from, at, "type", "");
        accessor.components = 0;
        for (const auto& [name, components] :
             {std::pair{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}})
            if (type == name) accessor.components = components;
        if (accessor.components == 0) refuse_at(at + "/type", "must be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
        if (const Json* sparse = find_object(from, at, "sparse"))
            accessor.sparse = parse_sparse(*sparse, at + "/sparse", accessor.count);
        return accessor;
    }

    GltfSparse parse_sparse(const Json& from, const std::string& at, std::uint64_t most) const {
        const Json* places = find_object(from, at, "indices");
        const Json* values = find_object(from, at, "values");
        if (!places || !values) refuse_at(at, "\"indices\" and \"values\" are needed");
        GltfSparse sparse;
        sparse.count = needed_size(from, at, "count");
        if (sparse.count > most) refuse_at(at + "/count", fmt::format("{} of {} elements", sparse.count, most));
        sparse.indices = needed_index(*places, at + "/indices", "bufferView", "bufferViews");
        sparse.indices_offset = size(*places, at + "/indices", "byteOffset", 0);
        sparse.indices_type = parse_component(*places, at + "/indices");
        sparse.values = needed_index(*values, at + "/values", "bufferView", "bufferViews");
        sparse.values_offset = size(*values, at + "/values", "byteOffset", 0);
        return sparse;
    }

    GltfWrap parse_wrap(const Json& from, const std::string& at, const char* key) const {
        const std::uint64_t wrap = size(from, at, key, 10497);
        switch (wrap) {
            case 10497:
                return GltfWrap::repeat;
            case 33071:
                return GltfWrap::clamp;
            case 33648:
                return GltfWrap::mirror;
            default:
                refuse_at(at + "/" + key, fmt::format("{} is no wrapping of glTF 2.0", wrap));
        }
    }

    GltfTexture parse_texture(const Json& from, const std::string& at) const {
        GltfTexture texture;
        texture.image = index(from, at, "source", "images");
        if (const std::optional<std::size_t> sampler = index(from, at, "sampler", "samplers")) {
            const Json& named = object_of("samplers", *sampler);
            const std::string where = fmt::format("/samplers/{}", *sampler);
            texture.u = parse_wrap(named, where, "wrapS");
            texture.v = parse_wrap(named, where, "wrapT");
        }
        return texture;
    }

    GltfMaterial parse_material(const Json& from, const std::string& at) {
        GltfMaterial material;
        const std::string mode = text(from, at, "alphaMode", "OPAQUE");
        if (mode == "MASK")
            material.mode = GltfAlphaMode::mask;
        else if (mode == "BLEND")
            material.mode = GltfAlphaMode::blend;
        else if (mode != "OPAQUE")
            refuse_at(at + "/alphaMode", "must be OPAQUE, MASK or BLEND");
        material.cutoff = number(from, at, "alphaCutoff", 0.5);
        if (find_extension(from, at, "KHR_materials_transmission")) ++model_.transmitting_materials;
        // Where a material has both, the extension counts.
        constexpr const char* gloss = "KHR_materials_pbrSpecularGlossiness";
        const Json* diffuse = find_extension(from, at, gloss);
        const Json* surface = diffuse ? diffuse : find_object(from, at, "pbrMetallicRoughness");
        if (!surface) return material;
        const std::string where = diffuse ? fmt::format("{}/extensions/{}", at, gloss) : at + "/pbrMetallicRoughness";
        const char* colour = diffuse ? "diffuseFactor" : "baseColorFactor";
        const char* image = diffuse ? "diffuseTexture" : "baseColorTexture";
        const std::vector<double> factor = numbers(*surface, where, colour, 4);
        if (!factor.empty()) material.factor = factor[3];
        if (const Json* named = find_object(*surface, where, image))
            parse_texture_place(*named, where + "/" + image, material);
        return material;
    }

    void parse_texture_place(const Json& from, const std::string& at, GltfMaterial& material) const {
        material.texture = needed_index(from, at, "index", "textures");
        material.uv_set = size(from, at, "texCoord", 0);
        const Json* change = find_extension(from, at, "KHR_texture_transform");
        if (!change) return;
        const std::string where = at + "/extensions/KHR_texture_transform";
        material.uv_set = size(*change, where, "texCoord", material.uv_set);
        const std::vector<double> scale = numbers(*change, where, "scale", 2),
                                  offset = numbers(*change, where, "offset", 2);
        if (!scale.empty()) material.uv_scale = {scale[0], scale[1]};
        if (!offset.empty()) material.uv_offset = {offset[0], offset[1]};
        material.uv_turned = number(*change, where, "rotation", 0.0) != 0.0;
    }

    GltfPrimitive parse_primitive(const Json& from, const std::string& at) const {
        GltfPrimitive primitive;
        const std::uint64_t mode = size(from, at, "mode", 4);
        if (mode > static_cast<std::uint64_t>(GltfMode::fan))
            refuse_at(at + "/mode", fmt::format("{} is no mode of glTF 2.0", mode));
        primitive.mode = static_cast<GltfMode>(mode);
        primitive.indices = index(from, at, "indices", "accessors");
        primitive.material = index(from, at, "material", "materials");
        if (const Json* targets = find_array(from, at, "targets")) primitive.morphs = targets->size();
        constexpr const char* draco = "KHR_draco_mesh_compression";
        if (find_extension(from, at, draco)) primitive.compression = draco;
        const Json* attributes = find_object(from, at, "attributes");
        if (!attributes) refuse_at(at, "\"attributes\" is missing");
        const std::string where = at + "/attributes";
        primitive.positions = index(*attributes, where, "POSITION", "accessors");
        primitive.colours = index(*attributes, where, "COLOR_0", "accessors");
        constexpr std::string_view set = "TEXCOORD_";
        for (const auto& [name, value] : attributes->items()) {
            if (!name.starts_with(set) || name.size() != set.size() + 1) continue;
            const char digit = name.back();
            if (digit >= '0' && digit <= '9')
                primitive.uvs[static_cast<std::uint64_t>(digit - '0')] =
                    as_index(value, where + "/" + name, "accessors");
        }
        return primitive;
    }

    GltfTransform parse_transform(const Json& from, const std::string& at) const {
        const std::vector<double> m = numbers(from, at, "matrix", 16);
        GltfTransform result;
        if (!m.empty()) {
            constexpr double rounding = 1e-5;
            if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1.0) > rounding)
                refuse_at(at + "/matrix", "its last row must be 0, 0, 0, 1");
            result.x = {m[0], m[1], m[2]};
            result.y = {m[4], m[5], m[6]};
            result.z = {m[8], m[9], m[10]};
            result.origin = {m[12], m[13], m[14]};
            return result;
        }
        const std::vector<double> move = numbers(from, at, "translation", 3), turn = numbers(from, at, "rotation", 4),
                                  scale = numbers(from, at, "scale", 3);
        if (!turn.empty()) {
            const double x = turn[0], y = turn[1], z = turn[2], w = turn[3];
            const double square = x * x + y * y + z * z + w * w;
            if (!(square > 1e-12)) refuse_at(at + "/rotation", "a quaternion of length 0 turns nothing");
            const double s = 2.0 / square;
            result.x = {1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)};
            result.y = {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)};
            result.z = {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)};
        }
        if (!scale.empty()) {
            result.x *= scale[0];
            result.y *= scale[1];
            result.z *= scale[2];
        }
        if (!move.empty()) result.origin = {move[0], move[1], move[2]};
        return result;
    }

    GltfNode parse_node(const Json& from, const std::string& at) const {
        GltfNode result;
        result.local = parse_transform(from, at);
        result.mesh = index(from, at, "mesh", "meshes");
        result.children = indices(from, at, "children", "nodes");
        result.skinned = result.mesh && find(from, "skin");
        result.instanced = result.mesh && find_extension(from, at, "EXT_mesh_gpu_instancing");
        return result;
    }

    void parse_scene() {
        const std::size_t scenes = count("scenes");
        if (scenes > 0) {
            const std::size_t shown = index(root(), "", "scene", "scenes").value_or(0);
            const std::string at = fmt::format("/scenes/{}", shown);
            const Json& named = object_of("scenes", shown);
            model_.roots = indices(named, at, "nodes", "nodes");
            model_.other_scenes = scenes - 1;
            return;
        }
        std::vector<bool> is_child(model_.nodes.size());
        for (const GltfNode& node : model_.nodes)
            for (const std::size_t child : node.children) is_child[child] = true;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) model_.roots.push_back(i);
    }

    std::optional<GltfBuffer> chunk_;
    GltfModel model_;
};

}  // namespace

GltfModel parse_gltf(const std::filesystem::path& file, const std::string& document, std::optional<GltfBuffer> chunk) {
    const nlohmann::json root = parse_json(document, file.string());
    return GltfParser(file, root, std::move(chunk)).parse();
}

}  // namespace shadowbench::scene

// What a glTF 2.0 file says of its triangles and of the light that passes them, as plain values. Every index is that of
// an element that exists. Sizes and offsets are below 2^50, so that sums and products of them do not overflow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace shadowbench::scene {

// p -> p.x * x + p.y * y + p.z * z + origin.
struct GltfTransform {
    base::Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};
};
base::Vec3d apply(const GltfTransform& transform, const base::Vec3d& point);
// Applies `inner` first.
GltfTransform combined(const GltfTransform& outer, const GltfTransform& inner);

// A part of a file, which is read when it is needed, or bytes in memory.
struct GltfBuffer {
    std::uint64_t size = 0;
    std::filesystem::path file;  // empty: in memory
    std::uint64_t begin = 0;     // in the file
    std::vector<char> bytes;
};

struct GltfView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0, length = 0;
    std::uint64_t stride = 0;  // from one element to the next; 0: they touch
};

// The numbers are those of the format.
enum class GltfComponent { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

// Replaces some elements of an accessor.
struct GltfSparse {
    std::uint64_t count = 0;
    std::size_t indices = 0, values = 0;  // views
    std::uint64_t indices_offset = 0, values_offset = 0;
    GltfComponent indices_type = GltfComponent::uint32;
};

struct GltfAccessor {
    std::optional<std::size_t> view;  // absent: every element is 0
    std::uint64_t offset = 0, count = 0;
    GltfComponent type = GltfComponent::float32;
    int components = 1;
    bool normalized = false;  // whole numbers stand for [0, 1] or [-1, 1]
    std::optional<GltfSparse> sparse;
};

enum class GltfMode { points, lines, line_loop, line_strip, triangles, strip, fan };

struct GltfPrimitive {
    GltfMode mode = GltfMode::triangles;
    std::optional<std::size_t> positions, indices, colours;  // accessors
    std::map<std::uint64_t, std::size_t> uvs;                // accessors, by the number of the set
    std::optional<std::size_t> material;
    std::size_t morphs = 0;
    std::string compression;  // the extension that compresses it, or empty
};

struct GltfNode {
    GltfTransform local;
    std::optional<std::size_t> mesh;
    std::vector<std::size_t> children;
    bool skinned = false, instanced = false;
};

enum class GltfAlphaMode { opaque, mask, blend };

struct GltfMaterial {
    GltfAlphaMode mode = GltfAlphaMode::opaque;
    double cutoff = 0.5, factor = 1.0;
    std::optional<std::size_t> texture;
    std::uint64_t uv_set = 0;
    base::Vec2d uv_scale{1, 1}, uv_offset{0, 0};
    bool uv_turned = false;
};

enum class GltfWrap { repeat, mirror, clamp };

struct GltfTexture {
    std::optional<std::size_t> image;
    GltfWrap u = GltfWrap::repeat, v = GltfWrap::repeat;
};

// In a file or a data URI, or in a view.
struct GltfImage {
    std::string uri;
    std::optional<std::size_t> view;
};

struct GltfModel {
    std::filesystem::path file;
    std::vector<GltfBuffer> buffers;
    std::vector<GltfView> views;
    std::vector<GltfAccessor> accessors;
    std::vector<std::vector<GltfPrimitive>> meshes;
    std::vector<GltfNode> nodes;
    std::vector<std::size_t> roots;  // the nodes at the top of the scene
    std::vector<GltfMaterial> materials;
    std::vector<GltfTexture> textures;
    std::vector<GltfImage> images;
    std::size_t other_scenes = 0, animations = 0, transmitting_materials = 0;
};

// Throws Error{bad_input}, place "file: /accessors/3".
[[noreturn]] void fail(const GltfModel& model, const std::string& pointer, const std::string& message);

// Opens text and binary files. Reads the bytes of data URIs, and checks that the files of other buffers are there and
// long enough. Throws Error: no_such_file, io, bad_input.
GltfModel open_gltf(const std::filesystem::path& file);

// The document of a file, and the binary chunk after it, if there is one.
GltfModel parse_gltf(const std::filesystem::path& file, const std::string& document, std::optional<GltfBuffer> chunk);

}  // namespace shadowbench::scene

#include "scene/readers/gltf_model.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"
#include "scene/readers/file_reader.h"

namespace shadowbench::scene {
namespace {

using base::Vec3d;

constexpr std::uint64_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

struct Chunk {
    std::uint32_t type = 0;
    std::uint64_t begin = 0, size = 0;
};

Chunk read_chunk(FileReader& reader, std::uint64_t at) {
    reader.seek(at, "chunk");
    Chunk chunk;
    chunk.size = reader.value<std::uint32_t>("chunk");
    chunk.type = reader.value<std::uint32_t>("chunk");
    chunk.begin = reader.position();
    reader.need(chunk.size, 1, "chunk");
    return chunk;
}

// glTF 2.0, section 4: a header of magic, version and length, then chunks. The first is the document, and the second
// the bytes of the first buffer. Others are for extensions.
GltfModel open_binary(const std::filesystem::path& file, FileReader& reader) {
    reader.seek(4, "version");
    const auto version = reader.value<std::uint32_t>("version");
    if (version != 2) reader.fail(4, fmt::format("version {} of glTF; 2 is read: write the file as glTF 2.0", version));
    const auto length = reader.value<std::uint32_t>("length");
    if (length > reader.size())
        reader.fail(8, fmt::format("the length is {} bytes, but the file has {}: it is cut", length, reader.size()));
    const Chunk document = read_chunk(reader, header_bytes);
    if (document.type != json_chunk) reader.fail(document.begin, "the first chunk is no JSON: the file is damaged");
    const std::vector<char> chunk = reader.array<char>(document.size, "document");
    std::string text(chunk.begin(), chunk.end());
    // Some programs fill it up with bytes of 0 instead of spaces.
    text.erase(text.find_last_not_of('\0') + 1);
    std::optional<GltfBuffer> bytes;
    // Some programs do not count the bytes that fill a chunk up to a multiple of 4.
    const std::uint64_t next = (reader.position() + 3) / 4 * 4;
    if (next + chunk_header_bytes <= length) {
        const Chunk binary = read_chunk(reader, next);
        if (binary.type == binary_chunk) bytes = GltfBuffer{binary.size, file, binary.begin, {}};
    }
    return parse_gltf(file, text, std::move(bytes));
}

bool looks_like_json(std::string_view text) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    if (text.starts_with(mark)) text.remove_prefix(mark.size());
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && text[first] == '{';
}

Vec3d turned(const GltfTransform& transform, const Vec3d& v) {
    return transform.x * v.x + transform.y * v.y + transform.z * v.z;
}

}  // namespace

Vec3d apply(const GltfTransform& transform, const Vec3d& point) {
    return turned(transform, point) + transform.origin;
}

GltfTransform combined(const GltfTransform& outer, const GltfTransform& inner) {
    return {turned(outer, inner.x), turned(outer, inner.y), turned(outer, inner.z), apply(outer, inner.origin)};
}

void fail(const GltfModel& model, const std::string& pointer, const std::string& message) {
    throw base::Error(base::ErrorCode::bad_input, fmt::format("{}: {}", model.file.string(), pointer), message);
}

GltfModel open_gltf(const std::filesystem::path& file) {
    FileReader reader(file);
    constexpr std::array magic{'g', 'l', 'T', 'F'};
    if (reader.size() >= magic.size() && reader.value<std::array<char, 4>>("header") == magic)
        return open_binary(file, reader);
    const std::string text = base::read_bytes(file);
    if (!looks_like_json(text))
        reader.fail(0, "not a glTF file: it begins neither with { as a text nor with glTF as a binary file");
    return parse_gltf(file, text, std::nullopt);
}

}  // namespace shadowbench::scene

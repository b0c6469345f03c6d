#include "scene/readers/gltf_image.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "scene/readers/files.h"
#include "scene/readers/gltf_accessor.h"
#include "scene/readers/gltf_uri.h"

namespace shadowbench::scene {
namespace {

std::vector<char> embedded_bytes(const GltfModel& model, const GltfImage& image, const std::string& at) {
    if (image.view) return read_gltf_view(model, *image.view);
    std::optional<std::vector<char>> bytes = data_of_uri(image.uri);
    if (!bytes) fail(model, at + "/uri", "a data URI that is damaged, or not in base64");
    return std::move(*bytes);
}

}  // namespace

std::optional<AlphaTexture> read_gltf_image(const GltfModel& model, std::size_t number) {
    const GltfImage& image = model.images[number];
    const std::string at = fmt::format("/images/{}", number), where = fmt::format("{}: {}", model.file.string(), at);
    if (!image.view && image.uri.empty()) fail(model, at, "\"uri\" or \"bufferView\" is missing");
    if (!image.view && !is_data_uri(image.uri))
        return read_alpha_channel(file_of_uri(model.file, image.uri, where + "/uri"));
    // The checks that images need before a library reads them are for files.
    const std::vector<char> bytes = embedded_bytes(model, image, at);
    const base::TemporaryFolder folder;
    const std::filesystem::path copy = folder.path() / "image";
    std::ofstream stream(copy, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw base::Error(base::ErrorCode::io, where, "no room for a temporary copy of the image");
    try {
        return read_alpha_channel(copy);
    } catch (const base::Error& error) {
        throw base::Error(error.code(), where, error.message());
    }
}

}  // namespace shadowbench::scene

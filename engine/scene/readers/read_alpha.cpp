#include "scene/readers/read_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene/readers/exr_check.h"
#include "scene/readers/extension.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {

int alpha_channel(const OIIO::ImageSpec& spec) {
    const int named = spec.channelindex("A");
    return named >= 0 ? named : spec.alpha_channel;
}

namespace {

// Checks pixels without compression: `bits` bits for each pixel, and the masks of the channels.
void check_dds_masks(const OIIO::ImageSpec& spec, const std::filesystem::path& file, std::uint32_t bits,
                     const std::array<std::uint32_t, 4>& masks) {
    if (bits == 0) refuse_image(file, "its pixels have 0 bits; save it again");
    const bool coloured = spec.nchannels > 2, alpha = spec.nchannels % 2 == 0;
    if (masks[0] == 0 || (coloured && (masks[1] == 0 || masks[2] == 0)) || (alpha && masks[3] == 0))
        refuse_image(file, "it has a channel of 0 bits; save it again");
}

// The DDS reader of OpenImageIO 2.4 returns pixels even if the file ends before them, and never ends on a channel of 0
// bits. Layout: Microsoft, DDS_HEADER.
void check_dds(const OIIO::ImageSpec& spec, const std::filesystem::path& file) {
    FileReader reader(file);
    reader.seek(88, "pixel format");
    const auto bits = reader.value<std::uint32_t>("pixel format");
    const auto masks = reader.value<std::array<std::uint32_t, 4>>("pixel format");
    const auto width = static_cast<std::uint64_t>(spec.width), height = static_cast<std::uint64_t>(spec.height);
    const std::string compression = spec.get_string_attribute("compression");
    std::uint64_t bytes = width * height * bits / 8;
    if (compression.empty()) {
        check_dds_masks(spec, file, bits, masks);
    } else {
        // To undo the multiplication by alpha, the library divides whole numbers by alpha, which may be 0.
        if (compression == "DXT2" || compression == "DXT4")
            refuse_image(file, "a " + compression + " file holds colours multiplied by alpha: save it as DXT3 or DXT5");
        // 4 x 4 texels a block.
        const std::uint64_t block = compression == "DXT1" || compression == "BC4" ? 8 : 16;
        bytes = (width + 3) / 4 * ((height + 3) / 4) * block;
    }
    reader.seek(128, "pixels");
    reader.need(bytes, 1, "pixels");
}

// OpenImageIO 2.4 leaks memory if a PNG file ends inside a chunk. Layout: PNG specification, section 5: a signature,
// then chunks of a length, a type, that many bytes and a checksum; IEND is the last chunk.
void check_png_chunks(const std::filesystem::path& file) {
    FileReader reader(file);
    std::uint64_t next = 8;
    for (std::string type; type != "IEND"; next += 4) {
        reader.seek(next, "chunk");
        std::uint32_t length = 0;
        for (const std::uint8_t byte : reader.value<std::array<std::uint8_t, 4>>("chunk")) length = length << 8 | byte;
        const auto name = reader.value<std::array<char, 4>>("chunk");
        type.assign(name.begin(), name.end());
        reader.need(std::uint64_t{length} + 4, 1, "chunk");
        next += 8 + std::uint64_t{length};
    }
}

// The first bytes of a file show its format; only a TARGA file is known by its name. OpenImageIO supports many more
// formats and would try each, but few of their readers withstand damaged files.
struct Format {
    const char* name;  // OpenImageIO's name
    std::string_view begin;
};
constexpr std::array formats{
    Format{"png", "\x89PNG"},     Format{"jpeg", "\xff\xd8\xff"},        Format{"tiff", {"II*\0", 4}},
    Format{"tiff", {"MM\0*", 4}}, Format{"openexr", "\x76\x2f\x31\x01"}, Format{"dds", "DDS "}};

// Empty if the file is of none of these formats.
std::string format_of(const std::filesystem::path& file) {
    FileReader reader(file);
    const std::vector<char> begin = reader.array<char>(std::min<std::uint64_t>(reader.size(), 4), "header");
    for (const Format& format : formats)
        if (std::string_view(begin.data(), begin.size()).starts_with(format.begin)) return format.name;
    return extension_of(file) == ".tga" ? "targa" : "";
}

// Luminance weights of ITU-R BT.709.
float luminance(const float* pixel, int channels) {
    return channels < 3 ? pixel[0] : 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2];
}

}  // namespace

std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file) {
    const std::string format = format_of(file);
    if (format.empty()) refuse_image(file, "not a PNG, JPEG, TIFF, OpenEXR, DDS or (by its name) TGA file");
    if (format == "openexr") check_exr(file);
    if (format == "png") check_png_chunks(file);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec ignored;
    if (!input || !input->open(file.string(), ignored))
        refuse_image(file, "not a readable image: " + (input ? input->geterror() : OIIO::geterror()));
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > max_image_side || spec.height > max_image_side)
        refuse_image(file,
                     fmt::format("{} x {} pixels; 1 to {} a side are read", spec.width, spec.height, max_image_side));
    return input;
}

void refuse_image(const std::filesystem::path& file, const std::string& message) {
    // The library's messages often name the file, in quotes or not; the error's place already names it.
    std::string rest = message;
    for (const std::string& name : {'"' + file.string() + '"', file.string()})
        for (std::size_t at = rest.find(name); at != std::string::npos; at = rest.find(name))
            rest.replace(at, name.size(), "the file");
    throw base::Error(base::ErrorCode::bad_input, file.string(), rest);
}

AlphaTexture read_alpha(const std::filesystem::path& file) {
    try {
        const std::unique_ptr<OIIO::ImageInput> input = open_image(file);
        const OIIO::ImageSpec spec = input->spec();
        if (std::string_view(input->format_name()) == "dds") check_dds(spec, file);
        if (spec.deep) refuse_image(file, "a deep image cannot be a texture; use a flat one");
        const std::uint64_t texels = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
        const int channels = spec.nchannels;
        if (spec.depth > 1 || channels < 1 || texels * static_cast<std::uint64_t>(channels) > max_texels)
            refuse_image(file, fmt::format("{} x {} x {} pixels of {} channels; the limit is {} values", spec.width,
                                           spec.height, spec.depth, channels, max_texels));
        const std::uint64_t bytes = std::filesystem::file_size(file);
        if (texels * static_cast<std::uint64_t>(channels) / max_values_per_byte > bytes)
            refuse_image(file, fmt::format("{} x {} pixels in a file of {} bytes: it is damaged", spec.width,
                                           spec.height, bytes));
        std::vector<float> values(texels * static_cast<std::uint64_t>(channels));
        // Some readers report success but leave an error behind.
        if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data()) || input->has_error())
            refuse_image(file, "damaged or cut short: " + input->geterror());

        AlphaTexture texture{spec.width, spec.height, {}};
        texture.alpha.reserve(texels);
        const int alpha = alpha_channel(spec);
        for (std::uint64_t i = 0; i < texels; ++i) {
            const float* pixel = values.data() + i * static_cast<std::uint64_t>(channels);
            const float value = alpha >= 0 ? pixel[alpha] : luminance(pixel, channels);
            if (!std::isfinite(value))
                refuse_image(file, fmt::format("pixel ({}, {}) is {}", i % static_cast<std::uint64_t>(spec.width),
                                               i / static_cast<std::uint64_t>(spec.width), value));
            texture.alpha.push_back(std::clamp(value, 0.0f, 1.0f));
        }
        return texture;
    } catch (const base::Error&) {
        throw;
    } catch (const std::exception& fault) {
        refuse_image(file, fmt::format("not a readable image: {}", fault.what()));
    }
}

std::optional<AlphaTexture> read_alpha_channel(const std::filesystem::path& file) {
    if (alpha_channel(open_image(file)->spec()) < 0) return std::nullopt;
    return read_alpha(file);
}

}  // namespace shadowbench::scene

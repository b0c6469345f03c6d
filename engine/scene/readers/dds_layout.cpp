// Layout: Microsoft's programming guide for DDS, DDS_HEADER, DDS_PIXELFORMAT and DDS_HEADER_DXT10.
#include "scene/readers/dds_layout.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/kinds.h"

namespace shadowbench::scene {
namespace {

constexpr std::uint32_t four_characters(const char (&text)[5]) {
    std::uint32_t code = 0;
    for (int i = 3; i >= 0; --i) code = (code << 8) | static_cast<unsigned char>(text[i]);
    return code;
}

constexpr std::uint32_t has_mip_levels = 0x20000, has_depth = 0x800000;  // flags of the header
constexpr std::uint32_t has_alpha = 0x1, only_alpha = 0x2, has_code = 0x4, rgb = 0x40,
                        luminance = 0x20000;  // flags of the texels
constexpr std::uint32_t volume = 0x200000;    // flag of the second caps
constexpr std::uint32_t texture_3d = 4;       // a resource dimension

struct Header {
    std::uint32_t magic, size, flags, height, width, pitch, depth, mip_levels, reserved[11];
    std::uint32_t pixel_size, pixel_flags, pixel_code, pixel_bits, masks[4];
    std::uint32_t caps[4], reserved_too;
};
static_assert(sizeof(Header) == 128);

// Old tools leave out the flag of volumes.
bool is_volume_of(const Header& header) {
    return (header.caps[1] & volume) || ((header.flags & has_depth) && header.depth > 1);
}

struct ExtraHeader {
    std::uint32_t format, dimension, flags, array_size, more_flags;
};

// The formats of the extra header that are read; sRGB colours are not densities.
struct DxgiFormat {
    std::uint32_t number;
    bool blocks;
    int texel_bytes;
    std::array<int, 4> byte;
};
constexpr std::uint32_t bc2_number = 74;
constexpr DxgiFormat dxgi_formats[] = {
    {28, false, 4, {0, 1, 2, 3}},     // R8G8B8A8_UNORM
    {49, false, 2, {0, 1, -1, -1}},   // R8G8_UNORM
    {61, false, 1, {0, 0, 0, -1}},    // R8_UNORM
    {65, false, 1, {-1, -1, -1, 0}},  // A8_UNORM
    {bc2_number, true, 0, {}},        // BC2_UNORM
    {77, true, 0, {}},                // BC3_UNORM
    {87, false, 4, {2, 1, 0, 3}},     // B8G8R8A8_UNORM
    {88, false, 4, {2, 1, 0, -1}},    // B8G8R8X8_UNORM
};

constexpr const char* what_is_read =
    "DXT3 (BC2) and DXT5 (BC3) blocks, and red, green, blue, alpha or luminance of 8 bits each without compression, are "
    "read: save it in one of these";

// The byte of a texel that a mask covers.
int byte_of(const FileReader& file, std::uint32_t mask, int texel_bytes) {
    for (int byte = 0; byte < texel_bytes; ++byte)
        if (mask == 0xffu << (8 * byte)) return byte;
    file.fail(92, fmt::format("a channel with the bit mask {:#x}; {}", mask, what_is_read));
}

void read_masks(const FileReader& file, const Header& header, DdsLayout& layout) {
    const std::uint32_t flags = header.pixel_flags;
    if (header.pixel_bits % 8 != 0 || header.pixel_bits < 8 || header.pixel_bits > 32)
        file.fail(88, fmt::format("texels of {} bits; {}", header.pixel_bits, what_is_read));
    layout.texel_bytes = static_cast<int>(header.pixel_bits / 8);
    const auto channel = [&](int i) { return byte_of(file, header.masks[i], layout.texel_bytes); };
    if (flags & luminance)
        layout.byte[0] = layout.byte[1] = layout.byte[2] = channel(0);
    else if (flags & rgb)
        for (int i = 0; i < 3; ++i) layout.byte[static_cast<std::size_t>(i)] = channel(i);
    else if (!(flags & only_alpha))
        file.fail(80, fmt::format("texels of the kind {:#x}; {}", flags, what_is_read));
    if (flags & (has_alpha | only_alpha)) layout.byte[3] = channel(3);
}

void read_format(FileReader& file, const Header& header, DdsLayout& layout, bool& is_volume) {
    is_volume = is_volume_of(header);
    if (!(header.pixel_flags & has_code)) return read_masks(file, header, layout);
    layout.bc2 = header.pixel_code == four_characters("DXT3");
    if (layout.bc2 || header.pixel_code == four_characters("DXT5")) {
        layout.blocks = true;
        return;
    }
    if (header.pixel_code != four_characters("DX10"))
        file.fail(84, fmt::format("the format code {:#x}; {}", header.pixel_code, what_is_read));
    const auto extra = file.value<ExtraHeader>("header");
    const auto* format = std::find_if(std::begin(dxgi_formats), std::end(dxgi_formats),
                                      [&](const DxgiFormat& one) { return one.number == extra.format; });
    if (format == std::end(dxgi_formats))
        file.fail(sizeof(Header), fmt::format("the DXGI format {}; {}", extra.format, what_is_read));
    is_volume = is_volume || extra.dimension == texture_3d;
    layout.blocks = format->blocks;
    layout.bc2 = format->number == bc2_number;
    layout.texel_bytes = format->texel_bytes;
    layout.byte = format->byte;
}

}  // namespace

bool is_dds_volume(const std::filesystem::path& file) {
    FileReader reader(file);
    const auto header = reader.value<Header>("header");
    if (is_volume_of(header)) return true;
    const bool more = (header.pixel_flags & has_code) && header.pixel_code == four_characters("DX10");
    return more && reader.value<ExtraHeader>("header").dimension == texture_3d;
}

DdsLayout read_dds_layout(FileReader& file, std::uint64_t most_voxels) {
    const auto header = file.value<Header>("header");
    if (header.magic != four_characters("DDS ") || header.size != 124 || header.pixel_size != 32)
        file.fail(0, "not a DDS texture: its header has other numbers");
    DdsLayout layout;
    bool is_volume = false;
    read_format(file, header, layout, is_volume);
    if (!is_volume) file.fail(112, "a flat texture: a volume texture (DDSCAPS2_VOLUME) is needed");

    const double voxels = static_cast<double>(header.width) * header.height * header.depth;
    if (!(voxels >= 1.0) || voxels > static_cast<double>(most_voxels))
        file.fail(12, fmt::format("{} x {} x {} voxels; 1 to {} are read", header.width, header.height, header.depth,
                                  most_voxels));
    layout.size = {static_cast<int>(header.width), static_cast<int>(header.height), static_cast<int>(header.depth)};
    layout.begin = file.position();
    if (header.flags & has_mip_levels) layout.mip_levels = static_cast<int>(std::clamp(header.mip_levels, 1u, 32u));
    return layout;
}

}  // namespace shadowbench::scene

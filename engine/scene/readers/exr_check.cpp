// The format follows "OpenEXR File Layout" (openexr.com): a magic number, a version with flags, the header of each
// part, tables of the positions of their chunks, chunks. A header consists of attributes: name, type, size, value. An
// empty name ends it.
#include "scene/readers/exr_check.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/file_reader.h"

namespace shadowbench::scene {
namespace {

constexpr std::uint32_t magic = 0x01312f76;
constexpr std::uint32_t tiled = 0x200, long_names = 0x400, deep = 0x800, multi_part = 0x1000;
constexpr std::uint32_t most_parts = 1024, most_channels = 1024;
struct TypeSize {
    std::string_view type;
    std::uint32_t bytes;
};
constexpr std::array fixed_sizes{
    TypeSize{"box2i", 16},   TypeSize{"box2f", 16},      TypeSize{"chromaticities", 32},
    TypeSize{"double", 8},   TypeSize{"compression", 1}, TypeSize{"deepImageState", 1},
    TypeSize{"envmap", 1},   TypeSize{"float", 4},       TypeSize{"int", 4},
    TypeSize{"keycode", 28}, TypeSize{"lineOrder", 1},   TypeSize{"m33f", 36},
    TypeSize{"m33d", 72},    TypeSize{"m44f", 64},       TypeSize{"m44d", 128},
    TypeSize{"rational", 8}, TypeSize{"tiledesc", 9},    TypeSize{"timecode", 8},
    TypeSize{"v2i", 8},      TypeSize{"v2f", 8},         TypeSize{"v2d", 16},
    TypeSize{"v3i", 12},     TypeSize{"v3f", 12},        TypeSize{"v3d", 24},
};
constexpr std::int32_t last_pixel_type = 2, last_compression = 9, last_line_order = 2;

class Walk {
public:
    explicit Walk(const std::filesystem::path& file) : reader_(file) {}

    void run() {
        if (reader_.value<std::uint32_t>("header") != magic) reader_.fail(0, "not an OpenEXR file");
        const auto version = reader_.value<std::uint32_t>("header");
        if ((version & 0xff) != 2 || (version & ~(0xff | tiled | long_names | deep | multi_part)) != 0)
            reader_.fail(
                4, fmt::format("version {:#x} of the format is not supported; save the file as version 2", version));
        std::uint32_t parts = 0;
        while (header())
            if (++parts > most_parts)
                reader_.fail(reader_.position(), fmt::format("over {} parts", most_parts));
            else if (!(version & multi_part))
                return;
        if (parts == 0) reader_.fail(8, "the file has no header");
    }

private:
    struct Found {
        bool channels = false, window = false;
    };

    // Returns false at the empty header, which ends the headers of a file of several parts.
    bool header() {
        const std::uint64_t at = reader_.position();
        Found found;
        std::string name = text("attribute");
        if (name.empty()) return false;
        for (; !name.empty(); name = text("attribute")) {
            const std::string type = text("type");
            const auto size = reader_.value<std::uint32_t>("attribute");
            reader_.need(size, 1, "attribute");
            const std::uint64_t value = reader_.position(), end = value + size;
            check_size(name, type, size);
            attribute(name, type, end, found);
            if (reader_.position() > end)
                reader_.fail(value, fmt::format("the attribute {} is longer than its stated size", name));
            reader_.seek(end, "attribute");
        }
        if (!found.channels || !found.window) reader_.fail(at, "a header has no channels or no data window");
        return true;
    }

    // The library reads a value of these types at its own size and continues after that, whatever size the file states:
    // it would take unchecked bytes for the next attribute.
    void check_size(const std::string& name, const std::string& type, std::uint32_t size) const {
        for (const TypeSize& row : fixed_sizes)
            if (row.type == type && row.bytes != size)
                fail(fmt::format("the attribute {} has {} bytes, but a {} has {}", name, size, type, row.bytes));
        if (type == "floatvector" && size % 4 != 0)
            fail(fmt::format("the attribute {} has {} bytes, not a multiple of 4", name, size));
    }

    void attribute(const std::string& name, const std::string& type, std::uint64_t end, Found& found) {
        if (name == "channels" && type == "chlist") {
            channels(end);
            found.channels = true;
        } else if (type == "stringvector") {
            strings(end);
        } else if (type == "preview") {
            preview(name, end);
        } else if ((name == "dataWindow" || name == "displayWindow") && type == "box2i") {
            window();
            found.window = found.window || name == "dataWindow";
        } else if (name == "tiles" && type == "tiledesc") {
            const auto side = reader_.value<std::array<std::uint32_t, 2>>("tiles");
            for (const std::uint32_t pixels : side)
                if (pixels < 1 || pixels > max_image_side) fail(fmt::format("the tiles have {} pixels a side", pixels));
        } else if (name == "compression") {
            in_range(name, reader_.value<std::uint8_t>("compression"), last_compression);
        } else if (name == "lineOrder") {
            in_range(name, reader_.value<std::uint8_t>("line order"), last_line_order);
        } else if (name == "chunkCount") {
            // Each chunk has its position in a table.
            const auto chunks = reader_.value<std::uint32_t>("chunks");
            if (chunks > reader_.size() / 8) fail(fmt::format("the file is too short for its {} chunks", chunks));
        }
    }

    // Name, pixel type, four bytes, distances between samples; an empty name ends the list.
    void channels(std::uint64_t end) {
        std::uint32_t count = 0;
        for (std::string name = text("channel"); !name.empty(); name = text("channel")) {
            if (++count > most_channels) fail(fmt::format("over {} channels", most_channels));
            in_range("pixel type", reader_.value<std::int32_t>("channel"), last_pixel_type);
            reader_.value<std::uint32_t>("channel");
            const auto sampling = reader_.value<std::array<std::int32_t, 2>>("channel");
            if (sampling != std::array<std::int32_t, 2>{1, 1})
                fail(fmt::format("the channel {} has a sample every {} x {} pixels; only full resolution is read", name,
                                 sampling[0], sampling[1]));
            if (reader_.position() > end) return;
        }
        if (count == 0) fail("the image has no channels");
        if (reader_.position() < end) fail("the list of channels is shorter than its stated size");
    }

    // Each text follows its length.
    void strings(std::uint64_t end) {
        while (reader_.position() < end) {
            const auto length = reader_.value<std::uint32_t>("text");
            if (reader_.position() > end || length > end - reader_.position()) fail("a text is longer than its list");
            reader_.seek(reader_.position() + length, "text");
        }
    }

    // Width, height, and four bytes for each pixel.
    void preview(const std::string& name, std::uint64_t end) {
        const auto side = reader_.value<std::array<std::uint32_t, 2>>("preview");
        const std::uint64_t pixels = std::uint64_t{side[0]} * side[1];  // both below 2^32
        if (reader_.position() > end || pixels > reader_.size() || 4 * pixels != end - reader_.position())
            fail(fmt::format("the attribute {} does not hold {} x {} pixels", name, side[0], side[1]));
    }

    void window() {
        const auto box = reader_.value<std::array<std::int32_t, 4>>("window");
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::int64_t side = std::int64_t{box[axis + 2]} - box[axis] + 1;
            if (side < 1 || side > max_image_side)
                fail(fmt::format("{} pixels along a side; 1 to {} are read", side, max_image_side));
        }
    }

    void in_range(const std::string& name, std::int32_t value, std::int32_t last) const {
        if (value < 0 || value > last) fail(fmt::format("the {} {} is unknown; 0 to {} are read", name, value, last));
    }

    // Reads up to the zero byte.
    std::string text(const char* what) {
        constexpr std::size_t longest = 255;
        std::string result;
        for (char c = reader_.value<char>(what); c != '\0'; c = reader_.value<char>(what)) {
            result += c;
            if (result.size() > longest) fail(fmt::format("the name of an {} has more than {} bytes", what, longest));
        }
        return result;
    }

    [[noreturn]] void fail(const std::string& message) const {
        reader_.fail(reader_.position(), "the header is damaged or of an unsupported kind: " + message);
    }

    FileReader reader_;
};

}  // namespace

void check_exr(const std::filesystem::path& file) {
    Walk(file).run();
}

}  // namespace shadowbench::scene

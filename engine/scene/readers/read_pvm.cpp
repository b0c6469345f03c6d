// The volume format of the V3 library: a header in text, the voxels, and in PVM3 four texts about them. Published files
// are packed as bit_runs.h describes.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "scene/readers/bit_runs.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

struct Packing {
    std::string_view line;
    std::size_t block_groups;  // see bit_runs.h
};
constexpr Packing packings[] = {{"DDS v3d\n", 0}, {"DDS v3e\n", std::size_t{1} << 24}};

constexpr std::uint64_t most_text = std::uint64_t{1} << 20;  // bytes of the header and the texts, for the limit
constexpr std::size_t most_digits = 32;                      // of a number in the header
constexpr int texts = 4;                                     // of PVM3: description, courtesy, parameter, comment

struct Magic {
    std::string_view line;
    bool spacing, texts;  // what the format has
};
constexpr Magic magics[] = {{"PVM\n", false, false}, {"PVM2\n", true, false}, {"PVM3\n", true, true}};

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The bytes of a file, unpacked if they were packed, read from the front.
class Content {
public:
    Content(const FileReader& file, std::vector<std::uint8_t> bytes, bool packed)
        : file_(file), bytes_(std::move(bytes)), packed_(packed) {}

    std::size_t left() const { return bytes_.size() - at_; }
    const std::uint8_t* here() const { return bytes_.data() + at_; }
    void pass(std::size_t bytes) { at_ += bytes; }

    [[noreturn]] void fail(const std::string& message) const {
        if (!packed_) file_.fail(at_, message);
        file_.fail(packings[0].line.size(), fmt::format("byte {} of what it unpacks to: {}", at_, message));
    }

    // Passes a line if it stands here.
    bool pass_if(std::string_view line) {
        if (!text_of(bytes_).substr(at_).starts_with(line)) return false;
        at_ += line.size();
        return true;
    }

    // Reads a number, with the white space and the comments (from # to the end of the line) in front of it.
    template <class Number>
    Number number(const char* what) {
        pass_blanks();
        const std::string_view rest = text_of(bytes_).substr(at_, most_digits);
        Number value{};
        const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        const auto length = static_cast<std::size_t>(end - rest.data());
        if (fault != std::errc{} || length == rest.size() || !is_blank(rest[length]))
            fail(fmt::format("the header needs a number here: {}", what));
        at_ += length;
        return value;
    }

    void end_line() {
        while (left() > 0 && (*here() == ' ' || *here() == '\r')) ++at_;
        if (!pass_if("\n")) fail("the line of the header must end here");
    }

    // Passes a text that ends with a byte of 0.
    void pass_text() {
        const std::size_t end = text_of(bytes_).find('\0', at_);
        if (end == std::string_view::npos) fail("the file is cut short: a text without its end begins here");
        at_ = end + 1;
    }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
    void pass_blanks() {
        for (bool comment = false; left() > 0; ++at_) {
            const char c = static_cast<char>(*here());
            comment = c == '#' || (comment && c != '\n');
            if (!comment && !is_blank(c)) return;
        }
    }

    const FileReader& file_;
    std::vector<std::uint8_t> bytes_;
    bool packed_;
    std::size_t at_ = 0;
};

Content read_content(FileReader& file, std::uint64_t most_voxels) {
    std::vector<std::uint8_t> bytes = file.array<std::uint8_t>(file.size(), "volume");
    for (const Packing& packing : packings) {
        if (!text_of(bytes).starts_with(packing.line)) continue;
        const std::uint64_t begin = packing.line.size();
        return {file,
                unpack_bit_runs(file, std::span(bytes).subspan(begin), begin, packing.block_groups,
                                2 * most_voxels + most_text),
                true};
    }
    return {file, std::move(bytes), false};
}

Vec3i read_size(Content& content, std::uint64_t most_voxels) {
    Vec3i size(0, 0, 0);
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        size[axis] = content.number<int>("voxels along an axis");
        if (size[axis] < 1) content.fail(fmt::format("{} voxels along an axis; at least 1 is needed", size[axis]));
        voxels *= size[axis];
    }
    if (voxels > static_cast<double>(most_voxels))
        content.fail(fmt::format("{} x {} x {} voxels; the limit is {}", size.x, size.y, size.z, most_voxels));
    return size;
}

Vec3d read_extent(Content& content, const Vec3i& size, bool spacing) {
    Vec3d extent(size);
    if (!spacing) return extent;
    for (int axis = 0; axis < 3; ++axis) {
        extent[axis] *= content.number<double>("spacing of voxels along an axis");
        if (!(extent[axis] >= min_length && extent[axis] <= max_coordinate))
            content.fail(fmt::format("the volume is {} long along an axis; {} to {} are read", extent[axis], min_length,
                                     max_coordinate));
    }
    return extent;
}

int read_voxel_bytes(Content& content) {
    const int bytes = content.number<int>("bytes of a voxel");
    if (bytes != 1 && bytes != 2)
        content.fail(fmt::format("voxels of {} bytes; 1 (a density of 8 bits) and 2 (of 16 bits) are read", bytes));
    content.end_line();
    return bytes;
}

// Voxels of 16 bits have their high byte first.
std::vector<float> read_densities(Content& content, std::size_t voxels, int bytes) {
    std::vector<float> density;
    density.reserve(voxels);
    const std::uint8_t* from = content.here();
    if (bytes == 1)
        for (std::size_t i = 0; i < voxels; ++i) density.push_back(static_cast<float>(from[i]) / 255.0f);
    else
        for (std::size_t i = 0; i < voxels; ++i)
            density.push_back(static_cast<float>(256 * from[2 * i] + from[2 * i + 1]) / 65535.0f);
    content.pass(voxels * static_cast<std::size_t>(bytes));
    return density;
}

}  // namespace

GridVolume read_pvm(const std::filesystem::path& file, std::uint64_t most_voxels) {
    FileReader reader(file);
    Content content = read_content(reader, most_voxels);
    const auto* magic =
        std::find_if(std::begin(magics), std::end(magics), [&](const Magic& one) { return content.pass_if(one.line); });
    if (magic == std::end(magics))
        content.fail("neither PVM, PVM2 nor PVM3 stands at the front: this is not a PVM volume");

    GridVolume volume;
    volume.size = read_size(content, most_voxels);
    volume.upper = read_extent(content, volume.size, magic->spacing);
    const int bytes = read_voxel_bytes(content);
    const std::size_t voxels = static_cast<std::size_t>(volume.size.x) * static_cast<std::size_t>(volume.size.y) *
                               static_cast<std::size_t>(volume.size.z);
    if (content.left() < voxels * static_cast<std::size_t>(bytes))
        content.fail(
            fmt::format("the file is cut short: {} x {} x {} voxels of {} bytes begin here, and {} bytes follow",
                        volume.size.x, volume.size.y, volume.size.z, bytes, content.left()));
    volume.density = read_densities(content, voxels, bytes);
    for (int text = 0; magic->texts && text < texts; ++text) content.pass_text();
    if (content.left() > 0) content.fail(fmt::format("{} bytes follow the end of the volume", content.left()));
    return volume;
}

}  // namespace shadowbench::scene

// The slices of VolVis, as VTK's vtkSLCReader reads them: 14 numbers in text (the magic number, 3 sizes, bits of a
// voxel, 3 spacings, unit, origin of the data, kind of changes, packing, 2 sizes of an icon) and an X; an icon of three
// planes; and one slice after another, each with its number of bytes in text and an X in front of it if it is packed.
#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "scene/readers/grid_files.h"

namespace shadowbench::scene {
namespace {

constexpr int slc_magic = 11111;
constexpr std::uint64_t most_run = 0x7f;  // voxels, of two packed bytes

class SlcText {
public:
    explicit SlcText(FileReader& file) : file_(file) {}

    // Reads a number, the blanks in front of it, and the byte behind it, which must be blank.
    template <class Number>
    Number number(const char* what) {
        constexpr std::size_t most_digits = 40;
        char c = next_after_blanks(what);
        std::string word;
        for (; !is_blank(c) && word.size() < most_digits; c = file_.value<char>(what)) word += c;
        Number value{};
        const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (fault != std::errc{} || end != word.data() + word.size())
            file_.fail(at_, fmt::format("the header needs a number here: {}", what));
        return value;
    }

    // Reads the mark that stands between text and bytes.
    void mark(const char* what) {
        if (next_after_blanks(what) != 'X') file_.fail(at_, fmt::format("an X must stand in front of the {}", what));
    }

    // The byte at which the last number or mark begins.
    std::uint64_t at() const { return at_; }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

    char next_after_blanks(const char* what) {
        for (;;) {
            at_ = file_.position();
            const char c = file_.value<char>(what);
            if (!is_blank(c)) return c;
        }
    }

    FileReader& file_;
    std::uint64_t at_ = 0;
};

struct SlcHeader {
    Vec3i size{0, 0, 0};
    std::uint64_t voxels = 0;
    Vec3d spacing{1, 1, 1};
    int unit = 0;
    bool packed = false;
};

SlcHeader read_header(FileReader& file, SlcText& text, std::uint64_t most_voxels) {
    constexpr int all_bits = 8;
    if (text.number<int>("the magic number") != slc_magic)
        file.fail(text.at(), fmt::format("not a volume of VolVis: {} does not stand at its front", slc_magic));
    SlcHeader header;
    for (int axis = 0; axis < 3; ++axis) header.size[axis] = text.number<int>("voxels along an axis");
    header.voxels = count_voxels(file, text.at(), header.size, most_voxels);
    if (const int bits = text.number<int>("bits of a voxel"); bits != all_bits)
        file.fail(text.at(), fmt::format("voxels of {} bits; 8 are read", bits));
    for (int axis = 0; axis < 3; ++axis) {
        header.spacing[axis] = text.number<double>("spacing of voxels along an axis");
        if (!(header.spacing[axis] > 0.0)) file.fail(text.at(), "a spacing must be above 0");
    }
    header.unit = text.number<int>("unit of the spacing");
    text.number<int>("origin of the data");
    text.number<int>("changes of the data");
    const int packing = text.number<int>("packing");
    if (packing != 0 && packing != 1)
        file.fail(text.at(), fmt::format("packing {}; none (0) and runs (1) are read", packing));
    header.packed = packing == 1;
    return header;
}

void pass_icon(FileReader& file, SlcText& text) {
    constexpr int most_pixels = 1 << 14;  // along a side
    std::uint64_t bytes = 3;
    for (const char* what : {"width of the icon", "height of the icon"}) {
        const int side = text.number<int>(what);
        if (side < 0 || side > most_pixels)
            file.fail(text.at(), fmt::format("an icon of {} pixels along a side", side));
        bytes *= static_cast<std::uint64_t>(side);
    }
    text.mark("icon");
    file.need(bytes, 1, "the icon");
    file.seek(file.position() + bytes, "slice");
}

// Runs: a byte whose lower seven bits are a number n of voxels, 0 at the end; then n bytes if its highest bit is set,
// and else one for all n. Whether the last voxel is missing: Woolz packs all others, and VTK takes that.
bool unpack_runs(const FileReader& file, std::uint64_t begin, std::span<const std::uint8_t> packed,
                 std::span<float> density) {
    std::size_t at = 0, done = 0;
    const auto next = [&] {
        if (at == packed.size()) file.fail(begin + at, "the file is damaged: a slice ends inside its runs");
        return packed[at++];
    };
    for (std::uint8_t control = next(); (control & most_run) != 0; control = next()) {
        const std::size_t count = control & most_run;
        if (count > density.size() - done)
            file.fail(begin + at - 1, "the file is damaged: more voxels than a slice has");
        std::uint8_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (i == 0 || control > most_run) value = next();
            density[done++] = static_cast<float>(value) / 255.0f;
        }
    }
    if (done == 0 || done + 1 < density.size())
        file.fail(begin + at - 1,
                  fmt::format("the file is damaged: a slice of {} voxels has {}", density.size(), done));
    return done < density.size();
}

void read_slices(FileReader& file, SlcText& text, const SlcHeader& header, GridVolume& volume) {
    std::vector<float>& density = volume.density;
    const std::uint64_t left = file.size() - file.position(),
                        least = header.packed ? header.voxels / most_run : header.voxels;
    if (least > left)
        file.fail(file.position(),
                  fmt::format("the file is too short: {} voxels begin here, and {} bytes follow", header.voxels, left));
    density.resize(static_cast<std::size_t>(header.voxels));
    const std::size_t slice = density.size() / static_cast<std::size_t>(header.size.z);
    int without_last = 0;
    for (std::size_t from = 0; from < density.size(); from += slice) {
        const std::span<float> to = std::span(density).subspan(from, slice);
        std::uint64_t bytes = slice;
        if (header.packed) {
            bytes = text.number<std::uint64_t>("bytes of a slice");
            text.mark("slice");
        }
        const std::uint64_t begin = file.position();
        const std::vector<std::uint8_t> values = file.array<std::uint8_t>(bytes, "slice");
        if (header.packed)
            without_last += unpack_runs(file, begin, values, to);
        else
            std::transform(values.begin(), values.end(), to.begin(),
                           [](std::uint8_t v) { return static_cast<float>(v) / 255.0f; });
    }
    if (without_last > 0)
        volume.notes.lines.push_back(
            fmt::format("the last voxel of {} of {} slices is missing: 0 is taken", without_last, header.size.z));
}

}  // namespace

GridFile read_slc(const std::filesystem::path& file, std::uint64_t most_voxels) {
    FileReader reader(file);
    SlcText text(reader);
    const SlcHeader header = read_header(reader, text, most_voxels);
    const std::uint64_t spacing_at = text.at();
    GridFile result;
    GridVolume& volume = result.volume;
    volume.size = header.size;
    volume.upper = Vec3d(header.size) * header.spacing;
    if (const std::optional<std::string> fault = box_fault(volume.lower, volume.upper)) reader.fail(spacing_at, *fault);
    pass_icon(reader, text);
    read_slices(reader, text, header, volume);
    result.facts = {fmt::format("values of uint8{}, divided by 255", header.packed ? ", packed" : ""),
                    fmt::format("unit of its spacing: number {} of VolVis", header.unit)};
    if (reader.position() < reader.size()) volume.notes.lines.push_back("what follows its last voxel is passed over");
    return result;
}

}  // namespace shadowbench::scene

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/pending_file.h"
#include "techniques/deep/deep_file.h"
#include "techniques/deep/deep_file_format.h"

namespace shadowbench::techniques {
namespace {

using base::Error;
using base::ErrorCode;
using namespace deep_format;

struct Entry {
    std::uint64_t offset;
    std::uint32_t words, checksum;
};
static_assert(sizeof(Entry) == 16);

// Says why a level cannot be written; empty if it can.
std::string fault_of(const DeepLevel& level) {
    const auto side = [](int n) { return n >= 1 && n <= static_cast<int>(max_side); };
    if (!side(level.width) || !side(level.height)) return "its size";
    const std::size_t pixels = static_cast<std::size_t>(level.width) * level.height;
    if (level.channels != 1 && level.channels != 3) return "its number of channels";
    if (level.offsets.size() != pixels + 1 || level.offsets.front() != 0 ||
        !std::is_sorted(level.offsets.begin(), level.offsets.end()) || level.offsets.back() > level.floats.size())
        return "its offsets";
    if (!level.coloured.empty() && (level.channels != 3 || level.coloured.size() != (pixels + 63) / 64))
        return "its colour bits";
    for (std::size_t p = 0; p < pixels; ++p)
        if ((level.offsets[p + 1] - level.offsets[p]) % (level.has_colour(p) ? 4 : 2) != 0) return "a function's size";
    return "";
}

void check(const std::filesystem::path& file, std::span<const DeepLevel> levels, int tile_size,
           const DeepFileNotes& notes) {
    if (tile_size < 1 || tile_size > max_deep_tile)
        throw Error(ErrorCode::bad_input, file.string(),
                    fmt::format("a tile of {} pixels a side; choose 1 to {}", tile_size, max_deep_tile));
    if (notes.text.size() > max_text)
        throw Error(ErrorCode::bad_input, file.string(),
                    fmt::format("a text of {} bytes; the limit is {}", notes.text.size(), max_text));
    if (levels.empty()) throw Error(ErrorCode::internal, file.string(), "the deep shadow map has no levels");
    for (std::size_t i = 0; i < levels.size(); ++i) {
        std::string fault = fault_of(levels[i]);
        if (i > 0 && (levels[i].width != (levels[i - 1].width + 1) / 2 ||
                      levels[i].height != (levels[i - 1].height + 1) / 2 || levels[i].channels != levels[0].channels))
            fault = "it does not follow from the one before";
        if (i > 0 && levels[i - 1].width == 1 && levels[i - 1].height == 1) fault = "the one before is one pixel";
        if (!fault.empty())
            throw Error(ErrorCode::internal, file.string(), fmt::format("level {} cannot be written: {}", i, fault));
    }
}

// The version of the format that can hold all values.
std::uint32_t version_for(const std::filesystem::path& file, std::span<const DeepLevel> levels) {
    std::uint32_t version = unit_version;
    for (const DeepLevel& level : levels)
        for (std::size_t p = 0; p + 1 < level.offsets.size(); ++p)
            for (std::size_t i = std::size_t{level.offsets[p]} + level.nodes(p); i < level.offsets[p + 1]; ++i) {
                const float value = level.floats[i];
                if (value >= unit_least && value <= unit_most) continue;
                version = wide_version;
                if (value >= wide_least && value <= wide_most) continue;
                throw Error(ErrorCode::bad_input, file.string(),
                            fmt::format("pixel {} has the visibility {}, but a file holds only values in [{}, {}]", p,
                                        value, wide_least, wide_most));
            }
    return version;
}

// Appends the words of one tile to `words`.
void append_tile(const DeepLevel& level, int x0, int y0, int x1, int y1, std::vector<std::uint32_t>& words) {
    const std::size_t pixels = static_cast<std::size_t>(x1 - x0) * (y1 - y0), table = words.size();
    words.resize(table + table_words(pixels, level.channels), 0);
    std::size_t p = 0;
    std::uint32_t end = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x, ++p) {
            const std::size_t pixel = level.pixel(x, y);
            if (level.has_colour(pixel)) words[table + pixels + 1 + p / 32] |= 1u << (p % 32);
            end += level.offsets[pixel + 1] - level.offsets[pixel];
            words[table + p + 1] = end;
        }
    const std::size_t floats = words.size();
    words.resize(floats + end);
    for (int y = y0; y < y1; ++y) {  // the functions of a row of pixels lie together
        const std::uint32_t begin = level.offsets[level.pixel(x0, y)];
        const std::uint32_t count = level.offsets[level.pixel(x1 - 1, y) + 1] - begin;
        const std::size_t row = words[table + static_cast<std::size_t>(y - y0) * (x1 - x0)];
        if (count > 0) std::memcpy(&words[floats + row], &level.floats[begin], std::size_t{count} * sizeof(float));
    }
}

template <class T>
void put(std::ostream& stream, const T* values, std::size_t count) {
    stream.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

// Writes the tiles from `offset` on; returns their directory.
std::vector<Entry> put_tiles(std::ostream& stream, std::span<const DeepLevel> levels, int tile_size,
                             std::uint64_t offset, const std::filesystem::path& file) {
    std::vector<Entry> directory;
    std::vector<std::uint32_t> words;
    for (const DeepLevel& level : levels)
        for (int y = 0; y < level.height; y += tile_size)
            for (int x = 0; x < level.width; x += tile_size) {
                words.clear();
                append_tile(level, x, y, std::min(x + tile_size, level.width), std::min(y + tile_size, level.height),
                            words);
                if (words.size() > std::numeric_limits<std::uint32_t>::max())
                    throw Error(ErrorCode::bad_input, file.string(), "a tile has more than 16 GiB; use smaller tiles");
                const std::size_t bytes = words.size() * sizeof(std::uint32_t);
                directory.push_back({offset, static_cast<std::uint32_t>(words.size()), checksum(words.data(), bytes)});
                put(stream, words.data(), words.size());
                offset += bytes;
            }
    return directory;
}

Header make_header(std::span<const DeepLevel> levels, int tile_size, const DeepFileNotes& notes, std::uint32_t version,
                   std::uint64_t file_bytes) {
    Header header{magic,
                  byte_order,
                  version,
                  file_bytes,
                  static_cast<std::uint32_t>(levels[0].width),
                  static_cast<std::uint32_t>(levels[0].height),
                  static_cast<std::uint32_t>(levels[0].channels),
                  static_cast<std::uint32_t>(levels.size()),
                  static_cast<std::uint32_t>(tile_size),
                  static_cast<std::uint32_t>(notes.text.size()),
                  notes.tolerance,
                  notes.z_min,
                  notes.z_max,
                  0};
    header.checksum = header_checksum(header);
    return header;
}

}  // namespace

void write_deep_file(const std::filesystem::path& file, std::span<const DeepLevel> levels, int tile_size,
                     const DeepFileNotes& notes) {
    check(file, levels, tile_size, notes);
    const std::uint32_t version = version_for(file, levels);
    const DeepTiling last =
        tilings(levels[0].width, levels[0].height, static_cast<int>(levels.size()), tile_size).back();
    const std::uint64_t start =
        sizeof(Header) + notes.text.size() + (last.first + last.tiles()) * sizeof(Entry) + sizeof(std::uint32_t);
    base::PendingFile pending(file);
    std::ofstream stream(pending.temporary(), std::ios::binary | std::ios::trunc);
    stream.seekp(static_cast<std::streamoff>(start));
    const std::vector<Entry> directory = put_tiles(stream, levels, tile_size, start, file);
    const std::uint64_t end = directory.back().offset + std::uint64_t{directory.back().words} * 4;
    const Header header = make_header(levels, tile_size, notes, version, end);
    const std::uint32_t sum =
        checksum(directory.data(), directory.size() * sizeof(Entry), checksum(notes.text.data(), notes.text.size()));
    stream.seekp(0);
    put(stream, &header, 1);
    put(stream, notes.text.data(), notes.text.size());
    put(stream, directory.data(), directory.size());
    put(stream, &sum, 1);
    stream.close();
    if (!stream) throw Error(ErrorCode::io, file.string(), "cannot write the file");
    pending.commit();
}

}  // namespace shadowbench::techniques

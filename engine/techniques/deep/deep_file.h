// A deep shadow map as a file of tiles, so that a lookup loads only the tiles that it needs (Lokovic and Veach 2000,
// section 5.4).
//
// The format. All numbers are little-endian; offsets count bytes from the start of the file.
//
//   header, 64 bytes
//        0  8 bytes   53 42 44 53 4d 0d 0a 1a ("SBDSM", then CR LF SUB: shows a transfer as text)
//        8  uint32    0x01020304: the byte order
//       12  uint32    version: 1; 2 if values lie outside [0, 1], as published compression leaves them
//       16  uint64    length of the file in bytes
//       24  uint32 x2 width and height of level 0, pixels
//       32  uint32    channels, 1 or 3
//       36  uint32    levels; each is half the size of the one before it, rounded up
//       40  uint32    tile size: tiles are squares with sides of this many pixels, smaller at the right and upper edge
//       44  uint32    bytes of the text
//       48  float x3  tolerance of level 0, least and largest depth of the scene
//       60  uint32    checksum of bytes 0 to 59
//   text, UTF-8: a description of the map for people
//   directory, 16 bytes for each tile: level after level, row after row
//        0  uint64    offset of the tile; tiles lie in this order without gaps, the first behind the directory
//        8  uint32    words (4 bytes each) of the tile
//       12  uint32    checksum of the tile
//   uint32            checksum of text and directory
//   tiles, each of n pixels, row after row
//        n + 1 uint32 index of each pixel's first float among the tile's floats; last, their number
//        uint32s      3 channels only: bit p % 32 of word p / 32 is set if pixel p holds three channels
//        floats       a function of k nodes: k depths, finite and not decreasing, then k values of each channel that
//                     the pixel holds, in [0, 1]; in version 2 in [-2, 3], the range that twice the largest tolerance
//                     allows
//
// Checksums are the CRC-32 of zlib and PNG (polynomial 0xedb88320).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "techniques/deep/deep_level.h"

namespace shadowbench::techniques {

// What a file holds about its map besides the functions.
struct DeepFileNotes {
    float tolerance = 0.0f;
    float z_min = 0.0f, z_max = 1.0f;
    std::string text;  // at most 64 KiB
};

inline constexpr int max_deep_tile = 1024;  // pixels a side

// Writes level 0 and its mip levels, if any: all of it, or nothing. Throws Error: internal for levels that are
// incomplete or not each half of the one before; bad_input for a tile size outside [1, max_deep_tile], a text that is
// too long, or values outside [-2, 3]; io.
void write_deep_file(const std::filesystem::path& file, std::span<const DeepLevel> levels, int tile_size,
                     const DeepFileNotes& notes);

// One stored function, in memory or in a tile.
struct DeepFunction {
    const float* depths = nullptr;  // `nodes` depths; the values of each channel follow
    std::uint32_t nodes = 0;
    int channels = 1;  // that the pixel holds

    const float* values(int channel) const {
        return depths + static_cast<std::size_t>(channels == 1 ? 1 : 1 + channel) * nodes;
    }
};

// Gives the same bits as curves::evaluate.
float evaluate(const DeepFunction& function, int channel, float z);

// The division of a level into tiles.
struct DeepTiling {
    int width = 0, height = 0;  // pixels
    int tiles_x = 0, tiles_y = 0;
    std::size_t first = 0;  // number of its first tile in the directory

    std::size_t tiles() const { return static_cast<std::size_t>(tiles_x) * tiles_y; }
};

// A file that is open for reading, mapped into memory. All faults of the file are Error{bad_input} whose place is
// "file: byte 17"; a part that can no longer be read, as of a file that was cut after it was opened, is Error{io}.
// Memory is allocated only for what the file is long enough for. Thread-safe.
class DeepFile {
public:
    // Reads and checks header and directory. Throws Error: no_such_file, io, bad_input.
    explicit DeepFile(const std::filesystem::path& file);
    ~DeepFile();
    DeepFile(const DeepFile&) = delete;
    DeepFile& operator=(const DeepFile&) = delete;

    int channels() const { return channels_; }
    int tile_size() const { return tile_size_; }
    std::uint64_t file_bytes() const { return file_bytes_; }
    bool unit_range() const { return unit_range_; }  // all values are in [0, 1]
    const DeepFileNotes& notes() const { return notes_; }
    std::span<const DeepTiling> levels() const { return levels_; }
    std::size_t tiles() const { return directory_.size(); }
    std::size_t tile_bytes(std::size_t tile) const { return std::size_t{directory_[tile].words} * 4; }
    std::size_t bytes() const;  // held: text and directory. Pages of the file that the system keeps do not count.

    // The number of the tile that holds pixel (x, y) of a level.
    std::size_t tile_of(int x, int y, int level) const {
        const DeepTiling& t = levels_[static_cast<std::size_t>(level)];
        return t.first + static_cast<std::size_t>(y / tile_size_) * t.tiles_x + x / tile_size_;
    }
    // The width of that tile in pixels, and the number of its pixels.
    int tile_width(int x, int level) const;
    std::size_t tile_pixels(std::size_t tile) const;

    // Reads a tile as it is in the file, and checks it; `to` has tile_bytes(tile) bytes and the alignment of float.
    // Throws Error: bad_input, io.
    void read_tile(std::size_t tile, std::byte* to) const;
    // Where the tile lies in the mapped file. Reading there is safe only while nobody else can change the file.
    const std::byte* mapped_tile(std::size_t tile) const { return mapped_ + directory_[tile].offset; }

private:
    struct Entry {
        std::uint64_t offset;
        std::uint32_t words, checksum;
    };
    [[noreturn]] void fail(std::uint64_t offset, const std::string& message) const;
    void map_file();
    void close_file();
    void load_pages(std::uint64_t offset, std::size_t bytes) const;
    void read(std::uint64_t offset, void* to, std::size_t bytes) const;
    void read_header();
    void read_directory();
    void check_table(const Entry& entry, std::size_t pixels, const std::byte* tile) const;
    void check_nodes(const Entry& entry, std::size_t pixels, const std::byte* tile) const;

    std::filesystem::path name_;
    int descriptor_ = -1;
    const std::byte* mapped_ = nullptr;
    std::uint64_t file_bytes_ = 0;
    int channels_ = 1, tile_size_ = 1;
    bool unit_range_ = true;
    DeepFileNotes notes_;
    std::uint32_t text_bytes_ = 0;
    std::vector<DeepTiling> levels_;
    std::vector<Entry> directory_;
};

// Pixel `pixel` of a tile of `pixels` pixels, as read by read_tile.
DeepFunction function_of(const std::byte* tile, std::size_t pixels, int channels, std::size_t pixel);

// Every level with the same bits as it was written. Checks every tile. Throws Error: no_such_file, io, bad_input.
std::vector<DeepLevel> read_levels(const DeepFile& file);

}  // namespace shadowbench::techniques

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "base/error.h"
#include "curves/curve.h"
#include "techniques/deep/deep_file.h"
#include "techniques/deep/deep_file_format.h"

namespace shadowbench::techniques {

using base::Error;
using base::ErrorCode;
using namespace deep_format;

namespace {

std::uint32_t word(const std::byte* tile, std::size_t index) {
    std::uint32_t value;
    std::memcpy(&value, tile + index * sizeof value, sizeof value);
    return value;
}

// Says what is impossible about the numbers of a header whose checksum is right; empty if nothing is.
std::string fault_of(const Header& h) {
    const auto side = [](std::uint32_t n) { return n >= 1 && n <= max_side; };
    if (!side(h.width) || !side(h.height)) return fmt::format("a map of {} x {} pixels", h.width, h.height);
    if (h.channels != 1 && h.channels != 3) return fmt::format("{} channels", h.channels);
    if (h.levels < 1 || h.levels > max_levels(h.width, h.height)) return fmt::format("{} levels", h.levels);
    if (h.tile_size < 1 || h.tile_size > max_deep_tile) return fmt::format("tiles of {} pixels a side", h.tile_size);
    if (h.text_bytes > max_text) return fmt::format("a text of {} bytes", h.text_bytes);
    for (const float number : {h.tolerance, h.z_min, h.z_max})
        if (!std::isfinite(number)) return fmt::format("a tolerance or depth of {}", number);
    return "";
}

}  // namespace

DeepFile::DeepFile(const std::filesystem::path& file) : name_(file) {
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0 && (errno == ENOENT || errno == ENOTDIR))
        throw Error(ErrorCode::no_such_file, file.string(), "there is no such file");
    if (descriptor_ < 0)
        throw Error(ErrorCode::io, file.string(), "cannot be opened: " + std::generic_category().message(errno));
    try {
        struct stat facts {};
        if (::fstat(descriptor_, &facts) != 0 || !S_ISREG(facts.st_mode))
            throw Error(ErrorCode::io, file.string(), "only a regular file can be read tile by tile");
        file_bytes_ = static_cast<std::uint64_t>(facts.st_size);
        map_file();
        read_header();
        read_directory();
    } catch (...) {
        close_file();
        throw;
    }
}

DeepFile::~DeepFile() {
    close_file();
}

void DeepFile::map_file() {
    if (file_bytes_ == 0) return;  // nothing can be mapped, and the header will be missed
    void* const at = ::mmap(nullptr, file_bytes_, PROT_READ, MAP_SHARED, descriptor_, 0);
    if (at == MAP_FAILED)
        throw Error(ErrorCode::io, name_.string(),
                    "cannot be mapped into memory: " + std::generic_category().message(errno));
    mapped_ = static_cast<const std::byte*>(at);
}

void DeepFile::close_file() {
    if (mapped_) ::munmap(const_cast<std::byte*>(mapped_), file_bytes_);
    ::close(descriptor_);
}

void DeepFile::fail(std::uint64_t offset, const std::string& message) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: byte {}", name_.string(), offset), message);
}

// A read of a mapped page that cannot be loaded ends the program. So the pages are first loaded by a call that reports
// it; systems without that call only compare the file's length.
void DeepFile::load_pages(std::uint64_t offset, std::size_t bytes) const {
    const auto fail_io = [&](std::uint64_t place, const std::string& message) {
        throw Error(ErrorCode::io, fmt::format("{}: byte {}", name_.string(), place), message);
    };
    int fault = EINVAL;
#ifdef MADV_POPULATE_READ
    const std::uint64_t page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)), first = offset / page * page;
    do {
        const bool loaded = ::madvise(const_cast<std::byte*>(mapped_) + first,
                                      static_cast<std::size_t>(offset + bytes - first), MADV_POPULATE_READ) == 0;
        fault = loaded ? 0 : errno;
    } while (fault == EINTR || fault == EAGAIN);
    if (fault == 0) return;
#endif
    struct stat facts {};
    if (::fstat(descriptor_, &facts) != 0) fail_io(offset, "reading failed: " + std::generic_category().message(errno));
    const auto length = static_cast<std::uint64_t>(facts.st_size);
    if (length < offset + bytes) fail_io(length, "the file ends here; it was longer when it was opened");
    if (fault != EINVAL)  // EFAULT: a read would have ended the program
        fail_io(offset, "reading failed: " + std::generic_category().message(fault == EFAULT ? EIO : fault));
}

void DeepFile::read(std::uint64_t offset, void* to, std::size_t bytes) const {
    if (bytes == 0) return;
    load_pages(offset, bytes);
    std::memcpy(to, mapped_ + offset, bytes);
}

void DeepFile::read_header() {
    Header h;
    if (file_bytes_ < sizeof h) fail(file_bytes_, fmt::format("the file ends inside its header of {} bytes", sizeof h));
    read(0, &h, sizeof h);
    if (h.magic != magic) fail(0, "not a deep shadow map file, or one damaged by a transfer as text");
    if (h.byte_order != byte_order) fail(offsetof(Header, byte_order), "the byte order is not little-endian");
    if (h.version != unit_version && h.version != wide_version)
        fail(offsetof(Header, version), fmt::format("version {} of the format is not supported; versions {} and {} are",
                                                    h.version, unit_version, wide_version));
    if (h.checksum != header_checksum(h))
        fail(offsetof(Header, checksum), "the header is damaged: its checksum differs");
    if (const std::string fault = fault_of(h); !fault.empty())
        fail(offsetof(Header, width), fmt::format("the header states {}", fault));
    if (h.file_bytes != file_bytes_)
        fail(file_bytes_, fmt::format("the file has {} bytes but its header states {}: it was cut, or something "
                                      "was appended",
                                      file_bytes_, h.file_bytes));
    unit_range_ = h.version == unit_version;
    channels_ = static_cast<int>(h.channels);
    tile_size_ = static_cast<int>(h.tile_size);
    text_bytes_ = h.text_bytes;
    notes_.tolerance = h.tolerance;
    notes_.z_min = h.z_min;
    notes_.z_max = h.z_max;
    levels_ = tilings(static_cast<int>(h.width), static_cast<int>(h.height), static_cast<int>(h.levels), tile_size_);
}

void DeepFile::read_directory() {
    static_assert(sizeof(Entry) == 16);
    const std::uint64_t tiles = levels_.back().first + levels_.back().tiles();
    const std::uint64_t fixed = sizeof(Header) + text_bytes_ + sizeof(std::uint32_t);
    if (fixed > file_bytes_ || tiles > (file_bytes_ - fixed) / sizeof(Entry))
        fail(file_bytes_, fmt::format("the file ends inside its directory of {} tiles", tiles));
    const std::uint64_t start = sizeof(Header) + text_bytes_, end = start + tiles * sizeof(Entry);
    notes_.text.resize(text_bytes_);
    read(sizeof(Header), notes_.text.data(), text_bytes_);
    directory_.resize(tiles);
    read(start, directory_.data(), tiles * sizeof(Entry));
    std::uint32_t stored;
    read(end, &stored, sizeof stored);
    if (stored != checksum(directory_.data(), tiles * sizeof(Entry), checksum(notes_.text.data(), text_bytes_)))
        fail(end, "the text or the directory is damaged: their checksum differs");

    std::uint64_t next = end + sizeof stored;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        const std::uint64_t at = start + tile * sizeof(Entry);
        if (directory_[tile].offset != next)
            fail(at, fmt::format("tile {} begins at byte {}, but the one before ends at {}", tile,
                                 directory_[tile].offset, next));
        if (directory_[tile].words < table_words(tile_pixels(tile), channels_) ||
            directory_[tile].words > (file_bytes_ - next) / 4)
            fail(at, fmt::format("tile {} has the impossible size of {} words", tile, directory_[tile].words));
        next += std::uint64_t{directory_[tile].words} * 4;
    }
    if (next != file_bytes_) fail(next, fmt::format("the last tile ends here, but the file at byte {}", file_bytes_));
}

std::size_t DeepFile::bytes() const {
    return notes_.text.capacity() + levels_.capacity() * sizeof(DeepTiling) + directory_.capacity() * sizeof(Entry);
}

int DeepFile::tile_width(int x, int level) const {
    return std::min(tile_size_, levels_[static_cast<std::size_t>(level)].width - x / tile_size_ * tile_size_);
}

std::size_t DeepFile::tile_pixels(std::size_t tile) const {
    const auto above = std::upper_bound(levels_.begin(), levels_.end(), tile,
                                        [](std::size_t number, const DeepTiling& t) { return number < t.first; });
    const DeepTiling& t = *(above - 1);
    const int x = static_cast<int>((tile - t.first) % t.tiles_x) * tile_size_;
    const int y = static_cast<int>((tile - t.first) / t.tiles_x) * tile_size_;
    return static_cast<std::size_t>(std::min(tile_size_, t.width - x)) * std::min(tile_size_, t.height - y);
}

void DeepFile::check_table(const Entry& entry, std::size_t pixels, const std::byte* tile) const {
    const std::size_t floats = entry.words - table_words(pixels, channels_);
    std::uint32_t begin = word(tile, 0);
    if (begin != 0) fail(entry.offset, fmt::format("the tile's first pixel begins at float {}", begin));
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::uint32_t end = word(tile, p + 1);
        const std::uint32_t node = channels_ == 3 && (word(tile, pixels + 1 + p / 32) >> (p % 32) & 1) != 0 ? 4 : 2;
        if (end < begin || end > floats || (end - begin) % node != 0)
            fail(entry.offset + (p + 1) * 4,
                 fmt::format("pixel {} of the tile has the floats {} to {} of {}, {} a node", p, begin, end, floats,
                             node));
        begin = end;
    }
    if (begin != floats)
        fail(entry.offset + pixels * 4, fmt::format("the tile has {} floats, but its pixels have {}", floats, begin));
}

// Lookups search the depths and join the values, and must not leave the range of the version.
void DeepFile::check_nodes(const Entry& entry, std::size_t pixels, const std::byte* tile) const {
    const auto* first = reinterpret_cast<const float*>(tile);
    const float least = unit_range_ ? unit_least : wide_least, most = unit_range_ ? unit_most : wide_most;
    const auto place = [&](const float& number) {
        return entry.offset + static_cast<std::uint64_t>(&number - first) * 4;
    };
    for (std::size_t p = 0; p < pixels; ++p) {
        const DeepFunction f = function_of(tile, pixels, channels_, p);
        float before = std::numeric_limits<float>::lowest();
        for (const float& depth : std::span(f.depths, f.nodes)) {
            if (!(depth >= before && depth <= std::numeric_limits<float>::max()))
                fail(place(depth), fmt::format("pixel {} of the tile has the depth {} behind {}; depths are finite and "
                                               "do not decrease",
                                               p, depth, before));
            before = depth;
        }
        for (const float& value : std::span(f.depths + f.nodes, std::size_t{f.nodes} * f.channels))
            if (!(value >= least && value <= most))
                fail(place(value), fmt::format("pixel {} of the tile has the visibility {}, which is not in [{}, {}]",
                                               p, value, least, most));
    }
}

void DeepFile::read_tile(std::size_t tile, std::byte* to) const {
    const Entry& entry = directory_[tile];
    read(entry.offset, to, tile_bytes(tile));
    if (checksum(to, tile_bytes(tile)) != entry.checksum)
        fail(entry.offset, fmt::format("tile {} of {} bytes is damaged: its checksum differs", tile, tile_bytes(tile)));
    check_table(entry, tile_pixels(tile), to);
    check_nodes(entry, tile_pixels(tile), to);
}

DeepFunction function_of(const std::byte* tile, std::size_t pixels, int channels, std::size_t pixel) {
    const std::uint32_t begin = word(tile, pixel), end = word(tile, pixel + 1);
    const bool coloured = channels == 3 && (word(tile, pixels + 1 + pixel / 32) >> (pixel % 32) & 1) != 0;
    const auto* floats = reinterpret_cast<const float*>(tile + table_words(pixels, channels) * sizeof(float));
    return {floats + begin, (end - begin) / (coloured ? 4 : 2), coloured ? 3 : 1};
}

float evaluate(const DeepFunction& function, int channel, float z) {
    const std::uint32_t n = function.nodes;
    if (n == 0) return 1.0f;
    const float* depths = function.depths;
    const float* values = function.values(channel);
    const std::size_t next = static_cast<std::size_t>(std::lower_bound(depths, depths + n, z) - depths);
    if (next == 0) return values[0];
    if (next == n) return values[n - 1];
    return curves::join({depths[next - 1], values[next - 1]}, {depths[next], values[next]}, z);
}

}  // namespace shadowbench::techniques

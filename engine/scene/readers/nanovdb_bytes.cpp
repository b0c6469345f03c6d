#include "scene/readers/nanovdb_bytes.h"

#include <blosc.h>

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace shadowbench::scene {
namespace {

constexpr std::uint64_t most_chunk = std::uint64_t{1} << 30;  // unpacked
constexpr std::uint64_t block_bytes = 32;                     // of the window
constexpr std::uint64_t most_at_once = std::uint64_t{1} << 19;

// A chunk of BLOSC (README_CHUNK_FORMAT.rst of c-blosc 1): a head of 16 bytes, the start of each block, and the blocks,
// in any order.
constexpr std::size_t head_bytes = 16, start_bytes = 4;
constexpr std::size_t flags_at = 2, unpacked_at = 4, block_at = 8, packed_at = 12;
// The library that writes these files asks for blocks of 256 KiB. Many small ones would cost time, large ones memory.
constexpr std::size_t usual_block = std::size_t{1} << 18, least_block = usual_block >> 6, most_block = usual_block << 6;
constexpr std::uint8_t flag_copied = 0x2,
                       flag_whole = 0x10;  // whole: a block is not split into the bytes of its values
// Beyond its values, a packed block has the sizes of its parts, at most one for each byte of a value.
constexpr std::size_t most_extra = 255 * start_bytes;

void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t number) {
    const auto value = static_cast<std::uint32_t>(number);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

BloscBytes::BloscBytes(FileReader& file, const NanoVdbGrid& grid)
    : file_(file), size_(grid.size), begins_{grid.begin} {}

void BloscBytes::damaged() const {
    file_.fail(begins_[chunk_->number],
               fmt::format("the file is damaged: {} bytes are not packed here by BLOSC", chunk_->unpacked));
}

void BloscBytes::read(std::uint64_t from, std::span<std::uint8_t> to) {
    while (!to.empty()) {
        if (const std::uint64_t number = from / most_chunk; !chunk_ || chunk_->number != number) open_chunk(number);
        const auto in_chunk = static_cast<std::size_t>(from % most_chunk);
        const std::size_t number = in_chunk / chunk_->block, first = in_chunk % chunk_->block;
        if (block_number_ != number) open_block(number);
        const std::size_t count = std::min(to.size(), block_.size() - first);
        std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>(first), count, to.begin());
        from += count;
        to = to.subspan(count);
    }
}

// The number of its bytes stands in front of each chunk.
void BloscBytes::open_chunk(std::uint64_t number) {
    block_number_.reset();
    while (begins_.size() <= number + 1) {
        file_.seek(begins_.back(), "packed grid");
        const auto packed = file_.value<std::uint64_t>("packed grid");
        file_.need(packed, 1, "packed grid");
        begins_.push_back(file_.position() + packed);
    }
    chunk_.emplace();
    Chunk& chunk = *chunk_;
    chunk.number = number;
    chunk.begin = begins_[number] + sizeof(std::uint64_t);
    chunk.packed = begins_[number + 1] - chunk.begin;
    chunk.unpacked = static_cast<std::size_t>(std::min(most_chunk, size_ - number * most_chunk));
    if (chunk.packed < head_bytes) damaged();
    file_.seek(chunk.begin, "packed grid");
    chunk.head = file_.value<std::array<std::uint8_t, head_bytes>>("packed grid");
    std::size_t unpacked = 0, packed = 0;
    blosc_cbuffer_sizes(chunk.head.data(), &unpacked, &packed, &chunk.block);
    if (unpacked != chunk.unpacked || packed != chunk.packed) damaged();
    chunk.copied = chunk.head[flags_at] & flag_copied;
    if (chunk.copied) {
        if (packed != unpacked + head_bytes) damaged();
        chunk.block = std::min(unpacked, usual_block);
        return;
    }
    if (chunk.block < std::min(unpacked, least_block) || chunk.block > std::min(unpacked, most_block)) damaged();
    const std::size_t blocks = (unpacked - 1) / chunk.block + 1;
    if (blocks > (chunk.packed - head_bytes) / start_bytes) damaged();
    chunk.starts = file_.array<std::uint32_t>(blocks, "packed grid");
    for (const std::uint32_t start : chunk.starts)
        if (start < head_bytes + blocks * start_bytes || start >= chunk.packed) damaged();
}

// A block becomes a chunk of its own, which the library unpacks.
void BloscBytes::open_block(std::size_t number) {
    const Chunk& chunk = *chunk_;
    const std::size_t first = number * chunk.block, unpacked = std::min(chunk.block, chunk.unpacked - first);
    block_number_.reset();
    if (chunk.copied) {
        file_.seek(chunk.begin + head_bytes + first, "packed grid");
        block_ = file_.array<std::uint8_t>(unpacked, "packed grid");
        block_number_ = number;
        return;
    }
    const std::size_t start = chunk.starts[number], begin = head_bytes + start_bytes;
    const std::size_t packed = std::min<std::size_t>(chunk.packed - start, unpacked + most_extra);
    file_.seek(chunk.begin + start, "packed grid");
    const std::vector<std::uint8_t> bytes = file_.array<std::uint8_t>(packed, "packed grid");
    packed_.resize(begin);
    std::copy(chunk.head.begin(), chunk.head.end(), packed_.begin());
    // The library never splits the last block of a chunk if it is smaller than the others.
    if (unpacked < chunk.block) packed_[flags_at] = static_cast<std::uint8_t>(packed_[flags_at] | flag_whole);
    packed_.insert(packed_.end(), bytes.begin(), bytes.end());
    put(packed_, unpacked_at, unpacked);
    put(packed_, block_at, unpacked);
    put(packed_, packed_at, packed_.size());
    put(packed_, head_bytes, begin);
    block_.resize(unpacked);
    std::size_t known = 0;
    const bool sound = blosc_cbuffer_validate(packed_.data(), packed_.size(), &known) == 0 && known == unpacked &&
                       blosc_decompress_ctx(packed_.data(), block_.data(), unpacked, 1) == static_cast<int>(unpacked);
    if (!sound) damaged();
    block_number_ = number;
}

NanoVdbBytes::NanoVdbBytes(FileReader& file, const NanoVdbGrid& grid) : file_(file), grid_(grid) {
    if (grid.codec == NanoVdbCodec::blosc) blosc_.emplace(file, grid);
}

const std::byte* NanoVdbBytes::at(std::uint64_t place, std::uint64_t bytes) {
    const auto found = [&] { return reinterpret_cast<const std::byte*>(window() + (place - begin_)); };
    if (place >= begin_ && place + bytes <= end_) return found();
    const std::uint64_t from = place / block_bytes * block_bytes;
    const std::uint64_t to = std::min(grid_.size, std::max(place + bytes, from + most_at_once));
    // What the window has of it stays.
    const std::uint64_t kept = from >= begin_ && from < end_ ? end_ - from : 0;
    if (kept > 0) std::memmove(window(), window() + (from - begin_), static_cast<std::size_t>(kept));
    begin_ = from;
    end_ = from + kept;
    const auto blocks = static_cast<std::size_t>((to - from + block_bytes - 1) / block_bytes);
    if (blocks > blocks_.size()) blocks_.resize(blocks);
    read(end_, std::span(window() + kept, static_cast<std::size_t>(to - end_)));
    end_ = to;
    return found();
}

void NanoVdbBytes::read(std::uint64_t from, std::span<std::uint8_t> to) {
    if (blosc_) return blosc_->read(from, to);
    const bool zip = grid_.codec == NanoVdbCodec::zip;
    if (!stream_ || from < stream_->position()) {
        // The packed bytes follow their number.
        stream_.emplace(file_, grid_.begin + (zip ? sizeof(std::uint64_t) : 0), zip ? Packing::deflate : Packing::none);
    }
    stream_->pass(from - stream_->position(), "grid");
    stream_->read(to, "grid");
}

}  // namespace shadowbench::scene

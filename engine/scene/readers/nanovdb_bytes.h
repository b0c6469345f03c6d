// The bytes of a grid of a .nvdb file, a part at a time: a window of it is held, and one block of what BLOSC packed.
// What lies behind the last part that is asked for is not read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/readers/file_reader.h"
#include "scene/readers/nanovdb_file.h"
#include "scene/readers/unpacked_bytes.h"

namespace shadowbench::scene {

// Bytes that are packed by BLOSC: chunks of 1 GiB, each of blocks that are packed one by one.
class BloscBytes {
public:
    BloscBytes(FileReader& file, const NanoVdbGrid& grid);

    void read(std::uint64_t from, std::span<std::uint8_t> to);

private:
    struct Chunk {
        std::uint64_t number = 0, begin = 0, packed = 0;  // begin, packed: of its bytes in the file
        std::size_t unpacked = 0, block = 0;              // bytes in all, and of a block; the last may be smaller
        std::array<std::uint8_t, 16> head{};
        bool copied = false;                // not packed
        std::vector<std::uint32_t> starts;  // of the blocks, from `begin` on
    };

    void open_chunk(std::uint64_t number);
    void open_block(std::size_t number);
    [[noreturn]] void damaged() const;

    FileReader& file_;
    std::uint64_t size_;                 // of all bytes, unpacked
    std::vector<std::uint64_t> begins_;  // of the chunks seen so far, and of the next
    std::optional<Chunk> chunk_;
    std::optional<std::size_t> block_number_;  // in the chunk
    std::vector<std::uint8_t> block_, packed_;
};

class NanoVdbBytes {
public:
    // Keeps references to both.
    NanoVdbBytes(FileReader& file, const NanoVdbGrid& grid);

    std::uint64_t size() const { return grid_.size; }

    // The `bytes` bytes from `place` on, which must be there. They lie at a multiple of 32 bytes if `place` is one, and
    // until the next call. To go on is cheap; to go back means to unpack from the front again, unless it is by little.
    const std::byte* at(std::uint64_t place, std::uint64_t bytes);

private:
    // Structures of NanoVDB lie at multiples of 32 bytes.
    struct alignas(32) Block {
        std::array<std::byte, 32> bytes;
    };

    std::uint8_t* window() { return reinterpret_cast<std::uint8_t*>(blocks_.data()); }
    void read(std::uint64_t from, std::span<std::uint8_t> to);

    FileReader& file_;
    const NanoVdbGrid& grid_;
    std::optional<UnpackedBytes> stream_;  // unless it is packed by BLOSC
    std::optional<BloscBytes> blosc_;
    std::vector<Block> blocks_;          // hold the window
    std::uint64_t begin_ = 0, end_ = 0;  // of the window, in the grid
};

}  // namespace shadowbench::scene

#include "scene/readers/bit_runs.h"

#include <algorithm>

#include <fmt/format.h>

namespace shadowbench::scene {
namespace {

constexpr int group_bits = 2, row_bits = 16, length_bits = 7, width_bits = 3;

// Bits behind the end are 0.
class Bits {
public:
    explicit Bits(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint64_t position() const { return 8 * next_ - static_cast<std::uint64_t>(held_); }
    std::uint64_t size() const { return 8 * static_cast<std::uint64_t>(bytes_.size()); }

    void seek(std::uint64_t bit) {
        next_ = bit / 8;
        held_ = 0;
        take(static_cast<int>(bit % 8));
    }

    // At most 16 bits.
    unsigned take(int count) {
        while (held_ < count) {
            held_bits_ = (held_bits_ << 8) | (next_ < bytes_.size() ? bytes_[next_] : 0u);
            ++next_;
            held_ += 8;
        }
        held_ -= count;
        return (held_bits_ >> held_) & ((1u << count) - 1u);
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::uint64_t next_ = 0;       // byte
    std::uint32_t held_bits_ = 0;  // the lowest `held_` bits are still to be taken
    int held_ = 0;
};

struct Run {
    unsigned length;
    int width;  // bits of a value
};

Run next_run(Bits& bits) {
    const unsigned length = bits.take(length_bits);
    if (length == 0) return {0, 0};
    const auto width = static_cast<int>(bits.take(width_bits));
    return {length, width == 0 ? 0 : width + 1};
}

// The number of bytes in all runs from the current position on.
std::uint64_t count_bytes(const FileReader& file, Bits bits, std::uint64_t begin, std::uint64_t most_bytes) {
    std::uint64_t total = 0;
    for (Run run = next_run(bits); run.length > 0; run = next_run(bits)) {
        const std::uint64_t start = bits.position();
        const std::uint64_t end = start + std::uint64_t{run.length} * static_cast<std::uint64_t>(run.width);
        if (end > bits.size()) file.fail(file.size(), "the file is cut short: it ends inside a run of values");
        total += run.length;
        if (total > most_bytes)
            file.fail(begin + start / 8, fmt::format("it unpacks to more than {} bytes, the limit", most_bytes));
        bits.seek(end);
    }
    return total;
}

void sort_back(std::vector<std::uint8_t>& bytes, std::size_t group, std::size_t block) {
    std::vector<std::uint8_t> part;
    for (std::size_t first = 0; first < bytes.size(); first += block) {
        const std::size_t count = std::min(block, bytes.size() - first);
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(first);
        part.assign(from, from + static_cast<std::ptrdiff_t>(count));
        std::size_t next = 0;
        for (std::size_t member = 0; member < group; ++member)
            for (std::size_t i = member; i < count; i += group) bytes[first + i] = part[next++];
    }
}

}  // namespace

std::vector<std::uint8_t> unpack_bit_runs(const FileReader& file, std::span<const std::uint8_t> packed,
                                          std::uint64_t begin, std::size_t block_groups, std::uint64_t most_bytes) {
    Bits bits(packed);
    if (bits.size() < group_bits + row_bits) file.fail(file.size(), "the file is cut short: it ends before its values");
    const std::size_t group = bits.take(group_bits) + 1, row = bits.take(row_bits) + 1;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count_bytes(file, bits, begin, most_bytes)));

    std::size_t i = 0;
    int before = 0;
    for (Run run = next_run(bits); run.length > 0; run = next_run(bits)) {
        const int half = (1 << run.width) / 2;
        for (unsigned n = 0; n < run.length; ++n, ++i) {
            int value = before + static_cast<int>(bits.take(run.width)) - half;
            if (row > 1 && i > row) value += bytes[i - row] - bytes[i - row - 1];
            bytes[i] = static_cast<std::uint8_t>(value & 0xff);
            before = bytes[i];
        }
    }
    if (group > 1) sort_back(bytes, group, block_groups == 0 ? bytes.size() : group * block_groups);
    return bytes;
}

}  // namespace shadowbench::scene

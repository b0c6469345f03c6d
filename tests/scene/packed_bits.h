// Packs bytes as engine/scene/readers/bit_runs.h describes, for tests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace shadowbench::scene::test {

// Appends bits, from the highest of each byte down; whole bytes come out.
class BitWriter {
public:
    void put(unsigned value, int count) {
        for (int bit = count - 1; bit >= 0; --bit) {
            byte_ = byte_ * 2 + (value >> bit & 1u);
            if (++held_ < 8) continue;
            bytes_ += static_cast<char>(byte_);
            byte_ = 0;
            held_ = 0;
        }
    }
    // "0101" and spaces.
    void put(const std::string& bits) {
        for (const char bit : bits)
            if (bit != ' ') put(bit == '1' ? 1u : 0u, 1);
    }
    std::string finish() {
        while (held_ > 0) put(0, 1);
        return bytes_;
    }

private:
    std::string bytes_;
    unsigned byte_ = 0;
    int held_ = 0;
};

// Every byte in the narrowest run that holds it; runs of one width are joined. The first bytes of all groups come
// first, for `block_groups` groups at a time (0: all).
inline std::string pack_bits(const std::string& bytes, unsigned group, unsigned row, std::size_t block_groups = 0) {
    std::string sorted;
    const std::size_t block = block_groups == 0 ? bytes.size() : group * block_groups;
    for (std::size_t first = 0; first < bytes.size(); first += block)
        for (unsigned member = 0; member < group; ++member)
            for (std::size_t i = first + member; i < std::min(first + block, bytes.size()); i += group)
                sorted += bytes[i];

    BitWriter out;
    out.put(group - 1, 2);
    out.put(row - 1, 16);
    const auto byte = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(sorted[i])); };
    std::vector<int> differences, widths;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        int prediction = i > 0 ? byte(i - 1) : 0;
        if (row > 1 && i > row) prediction += byte(i - row) - byte(i - row - 1);
        const int difference = ((byte(i) - prediction + 128) % 256 + 256) % 256 - 128;
        int width = 0;
        if (difference != 0)
            for (width = 2; difference < -(1 << width) / 2 || difference >= (1 << width) / 2;) ++width;
        differences.push_back(difference);
        widths.push_back(width);
    }
    for (std::size_t i = 0; i < sorted.size();) {
        std::size_t end = i;
        while (end < sorted.size() && widths[end] == widths[i] && end - i < 127) ++end;
        out.put(static_cast<unsigned>(end - i), 7);
        out.put(static_cast<unsigned>(widths[i] == 0 ? 0 : widths[i] - 1), 3);
        for (; i < end; ++i) out.put(static_cast<unsigned>(differences[i] + (1 << widths[i]) / 2), widths[i]);
    }
    return out.finish();
}

}  // namespace shadowbench::scene::test

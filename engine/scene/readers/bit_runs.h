// Bytes packed as runs of differences, the encoding of published .pvm volumes. Its files begin with "DDS v3d" or
// "DDS v3e" ("differential data stream"); they are not DDS textures. Bits are read from the highest of each byte down:
//
//   2 bits    g - 1: bytes of a group, as the two bytes of a voxel of 16 bits
//   16 bits   r - 1: bytes of a row
//   runs:     7 bits  number of bytes in the run; 0 ends the stream, as the end of the file does
//             3 bits  w: each value of the run has 0 bits if w is 0, else w + 1
//             values  each gives one byte: prediction + value - half of the values' range, modulo 256
//
// The prediction is the byte before (0 for the first). From byte r + 1 on, the difference of the byte r before to its
// own predecessor is added; not if r is 1. The bytes are then sorted back: the stream holds first the first bytes of
// all groups, then their second bytes, and so on; in a v3e stream, for 2^24 groups at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/readers/file_reader.h"

namespace shadowbench::scene {

// Unpacks a stream, `packed`, that begins at byte `begin` of the file and fills the rest of it. Groups are sorted back
// `block_groups` at a time, or all together if that is 0. Throws Error{bad_input} if the file ends inside a run, and,
// before it allocates anything, if there are more than `most_bytes`.
std::vector<std::uint8_t> unpack_bit_runs(const FileReader& file, std::span<const std::uint8_t> packed,
                                          std::uint64_t begin, std::size_t block_groups, std::uint64_t most_bytes);

}  // namespace shadowbench::scene

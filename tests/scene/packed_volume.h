// Bytes packed by zlib, for files of tests.
#pragma once

#include <zlib.h>

#include <gtest/gtest.h>

#include <string>

namespace shadowbench::scene::test {

// `window` is zlib's windowBits: 15 makes a zlib stream, 16 + 15 a gzip file, -15 bare deflate.
inline std::string packed(const std::string& bytes, int window) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::string from = bytes, to(deflateBound(&stream, static_cast<uLong>(bytes.size())) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(from.data());
    stream.avail_in = static_cast<uInt>(from.size());
    stream.next_out = reinterpret_cast<Bytef*>(to.data());
    stream.avail_out = static_cast<uInt>(to.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    to.resize(to.size() - stream.avail_out);
    deflateEnd(&stream);
    return to;
}

}  // namespace shadowbench::scene::test

#include "service/api/gunzip.h"

#include <zlib.h>

#include "base/error.h"

namespace shadowbench::service {

std::string gunzip(std::string_view compressed) {
    z_stream stream{};
    constexpr int gzip_alone = 15 + 16;
    if (inflateInit2(&stream, gzip_alone) != Z_OK) throw base::Error(base::ErrorCode::internal, "gunzip", "no memory");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));  // is only read
    stream.avail_in = static_cast<uInt>(compressed.size());
    std::string out;
    char piece[65536];
    int state = Z_OK;
    while (state == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(piece);
        stream.avail_out = sizeof piece;
        state = inflate(&stream, Z_NO_FLUSH);
        out.append(piece, sizeof piece - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END) throw base::Error(base::ErrorCode::internal, "gunzip", "broken data");
    return out;
}

}  // namespace shadowbench::service

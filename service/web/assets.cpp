#include "service/web/assets.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <zlib.h>

#include "base/error.h"

namespace {

// A row of the table in assets.s.
struct Row {
    const char *path, *type, *content;
    std::uint64_t size, gzip;
    const char* etag;
};

}  // namespace

extern "C" {
extern const Row shadowbench_web_assets[];
extern const std::uint64_t shadowbench_web_asset_count;
}

namespace shadowbench::service {

std::span<const Asset> assets() {
    static const std::vector<Asset> all = [] {
        std::vector<Asset> result;
        for (std::uint64_t i = 0; i < shadowbench_web_asset_count; ++i) {
            const Row& row = shadowbench_web_assets[i];
            result.push_back({row.path, row.type, {row.content, row.size}, row.gzip != 0, row.etag});
        }
        return result;
    }();
    return all;
}

const Asset* find_asset(std::string_view path) {
    const auto all = assets();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Asset& asset) { return asset.path == path; });
    return found == all.end() ? nullptr : &*found;
}

std::string text_of(const Asset& asset) {
    if (!asset.gzip) return std::string(asset.content);
    constexpr int only_gzip = 16;  // added to the window bits: zlib then expects gzip
    z_stream stream{};
    if (inflateInit2(&stream, MAX_WBITS + only_gzip) != Z_OK)
        throw base::Error(base::ErrorCode::internal, asset.path, "cannot be decompressed");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(asset.content.data()));
    stream.avail_in = static_cast<uInt>(asset.content.size());
    std::string text;
    std::vector<char> block(std::size_t{1} << 16);
    int state = Z_OK;
    while (state == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(block.data());
        stream.avail_out = static_cast<uInt>(block.size());
        state = inflate(&stream, Z_NO_FLUSH);
        text.append(block.data(), block.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END) throw base::Error(base::ErrorCode::internal, asset.path, "cannot be decompressed");
    return text;
}

}  // namespace shadowbench::service

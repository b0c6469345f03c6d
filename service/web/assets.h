// The files of the page. build.mjs makes them from page/ at build time, and the program holds them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shadowbench::service {

struct Asset {
    std::string_view path, type;  // "/assets/app.js", "text/javascript; charset=utf-8"
    std::string_view content;
    bool gzip;              // the content is compressed with gzip
    std::string_view etag;  // strong, of the content, with its quotes
};

std::span<const Asset> assets();

// The file of this path; "/" is the page. Null where there is none.
const Asset* find_asset(std::string_view path);

// The decompressed content.
std::string text_of(const Asset& asset);

}  // namespace shadowbench::service

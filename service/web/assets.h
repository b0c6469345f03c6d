// The page's files, made from page/ at build time (build.mjs) and held by the program.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shadowbench::service {

struct Asset {
    std::string_view path, type;  // "/assets/app.js", "text/javascript; charset=utf-8"
    std::string_view content;
    bool gzip;              // the content is compressed with gzip
    std::string_view etag;  // a strong one, of the content, in its quotes
};

std::span<const Asset> assets();

// "/" is the page. Null: there is none.
const Asset* find_asset(std::string_view path);

// The content, decompressed where it is compressed.
std::string text_of(const Asset& asset);

}  // namespace shadowbench::service

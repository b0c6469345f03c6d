// The page's files, embedded.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shadowbench::service {

struct Asset {
    std::string_view path, type;
    std::string_view content;
    bool gzip;  // the content is compressed
    std::string_view etag;
};

std::span<const Asset> assets();

// "/" is the page. Null: there is none.
const Asset* find_asset(std::string_view path);

// The content, decompressed where it is compressed.
std::string text_of(const Asset& asset);

}  // namespace shadowbench::service

#include "service/web/assets.h"

namespace shadowbench::service {
namespace {

constexpr Asset page[] = {{"/", "text/html; charset=utf-8",
                           "<!doctype html><html lang=\"en\"><title>shadowbench</title><h1>shadowbench</h1>"
                           "<p>See <a href=\"/openapi.json\">/openapi.json</a>.</p></html>\n",
                           false, "\"page-1\""}};

}  // namespace

std::span<const Asset> assets() {
    return page;
}

const Asset* find_asset(std::string_view path) {
    for (const Asset& asset : page)
        if (asset.path == path) return &asset;
    return nullptr;
}

std::string text_of(const Asset& asset) {
    return std::string(asset.content);
}

}  // namespace shadowbench::service

// GET / and /assets: the page and its files, which the program holds.
#include <cstddef>
#include <string>
#include <string_view>

#include "base/hash_text.h"
#include "service/api/accept.h"
#include "service/api/problem.h"
#include "service/api/routes.h"
#include "service/web/assets.h"

namespace shadowbench::service {
namespace {

// The page loads files only from this server and runs no inline scripts.
constexpr const char* page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-src 'self'; frame-ancestors 'none'";

// The page and its scripts name their files and the API from the root of the host. Behind a proxy these paths begin
// with its prefix.
std::string relocated(std::string text, const std::string& prefix) {
    for (std::size_t at = 0; (at = text.find_first_of("\"'`", at)) != std::string::npos; ++at) {
        const std::string_view path = std::string_view(text).substr(at + 1);
        if (!path.starts_with("/assets/") && !path.starts_with("/v1/")) continue;
        text.insert(at + 1, prefix);
        at += prefix.size();
    }
    return text;
}

bool names_paths(const Asset& asset) {
    const std::string type(asset.type);
    return type.starts_with("text/html") || type.starts_with("text/javascript");
}

ApiResponse asset_answer(const ApiRequest& request, const std::string& path) {
    const Asset* asset = find_asset(path);
    if (!asset) return problem(404, "There is no such file.");
    const bool moved = !request.prefix.empty() && names_paths(*asset);
    std::string etag(asset->etag);
    if (moved) etag.insert(etag.size() - 1, "-" + base::hash_text(request.prefix));
    ApiResponse response;
    response.type = asset->type;
    response.headers = {{"ETag", etag},
                        {"Cache-Control", "private, no-cache"},
                        {"Vary", "Accept-Encoding"},
                        {"Content-Security-Policy", page_policy}};
    if (has_version(request, etag)) {
        response.status = 304;
        response.type.clear();
        return response;
    }
    if (moved) {
        response.body = relocated(text_of(*asset), request.prefix);
        return response;
    }
    if (asset->gzip) {
        if (!accepts_gzip(request)) {
            response.body = text_of(*asset);
            return response;
        }
        response.headers.push_back({"Content-Encoding", "gzip"});
    }
    response.body = asset->content;
    return response;
}

}  // namespace

ApiResponse get_page(Context&, const Call& call) {
    return asset_answer(call.request, "/");
}

ApiResponse get_asset(Context&, const Call& call) {
    return asset_answer(call.request, "/assets/" + call.parameter("name"));
}

}  // namespace shadowbench::service

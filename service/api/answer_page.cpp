// GET / and /assets: the page and its files, which the program holds.
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

ApiResponse asset_answer(const ApiRequest& request, const std::string& path) {
    const Asset* asset = find_asset(path);
    if (!asset) return problem(404, "There is no such file.");
    ApiResponse response;
    response.type = asset->type;
    response.headers = {{"ETag", std::string(asset->etag)},
                        {"Cache-Control", "private, no-cache"},
                        {"Vary", "Accept-Encoding"},
                        {"Content-Security-Policy", page_policy}};
    if (has_version(request, std::string(asset->etag))) {
        response.status = 304;
        response.type.clear();
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

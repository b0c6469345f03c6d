#include "service/http/prefix.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace shadowbench::service {
namespace {

constexpr std::size_t longest_prefix = 200;

bool is_segment(std::string_view text) {
    return !text.empty() && text != "." && text != ".." && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
               c == '_' || c == '~';
    });
}

// Nothing for a text that is no prefix.
std::optional<std::vector<std::string>> prefix_segments(std::string_view path) {
    if (path.empty() || path[0] != '/' || path.size() > longest_prefix) return std::nullopt;
    std::vector<std::string> segments;
    while (!path.empty()) {
        path.remove_prefix(1);
        const std::string_view segment = path.substr(0, path.find('/'));
        if (!is_segment(segment)) return std::nullopt;
        segments.emplace_back(segment);
        path.remove_prefix(segment.size());
    }
    return segments;
}

}  // namespace

bool is_prefix(const std::string& path) {
    return prefix_segments(path).has_value();
}

std::optional<ApiResponse> take_prefix(ApiRequest& request, const std::string& base_path) {
    const std::string* forwarded = request.header("x-forwarded-prefix");
    request.prefix = forwarded && is_prefix(*forwarded) ? *forwarded : base_path;
    const auto base = prefix_segments(base_path);
    if (!base || request.path.size() < base->size() || !std::equal(base->begin(), base->end(), request.path.begin()))
        return std::nullopt;
    request.path.erase(request.path.begin(), request.path.begin() + static_cast<std::ptrdiff_t>(base->size()));
    if (!request.path.empty()) return std::nullopt;
    request.path = {""};
    ApiResponse response;
    response.status = 308;
    response.headers.push_back({"Location", base_path + "/"});
    return response;
}

}  // namespace shadowbench::service

#include "service/api/accept.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

namespace shadowbench::service {
namespace {

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t end = std::min(text.find(at, from), text.size());
        parts.push_back(trimmed(text.substr(from, end - from)));
        from = end + 1;
    }
    return parts;
}

// 0.5 for "text/html;level=1;q=0.5"; 1 without q.
double quality(const std::string& range) {
    for (const std::string& part : split(range, ';'))
        if (lower(part).starts_with("q=")) return std::strtod(part.c_str() + 2, nullptr);
    return 1.0;
}

bool covers(const std::string& range, const std::string& type) {
    if (range == "*/*" || range == type) return true;
    return range.ends_with("/*") && type.starts_with(range.substr(0, range.size() - 1));
}

}  // namespace

std::string media_type(const std::string& value) {
    return lower(split(value, ';')[0]);
}

bool accepts(const ApiRequest& request, const std::string& type) {
    const std::string* accept = request.header("accept");
    if (!accept || trimmed(*accept).empty()) return true;
    // The most specific range decides: "*/*, text/html;q=0" accepts all types but HTML.
    std::size_t longest = 0;
    bool accepted = false;
    for (const std::string& range : split(*accept, ',')) {
        std::string name = media_type(range);
        if (!covers(name, type)) continue;
        const std::size_t weight = name == "*/*" ? 1 : name.ends_with("/*") ? 2 : 3;
        if (weight < longest) continue;
        longest = weight;
        accepted = quality(range) > 0.0;
    }
    return accepted;
}

bool accepts_gzip(const ApiRequest& request) {
    const std::string* accept = request.header("accept-encoding");
    if (!accept) return false;
    for (const std::string& coding : split(*accept, ','))
        if (media_type(coding) == "gzip") return quality(coding) > 0.0;
    return false;
}

bool has_version(const ApiRequest& request, const std::string& etag) {
    const std::string* known = request.header("if-none-match");
    if (!known) return false;
    for (std::string tag : split(*known, ',')) {
        if (tag.starts_with("W/")) tag.erase(0, 2);
        if (tag == "*" || tag == etag) return true;
    }
    return false;
}

}  // namespace shadowbench::service

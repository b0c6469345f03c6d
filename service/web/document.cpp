#include "service/web/document.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/web/assets.h"

namespace shadowbench::service {
namespace {

// The page loads nothing, whatever the data contains.
constexpr const char* policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
    "form-action 'none'";

std::string text_of_path(std::string_view path) {
    const Asset* asset = find_asset(path);
    if (!asset) throw base::Error(base::ErrorCode::internal, path, "the program has no such file");
    return text_of(*asset);
}

// JSON in which an HTML parser finds no tag, comment or script.
std::string escaped_json(const nlohmann::json& data) {
    const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    std::string result;
    result.reserve(text.size());
    for (const char c : text) {
        if (c == '<')
            result += "\\u003c";
        else if (c == '>')
            result += "\\u003e";
        else if (c == '&')
            result += "\\u0026";
        else
            result += c;
    }
    return result;
}

}  // namespace

std::string escaped_html(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '&')
            result += "&amp;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

std::string document(std::string_view title, std::string_view script, const nlohmann::json& data) {
    std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
    page += "<meta http-equiv=\"Content-Security-Policy\" content=\"" + escaped_html(policy) + "\">\n";
    page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
    page += "<meta name=\"color-scheme\" content=\"light dark\">\n";
    page +=
        "<title>" + escaped_html(title) + "</title>\n<style>" + text_of_path("/assets/style.css") + "</style>\n</head>\n";
    page += "<body>\n<main id=\"main\"><noscript>This page needs JavaScript.</noscript></main>\n";
    page += "<div id=\"status\" class=\"hidden\" role=\"status\" aria-live=\"polite\"></div>\n";
    page += "<script type=\"application/json\" id=\"data\">" + escaped_json(data) + "</script>\n";
    page +=
        "<script type=\"text/plain\" id=\"licences\">" + escaped_html(text_of_path("/assets/licences.txt")) + "</script>\n";
    page += "<script>" + text_of_path(script) + "</script>\n</body>\n</html>\n";
    return page;
}

}  // namespace shadowbench::service

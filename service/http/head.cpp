#include "service/http/head.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace shadowbench::service {
namespace {

using Fault = std::optional<HeadFault>;

bool is_token_char(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_token_char);
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Fault read_path(std::string_view path, std::vector<std::string>& segments) {
    path.remove_prefix(1);
    for (;;) {
        const std::size_t slash = path.find('/');
        const auto segment = decode_percent(path.substr(0, slash), false);
        if (!segment) return HeadFault{400, "The path has an invalid percent escape."};
        if (*segment == "." || *segment == ".." || segment->find_first_of("/\\") != std::string::npos)
            return HeadFault{400, "The path has the segment \".\" or \"..\", or an escaped slash."};
        segments.push_back(*segment);
        if (slash == std::string_view::npos) return {};
        path.remove_prefix(slash + 1);
    }
}

Fault read_query(std::string_view query, std::vector<Field>& fields) {
    while (!query.empty()) {
        const std::string_view pair = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), pair.size() + 1));
        const std::size_t equals = std::min(pair.find('='), pair.size());
        const auto name = decode_percent(pair.substr(0, equals), true);
        const auto value = decode_percent(pair.substr(std::min(equals + 1, pair.size())), true);
        if (!name || !value) return HeadFault{400, "The query has an invalid percent escape."};
        if (!name->empty()) fields.push_back({*name, *value});
    }
    return {};
}

// "http://host/path" -> "/path".
std::string_view without_origin(std::string_view target) {
    if (lower(target.substr(0, 7)) != "http://") return target;
    const std::size_t path = target.find_first_of("/?", 7);
    if (path == std::string_view::npos) return "/";
    return target.substr(path);
}

Fault read_request_line(std::string_view line, Head& head) {
    const std::size_t first = line.find(' '), second = line.find(' ', first == line.npos ? first : first + 1);
    if (second == std::string_view::npos) return HeadFault{400, "The first line must be METHOD TARGET HTTP/1.1."};
    const std::string_view method = line.substr(0, first), version = line.substr(second + 1);
    const std::string_view target = without_origin(line.substr(first + 1, second - first - 1));
    if (!is_token(method)) return HeadFault{400, "The first line must be METHOD TARGET HTTP/1.1."};
    head.request.method = method;
    head.http10 = version == "HTTP/1.0";
    if (!version.starts_with("HTTP/") || version.find(' ') != std::string_view::npos)
        return HeadFault{400, "The first line must be METHOD TARGET HTTP/1.1."};
    if (version != "HTTP/1.1" && version != "HTTP/1.0")
        return HeadFault{505, "The server supports HTTP/1.1 and HTTP/1.0."};
    if (!target.starts_with('/') || std::any_of(target.begin(), target.end(), [](char c) {
            return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f;
        }))
        return HeadFault{400, "The target of the request must be a path."};
    const std::size_t query = std::min(target.find('?'), target.size());
    if (const Fault fault = read_path(target.substr(0, query), head.request.path)) return fault;
    return read_query(target.substr(std::min(query + 1, target.size())), head.request.query);
}

Fault read_field(std::string_view line, std::vector<Field>& fields) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon)))
        return HeadFault{400, "A header field has no valid name."};
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (std::any_of(value.begin(), value.end(), is_control))
        return HeadFault{400, "A header field contains control characters."};
    fields.push_back({lower(line.substr(0, colon)), std::string(value)});
    return {};
}

std::size_t count(const ApiRequest& request, std::string_view name) {
    return static_cast<std::size_t>(std::count_if(request.headers.begin(), request.headers.end(),
                                                  [&](const Field& field) { return field.name == name; }));
}

Fault read_body_length(Head& head) {
    const ApiRequest& request = head.request;
    const std::string *length = request.header("content-length"), *coding = request.header("transfer-encoding");
    if (count(request, "content-length") > 1 || count(request, "transfer-encoding") > 1 || (length && coding))
        return HeadFault{400, "The length of the body is given twice."};
    if (coding) {
        if (head.http10) return HeadFault{400, "HTTP/1.0 has no Transfer-Encoding."};
        if (lower(*coding) != "chunked") return HeadFault{501, "The only supported Transfer-Encoding is chunked."};
        head.chunked = true;
    }
    if (length) {
        std::uint64_t value = 0;
        const auto [rest, fault] = std::from_chars(length->data(), length->data() + length->size(), value);
        if (fault != std::errc() || rest != length->data() + length->size())
            return HeadFault{400, "Content-Length must be a number."};
        head.content_length = value;
    }
    head.request.has_body = head.chunked || head.content_length.value_or(0) > 0;
    return {};
}

Fault read_connection(Head& head) {
    head.keep_alive = !head.http10;
    if (const std::string* connection = head.request.header("connection")) {
        const std::string words = lower(*connection);
        if (words.find("close") != std::string::npos) head.keep_alive = false;
        if (head.http10 && words.find("keep-alive") != std::string::npos) head.keep_alive = true;
    }
    if (const std::string* expect = head.request.header("expect")) {
        if (lower(*expect) != "100-continue") return HeadFault{417, "The only supported Expect is 100-continue."};
        head.expects_continue = !head.http10;
    }
    const std::size_t hosts = count(head.request, "host");
    if (hosts > 1 || (hosts == 0 && !head.http10)) return HeadFault{400, "A request must have exactly one Host."};
    return {};
}

}  // namespace

bool is_control(char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f;
}

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

std::optional<std::string> decode_percent(std::string_view text, bool plus_is_space) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i] == '+' && plus_is_space ? ' ' : text[i];
            continue;
        }
        unsigned value = 0;
        if (i + 2 >= text.size()) return {};  // two digits follow
        const auto [rest, fault] = std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16);
        if (fault != std::errc() || rest != text.data() + i + 3 || value < 0x20 || value == 0x7f) return {};
        out += static_cast<char>(value);
        i += 2;
    }
    return out;
}

Fault parse_head(std::string_view text, Head& head) {
    bool first = true;
    while (!text.empty()) {
        const std::size_t end = text.find("\r\n");
        if (end == std::string_view::npos) return HeadFault{400, "A line does not end with CR and LF."};
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end + 2);
        if (line.find_first_of(std::string_view("\r\n\0", 3)) != std::string_view::npos)
            return HeadFault{400, "A line contains CR, LF or NUL."};
        if (!first && line.empty()) break;
        const Fault fault = first ? read_request_line(line, head) : read_field(line, head.request.headers);
        if (fault) return fault;
        first = false;
    }
    if (const Fault fault = read_body_length(head)) return fault;
    return read_connection(head);
}

}  // namespace shadowbench::service

#include <algorithm>
#include <cstddef>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "service/http/chunks.h"
#include "service/http/guard.h"
#include "service/http/head.h"

namespace shadowbench::fuzz {
namespace {

void read_as_chunks(std::string_view bytes) {
    std::string_view left = bytes;
    std::size_t data = 0;
    const bool whole = service::read_chunks(
        [&](char* to, std::size_t size) {
            const std::size_t n = std::min(size, left.size());
            std::copy_n(left.data(), n, to);
            left.remove_prefix(n);
            return static_cast<long>(n);
        },
        [&](const char*, std::size_t size) {
            data += size;
            return true;
        });
    expect(data <= bytes.size(), "the data of chunks is a part of the body");
    expect(!whole || bytes.substr(0, bytes.size() - left.size()).ends_with("\r\n\r\n"),
           "a body of chunks ends with an empty line");
}

}  // namespace

// The same bytes as a chunked body too.
void request_head(std::string_view bytes) {
    read_as_chunks(bytes);
    service::Head head;
    if (const auto fault = service::parse_head(bytes, head)) {
        expect(fault->status >= 400 && fault->status < 600, "a fault is an answer");
        return;
    }
    expect(!head.request.method.empty() && !head.request.path.empty(), "a request has a method and a path");
    expect(!(head.chunked && head.content_length), "a body has one length");
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; };
    for (const std::string& segment : head.request.path)
        expect(segment != ".." && segment != "." && segment.find_first_of("/\\") == std::string::npos &&
                   std::none_of(segment.begin(), segment.end(), control),
               "a segment of the path is a name");
    for (const service::Field& field : head.request.headers)
        expect(!field.name.empty() && std::none_of(field.value.begin(), field.value.end(), control),
               "fields have names, and no control characters");
    service::guard(head.request, {true, {{"", "0123456789abcdef"}}});
}

}  // namespace shadowbench::fuzz

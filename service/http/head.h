// The head of a request, read strictly (RFC 9112) before any library sees it: what could be read in two ways is
// refused.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "service/api/message.h"

namespace shadowbench::service {

struct Head {
    ApiRequest request;  // without its body
    bool http10 = false;
    bool keep_alive = true;
    bool expects_continue = false;
    bool chunked = false;
    std::optional<std::uint64_t> content_length;  // nothing: not told, or chunked
};

struct HeadFault {
    int status;
    const char* detail;
};

// `text` ends with the empty line. What it holds up to a fault is in `head` all the same, as far as it was understood.
std::optional<HeadFault> parse_head(std::string_view text, Head& head);

std::string lower(std::string_view text);  // ASCII letters

// "%41b+c" -> "Ab+c", or "Ab c" where `plus_is_space`. Nothing for a broken escape or one of a control character.
std::optional<std::string> decode_percent(std::string_view text, bool plus_is_space);

}  // namespace shadowbench::service

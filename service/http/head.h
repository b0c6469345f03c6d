// Parses the head of a request strictly (RFC 9112), before any library sees it. Heads that could be understood in two
// ways are refused.
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
    std::optional<std::uint64_t> content_length;  // nothing: absent, or the body is chunked
};

struct HeadFault {
    int status;
    const char* detail;
};

// `text` ends with the empty line. Returns the first fault; `head` then has the parts before it.
std::optional<HeadFault> parse_head(std::string_view text, Head& head);

// Whether it is a control character other than a tab.
bool is_control(char c);

// Makes ASCII letters lower case.
std::string lower(std::string_view text);

// "%41b+c" -> "Ab+c", or "Ab c" if `plus_is_space`. Nothing for an invalid escape or an escaped control character.
std::optional<std::string> decode_percent(std::string_view text, bool plus_is_space);

}  // namespace shadowbench::service

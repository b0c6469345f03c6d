// Builds JSON pointers (RFC 6901), the places that errors name.
#pragma once

#include <string>
#include <string_view>

namespace shadowbench::base {

// `pointer` with one more reference token, in which "~" becomes "~0" and "/" becomes "~1" (section 3):
// ("/techniques/0", "a/b") -> "/techniques/0/a~1b". Every key that comes from a document goes through here.
std::string append_token(std::string pointer, std::string_view token);

}  // namespace shadowbench::base

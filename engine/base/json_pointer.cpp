#include "base/json_pointer.h"

namespace shadowbench::base {

std::string append_token(std::string pointer, std::string_view token) {
    pointer += '/';
    for (const char c : token) {
        if (c == '~')
            pointer += "~0";
        else if (c == '/')
            pointer += "~1";
        else
            pointer += c;
    }
    return pointer;
}

}  // namespace shadowbench::base

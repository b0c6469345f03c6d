// A value that is set in a scenario document.
#pragma once

#include <string>

namespace shadowbench::document {

struct Setting {
    std::string pointer;  // JSON pointer (RFC 6901)
    std::string value;    // JSON text
};

}  // namespace shadowbench::document

// One value of a scenario document and its place.
#pragma once

#include <string>

namespace shadowbench::document {

struct Setting {
    std::string pointer;  // JSON pointer (RFC 6901)
    std::string value;    // JSON text
};

}  // namespace shadowbench::document

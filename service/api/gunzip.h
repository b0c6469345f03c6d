#pragma once

#include <string>
#include <string_view>

namespace shadowbench::service {

// What was compressed with gzip when the program was built, for clients that do not take it so. Throws Error{internal}.
std::string gunzip(std::string_view compressed);

}  // namespace shadowbench::service

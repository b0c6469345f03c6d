#include "base/hash_text.h"

#include <cstdint>

#include <fmt/format.h>

namespace shadowbench::base {

std::string hash_text(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return fmt::format("{:016x}", hash);
}

}  // namespace shadowbench::base

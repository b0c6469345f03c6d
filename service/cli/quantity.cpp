#include "service/cli/quantity.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::service {

double read_quantity(const std::string& text, std::span<const Unit> units, const std::string& where) {
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data(), end, number);
    std::string_view unit(rest, static_cast<std::size_t>(end - rest));
    if (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    std::string names;
    for (const Unit& known : units) {
        if (fault == std::errc() && number > 0.0 && std::isfinite(number * known.factor) && unit == known.name)
            return number * known.factor;
        names += (names.empty() ? "" : ", ") + std::string(known.name);
    }
    throw base::Error(base::ErrorCode::usage, where,
                      fmt::format("\"{}\" is not a number above 0 with one of the units {}", text, names));
}

}  // namespace shadowbench::service

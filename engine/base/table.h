// Text in aligned columns.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace shadowbench::base {

// The first and the last column are aligned to the left, the others to the right. Colours (see coloured()) take no
// space.
class Table {
public:
    explicit Table(std::vector<std::string> header);
    void add(std::vector<std::string> row);  // as many fields as the header
    std::string text(const std::string& indent) const;

private:
    std::vector<std::vector<std::string>> rows_;
};

// Lines of at most `width` characters, broken at spaces: a line that goes on is indented as it began, and by two spaces
// more. A word that is too long for a line is broken too. A width below 20 counts as 20.
std::string wrapped(const std::string& text, std::size_t width);

enum class Colour { none, bold, red, green, yellow };
// The text as a terminal shows it in this colour.
std::string coloured(const std::string& text, Colour colour);

// Six digits, or as many more as tell the number from all others: "0.02", "1e-05".
std::string number_text(double value);

// Two digits; "-" if the value is not finite.
std::string error_text(double value);

// "512 B", "1.5 KiB", "23 MiB".
std::string bytes_text(std::size_t bytes);

}  // namespace shadowbench::base

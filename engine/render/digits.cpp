#include "render/digits.h"

#include <array>

namespace shadowbench::render {
namespace {

using Glyph = std::array<std::string_view, digit_height>;

constexpr std::string_view characters = "0123456789.-e";
constexpr Glyph glyphs[] = {
    {" ### ", "#   #", "#  ##", "# # #", "##  #", "#   #", " ### "},
    {"  #  ", " ##  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "},
    {" ### ", "#   #", "    #", "   # ", "  #  ", " #   ", "#####"},
    {" ### ", "#   #", "    #", "  ## ", "    #", "#   #", " ### "},
    {"   # ", "  ## ", " # # ", "#  # ", "#####", "   # ", "   # "},
    {"#####", "#    ", "#### ", "    #", "    #", "#   #", " ### "},
    {" ### ", "#    ", "#    ", "#### ", "#   #", "#   #", " ### "},
    {"#####", "    #", "   # ", "  #  ", "  #  ", "  #  ", "  #  "},
    {" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### "},
    {" ### ", "#   #", "#   #", " ####", "    #", "    #", " ### "},
    {"     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "},
    {"     ", "     ", "     ", "#####", "     ", "     ", "     "},
    {"     ", "     ", " ### ", "#   #", "#####", "#    ", " ### "},
};

}  // namespace

int text_width(std::string_view text, int scale) {
    return text.empty() ? 0 : (static_cast<int>(text.size()) * (digit_width + 1) - 1) * scale;
}

void draw_digits(Image& image, int x, int y, int scale, std::string_view text, const base::Vec3f& colour) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::size_t which = characters.find(text[i]);
        if (which == std::string_view::npos) continue;
        const int left = x + static_cast<int>(i) * (digit_width + 1) * scale;
        for (int v = 0; v < digit_height * scale; ++v)
            for (int u = 0; u < digit_width * scale; ++u) {
                const int px = left + u, py = y + v;
                const bool inside = px >= 0 && py >= 0 && px < image.width && py < image.height;
                if (inside && glyphs[which][v / scale][u / scale] == '#') image.at(px, py) = colour;
            }
    }
}

}  // namespace shadowbench::render

// The parts of Lokovic and Veach, Deep Shadow Maps, 2000, and what they share. Each adds its claims, tables and plots to
// context.report.
#pragma once

#include <string>

#include "claims/paper.h"

namespace shadowbench::claims::lokovic {

inline constexpr const char* hair_ball = "lokovic2000_hairball";

// The paper's filter weighs whole pixels (section 3.4). A tent filter is as wide as a pixel wherever it lies. A box
// filter of a pixel's width leaves only the nearest pixel.
inline constexpr const char* tent = R"({"type":"deep","kernel":"tent"})";
inline constexpr const char* pixels = R"({"type":"deep","kernel":"pixels"})";

// Filters over exactly the width of the lookup, with this number of samples.
std::string pcf(int samples, const char* cells);
std::string set_techniques(const std::string& list);
std::string bytes_text(double bytes);  // "1.5 MiB"

void sampling(const Context& context);   // section 6, figures 7 and 8
void filtering(const Context& context);  // figure 9 and section 5.3
void channels(const Context& context);   // section 5.2
void motion(const Context& context);     // section 5.5, figure 12

}  // namespace shadowbench::claims::lokovic

// The parts of Lokovic and Veach, Deep Shadow Maps, 2000, and what they share. Each adds its claims, tables and plots
// to context.report.
#pragma once

#include <string>

#include "claims/paper.h"

namespace shadowbench::claims::lokovic {

inline constexpr const char* hair_ball = "lokovic2000_hairball";

// The paper's filter weighs whole pixels (section 3.4). A tent filter is as wide as a pixel wherever it lies. A box
// filter of a pixel's width leaves only the nearest pixel.
inline constexpr const char* tent = R"({"type":"deep","kernel":"tent"})";
inline constexpr const char* pixels = R"({"type":"deep","kernel":"pixels"})";

// The scenes of figures 6 to 8, and of figures 10 and 11, from the paper's description.
inline constexpr const char* ball_scene = "lokovic2000_ball";
inline constexpr const char* cloud_scene = "lokovic2000_cloud";
inline constexpr const char* smoke_scene = "lokovic2000_smoke";

// The paper's deep map: the compression of section 3.3 word for word. Its filter weights pixel (i, j) by
// f(i + 1/2 - x, j + 1/2 - y). The default kernel is of this form: f(d) is the part of a pixel at distance d that the
// footprint covers. With kernel=pixels, f is the box of the footprint itself.
std::string published_deep(const char* kernel = "box");

// Filters over exactly the width of the lookup, with this number of samples.
std::string pcf(int samples, const char* cells);
std::string placed_pcf(int samples, const char* placement);
std::string set_techniques(const std::string& list);
std::string bytes_text(double bytes);       // "1.5 MiB"
Value bytes_of(const results::Cell& cell);  // its mean over the seeds of the light rays, with its interval

void noise(const Context& context);       // sections 2 and 4: the error of N samples
void three_maps(const Context& context);  // section 6, figure 6
void searches(const Context& context);    // section 3.4: the segment of a function that holds a depth
void sampling(const Context& context);    // section 6, figure 7
void generation(const Context& context);  // sections 4, 5.1 and 6: the time to make a map
void vertices(const Context& context);    // section 4, figure 8
void filtering(const Context& context);   // figure 9 and section 5.3
void biases(const Context& context);      // section 4: incorrect self-shadowing
void channels(const Context& context);    // section 5.2
void motion(const Context& context);      // section 5.5, figure 12
void media(const Context& context);       // figures 10 and 11

}  // namespace shadowbench::claims::lokovic

// The parts of Salvi, Vidimce, Lauritzen, Lefohn, Adaptive Volumetric Shadow Maps, 2010, and what they share. Each adds
// its claims, tables and plots to context.report.
#pragma once

#include "claims/paper.h"
#include "rays/light_rays.h"

namespace shadowbench::claims::salvi {

inline constexpr const char* columns = "salvi2010_columns";
inline constexpr const char* hair_in_smoke = "salvi2010_hair";
inline constexpr const char* level = "salvi2010_level";

// One grey level of a picture of 8 bits: the limit of the rule "unnoticed". And the farthest limit of the rule "fit".
inline constexpr double grey_level = 1.0 / 255.0, rough_fit = 0.05;

// The settings of a first look: a quarter of the texels.
nlohmann::json with_size(nlohmann::json document, const Context& context);

// Figure 7: very translucent puffs close to the light, a sharp drop at the second column, another at the third; one
// drop in each third of the depth range.
bool three_drops(const rays::LightRays& tile, std::size_t ray, const rays::MapLayout& layout);

void table_1(const Context& context);          // section 5.3, table 1: times and memory
void depth_range(const Context& context);      // section 5.1, figure 4
void pictures(const Context& context);         // section 5.1, figures 3 and 5
void texels(const Context& context);           // section 5.2, figures 6 and 7
void sampling(const Context& context);         // section 3.3: between nodes
void orders(const Context& context);           // section 4.1: segments that are not sorted
void streaming_times(const Context& context);  // section 5.3: the costs of sorting and of streaming
void drift(const Context& context);            // section 3.2: why nodes must not move

}  // namespace shadowbench::claims::salvi

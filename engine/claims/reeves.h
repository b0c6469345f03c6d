// The parts of Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987. Each adds its claims and
// tables to context.report.
#pragma once

#include "claims/paper.h"

namespace shadowbench::claims::reeves {

inline constexpr const char* sphere = "reeves1987_sphere";
inline constexpr const char* lights = "reeves1987_lights";
inline constexpr const char* store = "reeves1987_store";

void times(const Context& context);    // table 1, and the parts of the time that shadows add
void storage(const Context& context);  // table 2
void edges(const Context& context);    // figures 4, 6, 7, 8 and 10
void bias(const Context& context);     // figure 9

}  // namespace shadowbench::claims::reeves

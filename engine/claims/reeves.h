// The parts of Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987. Each adds its claims and
// tables to context.report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "claims/paper.h"

namespace shadowbench::claims::reeves {

inline constexpr const char* sphere = "reeves1987_sphere";
inline constexpr const char* lights = "reeves1987_lights";
inline constexpr const char* store = "reeves1987_store";

// Places of the maps' cells against a scene.
inline constexpr std::uint64_t map_places = 3;
// These settings of a scenario, with the cells of every light's map at another place: see with_moved_map().
std::vector<std::string> moved(const Context& context, const char* scenario, std::uint64_t place,
                               std::vector<std::string> set);

void times(const Context& context);       // table 1, and the parts of the time that shadows add
void storage(const Context& context);     // table 2
void edges(const Context& context);       // figures 6, 7 and 10
void half_plane(const Context& context);  // figures 3, 4 and 8
void depths(const Context& context);      // floating point depths against integers
void bias(const Context& context);        // figure 9

}  // namespace shadowbench::claims::reeves

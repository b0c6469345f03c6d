// The scenes of Salvi et al. 2010 in other arrangements: the paper gives neither the spacing of the three columns of
// figures 4 and 7, nor how dense smoke and hair are.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::claims::salvi {

// Of the columns, along the light; estimated from the axis of figure 7. At the other distance a column is a
// 25th of the depth range deep, as a drop of figure 7 that takes much less than a step of the axis would have it.
inline constexpr double own_spacing = 4.5, far_spacing = 12.0;

// The columns at another distance along the light, with the sun as much lower as they are farther apart, so that the
// light sees them in the same places.
nlohmann::json with_spacing(nlohmann::json document, double spacing);

// The camera so many times as far from its target.
nlohmann::json with_camera_away(nlohmann::json document, double times);

// All smoke so many times as dense.
nlohmann::json with_density(nlohmann::json document, double density);

// All hair so many times as opaque.
nlohmann::json with_opacity(nlohmann::json document, double opacity);

}  // namespace shadowbench::claims::salvi

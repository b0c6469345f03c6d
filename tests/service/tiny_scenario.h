// A scenario that runs in milliseconds.
#pragma once

namespace shadowbench::service {

inline constexpr const char* tiny = R"({
    "name": "tiny",
    "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
    "lights": [{"type": "directional", "direction": [0, -1, 0]}],
    "rays": {"resolution": 8, "samples_per_pixel": 4},
    "receivers": {"type": "probes", "count": 200},
    "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
    "timing": {"repetitions": 1, "lookups": 64},
    "techniques": [{"type": "deep"}, {"type": "uncompressed"}]
})";

}  // namespace shadowbench::service

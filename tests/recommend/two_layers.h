// A scenario that is measured in milliseconds.
#pragma once

#include <nlohmann/json.hpp>

namespace shadowbench::recommend {

// A translucent quad that covers a corner of the map, over an opaque one.
inline nlohmann::json two_layers() {
    return nlohmann::json::parse(R"({
        "name": "two_layers",
        "scene": {"objects": [
            {"type": "quad", "corner": [-1, 1, -1], "edge_u": [1.3, 0, 0.2], "edge_v": [0.1, 0, 1.1], "opacity": 0.6},
            {"type": "quad", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "opacity": 0.5}]},
        "lights": [{"type": "directional", "name": "sun", "direction": [0, -1, 0]}],
        "rays": {"resolution": 16, "samples_per_pixel": 4},
        "receivers": {"type": "probes", "count": 2000, "filter_width": 1.5},
        "reference": {"samples_per_pixel": 4096, "queries": 500, "spread_seeds": 0},
        "timing": {"repetitions": 2, "lookups": 128},
        "techniques": [{"type": "deep"}]
    })");
}

}  // namespace shadowbench::recommend

// The visibility functions of one pixel of a light's map: the exact one, and those that the techniques of the scenario
// store. For interactive use: only the tile of the pixel is captured and built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/run.h"
#include "curves/curve.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

struct TechniqueCurve {
    std::string title, technique;
    std::string absent;  // why there is no function; empty if there is one
    // One per channel, from z_min to z_max. If the technique stores a function per sample, the mean over the pixel's
    // samples, which a lookup one pixel wide answers with.
    std::vector<curves::Curve> channels;
    techniques::Cells cells = techniques::Cells::none;
    std::uint64_t nodes = 0;  // stored, over all channels and samples of the pixel
    double error_max = 0.0;   // largest |stored - exact function of the same rays|
};

struct PixelCurves {
    std::string light;
    int x = 0, y = 0;
    double z_min = 0.0, z_max = 0.0;
    int rays = 0;                      // number of rays of the pixel
    std::vector<curves::Curve> exact;  // one per channel, of all rays of the pixel
    std::vector<TechniqueCurve> curves;
};

// Throws Error{usage} for a light or variant, as given to PixelProbe, that does not exist: "light=moon", "variant=3".
// Loads nothing.
void check_light(const nlohmann::json& document, const std::string& light, std::size_t variant);

class PixelProbe {
public:
    // `light` is as in OneLight; `variant` counts the combinations of the scenario's sweeps. Throws what run() throws
    // for a document, and Error{usage} for a light or variant that does not exist.
    PixelProbe(const nlohmann::json& document, const RunOptions& options, const std::string& light,
               std::size_t variant);
    ~PixelProbe();
    PixelProbe(const PixelProbe&) = delete;
    PixelProbe& operator=(const PixelProbe&) = delete;

    // Successive pixels of one tile are fast, since the tile's maps are kept. Throws Error{usage} outside the map.
    PixelCurves at(int x, int y);

private:
    struct State;
    std::unique_ptr<State> state_;
};

nlohmann::ordered_json to_json(const PixelCurves& curves);

}  // namespace shadowbench::bench

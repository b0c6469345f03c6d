// The visibility functions of one pixel of a light's map: the exact one, and what every technique of the scenario
// stores for it. For looking at, so only what the pixel needs is captured and built: the tile that it lies in.
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
    std::string absent;  // why there is none; empty: there is one
    // One a channel, from z_min to z_max. Of a technique with a function a sample, the mean of the pixel's: what a
    // lookup one pixel wide answers with.
    std::vector<curves::Curve> channels;
    techniques::Cells cells = techniques::Cells::none;
    std::uint64_t nodes = 0;  // stored, of all channels and samples of the pixel
    double error_max = 0.0;   // largest |shown - exact of the rays that it stands for|
};

struct PixelCurves {
    std::string light;
    int x = 0, y = 0;
    double z_min = 0.0, z_max = 0.0;
    int rays = 0;                      // of the pixel
    std::vector<curves::Curve> exact;  // one a channel, of all rays of the pixel
    std::vector<TechniqueCurve> curves;
};

// Throws Error{usage} where a light or variant, as PixelProbe is asked for them, is not there: "light=moon",
// "variant=3". Loads nothing.
void check_light(const nlohmann::json& document, const std::string& light, std::size_t variant);

class PixelProbe {
public:
    // `light` as in OneLight; `variant` counts the combinations of the scenario's sweeps. Throws what run() throws of
    // a document, and Error{usage} for a light or variant that is not there.
    PixelProbe(const nlohmann::json& document, const RunOptions& options, const std::string& light,
               std::size_t variant);
    ~PixelProbe();
    PixelProbe(const PixelProbe&) = delete;
    PixelProbe& operator=(const PixelProbe&) = delete;

    // Pixels of one tile after the other are fast: the tile's maps are kept. Throws Error{usage} outside the map.
    PixelCurves at(int x, int y);

private:
    struct State;
    std::unique_ptr<State> state_;
};

nlohmann::ordered_json to_json(const PixelCurves& curves);

}  // namespace shadowbench::bench

// Pictures of one scenario through maps of the same light rays, as the figures of Salvi et al. 2010 compare them: with
// the picture through the uncompressed map.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "claims/first_light.h"
#include "claims/intervals.h"
#include "claims/paper.h"
#include "render/image.h"
#include "render/point_queries.h"

namespace shadowbench::claims::salvi {

// Two pictures as a display of 8 bits shows them.
struct Difference {
    double rms = 0.0;   // over the channels of all pixels that see anything; 1 is the range of the display
    double flip = 0.0;  // mean FLIP over the picture
    double most = 0.0;  // of the channel that differs most; 99 % of the pixels that see anything differ by no more
};

// A picture through one technique's map, and the one through the uncompressed map.
struct Frame {
    render::Image picture, truth;
};

// Differences of pictures, one a seed; medians.
struct SeededDifferences {
    std::vector<double> rms, flip, most;

    void add(const Difference& one);
    // "Perceptible" is read in two ways: over the whole picture, and at 99 % of its pixels.
    Judged unnoticed() const;
    std::string text() const;  // "rms 0.01 [...], 99 % of the pixels by at most ..., mean FLIP ..."
    std::vector<Value> values() const;
};

// What the camera of a scenario sees, and the light rays of its first light, captured once.
class View {
public:
    View(const nlohmann::json& document, const Context& context);
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    const rays::MapLayout& layout() const { return first_.light.layout; }
    const std::vector<rays::LightRays>& tiles() const { return tiles_; }
    // The technique of the scenario whose parameters have these values, found as cell_of() does.
    const bench::Contender& contender(const std::string& technique,
                                      const std::vector<std::string>& parameters = {}) const;

    // A map of these tiles: those captured, or the same rays with their segments in another order of submission.
    bench::Maps build(const bench::Contender& contender, std::span<const rays::LightRays> tiles) const {
        return first_.build(contender, tiles);
    }
    // A map of the captured tiles whose depth bounds are so many times as far apart as those of all casters, about the
    // same middle.
    bench::Maps build_within(const bench::Contender& contender, double times_the_range) const;
    render::Image picture(const bench::Maps& maps) const;
    render::Image picture(const std::string& technique, const std::vector<std::string>& parameters = {}) const {
        return picture(build(contender(technique, parameters), tiles_));
    }

    Difference difference(const render::Image& a, const render::Image& b) const;
    // How much what is wrong in a picture changes from this frame to the next: the rms over the channels of the pixels
    // that see anything here, as a display shows them.
    double change(const Frame& here, const Frame& next) const;

private:
    FirstLight first_;
    results::LightResult listed_;  // its cells are those of the contenders
    std::vector<rays::LightRays> tiles_;
    render::ShadingPoints points_;
    render::PointQueries asked_;
};

// The scenario with the seeds of its procedural objects replaced: each k gives another scene of the same kind, and 0
// the scenario as it is.
nlohmann::json with_seeds(nlohmann::json document, int k);

// How far the curves of all texels of the scenario's first light are from those of its light rays, for each technique
// in the scenario's order.
struct MapErrors {
    double depth = 0.0;       // the range of depths that the map covers
    std::vector<double> rms;  // over texels, of each curve's largest error
};
MapErrors map_errors(const nlohmann::json& document, const Context& context);

// How far a technique's curves are from those of the light rays, over the texels whose rays cross more than so many
// segments: texels that hold less say nothing of its compression. Of one ray a texel.
struct ComplexCurves {
    std::size_t texels = 0;
    double rms = 0.0;   // over these texels, of each curve's largest distance
    double mean = 0.0;  // over these texels and all depths
};
ComplexCurves complex_curves(const View& view, const bench::Contender& contender, std::size_t segments);

// The number of seeds over which pictures are compared: the range of six values holds the median with 97 %.
inline constexpr int seeds = 6;

}  // namespace shadowbench::claims::salvi

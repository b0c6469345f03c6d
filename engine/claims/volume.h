// The parts of the paper on deep shadow maps from volumetric data, and what they share. Each adds its claims, tables
// and pictures to context.report.
#pragma once

#include <array>
#include <vector>

#include "claims/paper.h"
#include "curves/curve.h"

namespace shadowbench::claims::volume {

struct DataSet {
    const char* name;
    const char* scenario;
    const char* size;  // in voxels
};
inline constexpr DataSet data_sets[] = {{"box", "volume_box", "64 x 64 x 64"},
                                        {"bucky", "volume_bucky", "32 x 32 x 32"},
                                        {"rods", "volume_rods", "64 x 64 x 64"},
                                        {"clouds", "volume_clouds", "512 x 512 x 32"}};

inline constexpr int map_steps = 512,
                     view_lookups = 128;  // the paper's: of a ray to build and to render; of a view ray

inline constexpr std::array<float, 3> levels{0.1f, 0.5f, 0.9f};  // opacities

// The four channels of a texel: the depths at which its function has lost 10, 50 and 90 % of the light (or all that it
// loses, where that is less), and what it loses.
struct Channels {
    std::array<float, 3> depth{0.0f, 0.0f, 0.0f};
    float most = 0.0f;
};
Channels channels_of(curves::CurveView function);

// Nanoseconds of one thread for a view ray that meets the volume's box: of the first pass, and of the second.
struct PassTimes {
    Value colour, opacity;
};

void channel_pictures(const Context& context);                     // figure 2
std::vector<PassTimes> two_pass_renderer(const Context& context);  // figure 3; times in the order of data_sets

}  // namespace shadowbench::claims::volume

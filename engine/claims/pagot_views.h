// One scene seen through several kernels: under several lights, from several views, and with the cells of the map in
// several phases.
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "claims/pagot.h"
#include "claims/seen.h"
#include "render/image.h"

namespace shadowbench::claims::pagot {

inline constexpr int lights = 5;                     // each with a camera and a place of the map's cells of its own
inline constexpr double widths[] = {2, 3, 4, 5, 6};  // cells, of the truth's footprints

// On which surfaces shadows are compared: on the plane y = 0, or on all others.
enum class Surfaces { plane, others };

// The document with its first light and its camera turned around the vertical axes through their targets.
nlohmann::json turned(nlohmann::json document, double light_degrees, double camera_degrees);

// The least shade of the receivers whose errors and transitions count: they face the light. On surfaces that cast
// shadows they face it so much that the widest footprint and the kernels, which reach less far, meet the receiver's own
// surface nowhere nearer to the light than by the bias. What a ball seems to shade of itself is no shadow's edge.
double least_shade(const nlohmann::json& document, Surfaces surfaces);

// Where the axis of a document's first light meets the plane.
base::Vec3d middle_of_shadow(const nlohmann::json& document);

// The document with its camera moved, so that it looks at this place from where it looked at its target.
nlohmann::json aimed(nlohmann::json document, const base::Vec3d& at, double fov);

// How far two shaded pictures of the surfaces are apart under each light. Without shading, a picture would show the
// dark side of a ball like a shadow on it.
struct Apart {
    std::vector<double> rms, flip;
};

// A kernel of an odd side lies around the middle of a cell and one of an even side around a corner of cells. Both are
// centred, but the steps of their answers lie half a cell apart. Over the four phases of a map, moved by half a cell
// along each axis, the steps of both lie at the same places: so the means over the phases of two kernels differ by what
// the kernels do, and not by where the cells lie.
struct Difference {
    Apart of_means;      // over the phases
    Apart in_one_phase;  // with the cells at one place
};

class Views {
public:
    Views(const Context& context, const char* scene, Surfaces surfaces, std::vector<Kernel> kernels);

    const std::vector<Kernel>& kernels() const { return kernels_; }
    const Difference& difference(const Kernel& a, const Kernel& b);

    // Of one kernel, under each light:
    struct Numbers {
        Apart half_a_cell_on;            // of its picture from that in the opposite phase
        std::vector<double> aliasing;    // rms of its pictures in all phases from their mean
        std::vector<double> transition;  // share of the receivers that count: neither lit nor dark
        // RMS error of visibility against the truth over each width.
        std::array<std::vector<double>, std::size(widths)> error;
        std::size_t best_width() const;  // the place of that at which the mean error is least
    };
    const Numbers& numbers(const Kernel& kernel) const { return measured_[place(kernel)].numbers; }

private:
    struct Measured {
        std::vector<render::Image> one, mean;  // under each light: in one phase; over all
        Numbers numbers;
    };

    std::size_t place(const Kernel& kernel) const;
    bool on_surfaces(const Seen& seen, std::size_t query) const;
    render::Image shaded(const Seen& seen, std::size_t kernel) const;
    void add(const nlohmann::json& document, const scene::SearchPath& data);
    void add_numbers(const Seen& seen);

    Surfaces surfaces_;
    double least_shade_ = 0.0;
    std::vector<Kernel> kernels_;
    std::vector<Measured> measured_;  // of each kernel
    std::map<std::pair<std::size_t, std::size_t>, Difference> differences_;
};

// The mean picture of several, and the rms distance of theirs from it, over all pixels. Pictures are grey.
render::Image mean_picture(const std::vector<render::Image>& pictures);
double rms_from(const std::vector<render::Image>& pictures, const render::Image& mean);

}  // namespace shadowbench::claims::pagot

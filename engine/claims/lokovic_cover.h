// The scenes of section 2 of Lokovic and Veach, Deep Shadow Maps, 2000, in which the error of filtering N jittered
// depths is known. Where one horizontal silhouette crosses the filter region at a random height, it is expected to be
// N^(-3/4) / sqrt 6; in fur that covers half of the region and crosses every part of it, N^(-1/2) / 2.
#pragma once

#include <cstdint>
#include <vector>

#include "rays/light_rays.h"

namespace shadowbench::claims::lokovic {

// A square of cells, each covered by an opaque caster or empty.
class Cover {
public:
    Cover(int side, std::vector<char> covered);  // row after row

    int side() const { return side_; }
    bool at(double x, double y) const;                     // inside the square
    double share(double x, double y, double width) const;  // of the square `width` wide around (x, y) that is covered
    rays::LightRays rays() const;                          // one for each cell; casters are at depth 1

private:
    double sum(double x, double y) const;  // the covered area below and left of (x, y)

    int side_;
    std::vector<char> covered_;
    std::vector<double> sums_;  // at the corners of cells
};

// A caster over the lower half: one horizontal silhouette.
Cover silhouette(int side);
// Hairs one cell wide at random places, in random directions, until they cover half.
Cover fur(int side, std::uint64_t seed);

// The root mean square error of percentage closer filtering over squares `width` cells wide with this number of
// samples, jittered or placed in another way of the technique's, at `lookups` random places. Each square holds the
// middle of the map in y, so that the silhouette crosses it. The map must be at least twice as wide as the squares.
double filtering_error(const Cover& cover, int width, int samples, int lookups, std::uint64_t seed,
                       const char* placement = "jittered");

// The same for a deep shadow map of 16 x 16 pixels with this number of jittered light rays each, over squares with the
// area of `pixels` pixels, at random places. `kernel`: the technique's way to weight pixels.
double deep_error(const Cover& cover, int samples_per_pixel, double pixels, int lookups, std::uint64_t seed,
                  const char* kernel = "box");

}  // namespace shadowbench::claims::lokovic

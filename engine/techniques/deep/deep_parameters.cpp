#include "techniques/deep/deep_parameters.h"

#include <cmath>

namespace shadowbench::techniques::deep_parameters {
namespace {

const Parameter parameters[] = {
    {"tolerance",
     ParameterKind::number_or_word,
     "largest error of a stored function; \"noise\" is 0.25 / sqrt(samples a pixel), half of the rays' worst expected "
     "noise",
     0,
     0,
     1,
     "noise",
     {"noise"}},
    {"compression",
     ParameterKind::choice,
     "bounded: never rises, stays in [0, 1], ends on the exact value where one segment can; optimal: the fewest nodes "
     "that such a function needs within the tolerance, at many times the time to build (coloured pixels, and functions "
     "whose search takes too long, as bounded); published: the paper's text word for word, which keeps the tolerance "
     "too, but rises by up to it and falls below 0 by up to it",
     0,
     0,
     0,
     "bounded",
     {"bounded", "optimal", "published"}},
    {"filter",
     ParameterKind::choice,
     "how the rays around a pixel's centre make its function; a gaussian falls to exp(-2) at its radius",
     0,
     0,
     0,
     "box",
     {"box", "tent", "gaussian"}},
    {"radius", ParameterKind::number, "radius of the filter in pixels; a box of 0.5 is exactly the pixel", 0.5, 0.5, 8},
    {"mip",
     ParameterKind::choice,
     "coarser levels for wide lookups, each within half the tolerance of the one before, so within twice the tolerance "
     "in all: none, the nearest level, or a blend of two, which changes smoothly with the width but blurs more",
     0,
     0,
     0,
     "none",
     {"none", "nearest", "blend"}},
    {.name = "mip_from",
     .kind = ParameterKind::choice,
     .doc = "what coarser levels are means of: the compressed functions of the level before, as published; or the "
            "uncompressed functions of all light rays, which takes more time and memory to build",
     .standard_word = "compressed",
     .words = {"compressed", "samples"}},
    {"kernel",
     ParameterKind::choice,
     "how a lookup weights pixels: box, by the part of each that its footprint covers, which at one pixel's width is "
     "bilinear interpolation, the lookup of renderers; tent, twice as wide; pixels, the paper's box: whole pixels "
     "whose centres lie within the filter radius",
     0,
     0,
     0,
     "box",
     {"box", "tent", "pixels"}},
    {.name = "probes",
     .kind = ParameterKind::integer,
     .doc = "anisotropic filtering over the receiver's own pixel where it is known: at most so many lookups along its "
            "long axis, each as wide as its short one; 1 is one lookup as wide as the long axis; 0 filters over the "
            "square that is asked for",
     .standard = 0,
     .min = 0,
     .max = 64},
    {"search",
     ParameterKind::choice,
     "how a lookup finds the segment of a function: cached starts at the segment that the same batch used last in that "
     "pixel; all give the same answers",
     0,
     0,
     0,
     "binary",
     {"binary", "linear", "cached"}},
    {.name = "storage",
     .kind = ParameterKind::choice,
     .doc = "where the finished map is: in memory; or tiled, in a temporary file that lookups read through a fixed "
            "number of tiles in memory, with the same answers (then the map's bytes are the most that those tiles come "
            "to hold)",
     .standard_word = "memory",
     .words = {"memory", "tiled"}},
    {.name = "slots",
     .kind = ParameterKind::integer,
     .doc = "with storage=tiled: the number of tiles of 16 x 16 pixels that are in memory at once",
     .standard = 64,
     .min = 1,
     .max = 65536},
};

}  // namespace

std::span<const Parameter> all() {
    return parameters;
}

// Not traded: `compression=published`, which keeps the same tolerance with other faults; `compression=optimal`, which
// saves some nodes for many times the build; `filter` and `radius`, which widen every lookup beyond its footprint;
// `mip_from`, whose levels keep the same tolerances at about the same size; `kernel=pixels`, which drops and adds whole
// pixels; `probes`, since lookups are judged over the square that is asked for; `search`, whose cached and linear ways
// gain only where neighbours are looked up together, or for very short functions; `storage` and `slots`, which change
// no answer, and whose file does not count as memory.
std::vector<Trade> trades() {
    return {{"tolerance", Trade::Scale::logarithmic, 0.2, 0.0005},
            {.parameter = "kernel", .choices = {"box", "tent"}, .only_lookups = true},
            {.parameter = "mip", .choices = {"none", "nearest", "blend"}}};
}

double tolerance_of(const ParameterValues& values, int samples) {
    return values.is_word("tolerance") ? 0.25 / std::sqrt(static_cast<double>(samples)) : values.number("tolerance");
}

Compression::Method method_of(const ParameterValues& values) {
    const std::string& word = values.word("compression");
    return word == "bounded"   ? Compression::Method::bounded
           : word == "optimal" ? Compression::Method::optimal
                               : Compression::Method::published;
}

PixelFilter filter_of(const ParameterValues& values) {
    const std::string& shape = values.word("filter");
    return {shape == "box"    ? FilterShape::box
            : shape == "tent" ? FilterShape::tent
                              : FilterShape::gaussian,
            values.number("radius")};
}

LookupRule rule_of(const ParameterValues& values) {
    const std::string &kernel = values.word("kernel"), &mip = values.word("mip"), &search = values.word("search");
    return {kernel == "box"    ? Kernel::box
            : kernel == "tent" ? Kernel::tent
                               : Kernel::pixels,
            mip == "none"      ? Mip::none
            : mip == "nearest" ? Mip::nearest
                               : Mip::blend,
            search == "binary"   ? Search::binary
            : search == "linear" ? Search::linear
                                 : Search::cached,
            values.integer("probes")};
}

bool has_levels_of_samples(const ParameterValues& values) {
    return values.word("mip_from") == "samples";
}

std::size_t slots_of(const ParameterValues& values) {
    return values.word("storage") == "tiled" ? static_cast<std::size_t>(values.integer("slots")) : 0;
}

}  // namespace shadowbench::techniques::deep_parameters

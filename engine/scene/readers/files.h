// Readers of scene files. Each throws Error: no_such_file, io, or bad_input with "file:offset" of the fault; a value
// that is not finite, a count that the file is too short for and a box or index out of range are bad input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/limits.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// TressFX 3 and 4 (.tfx). `radius` is the half-width of every point; 0 keeps 0.
Hair read_tressfx(const std::filesystem::path& file, float radius);

// Cem Yuksel's .hair format (cemyuksel.com/research/hairmodels). Thickness in the file is taken as full width;
// `radius` > 0 overrides it.
Hair read_hair(const std::filesystem::path& file, float radius);

struct MeshFile {
    Mesh mesh;
    std::vector<PassedOver> passed_over;
};

// By extension: .obj or .ply (ASCII and binary, faces and triangle strips). Polygons are split into triangles that
// cover them once (triangulate.h); one that crosses itself is bad input. A file may hold vertices alone.
MeshFile read_mesh(const std::filesystem::path& file);

// The alpha channel of an image (its luminance where it has none): PNG, JPEG, TIFF, OpenEXR, DDS or TGA.
AlphaTexture read_alpha(const std::filesystem::path& file);

// What becomes of densities below 0, which interpolation and rounding leave in files: taken as 0, all of them, with
// their number and the least in the volume's notes; or refused. Values that are not finite are always refused.
enum class Negative { clamp, refuse };

// Raw values, x fastest; type "uint8" (scaled to [0, 1]) or "float32" (little-endian). The file's size must match.
// The caller sets the box and step.
GridVolume read_raw_volume(const std::filesystem::path& file, Vec3i size, const std::string& type,
                           Negative negative = Negative::clamp);

// A grid by its name ("density[1]" where several have one), or by its number from 0 on. Neither: "density", or, where
// there is none of that name, the file's only grid of float values, whatever it is called.
using GridChoice = std::variant<std::monostate, std::string, int>;

// An OpenVDB float fog volume: the box of its active voxels, where inactive ones hold the values that the file gives
// them, and no density outside. Voxels may have any three edges. Axes may be swapped and mirrored, which is exact; a
// transform that turns by other than right angles, or shears, by more than the rounding of a float matrix, is bad
// input. A small file can hold a large box of equal voxels: one of more than `most_voxels` is bad input.
GridVolume read_vdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative = Negative::clamp,
                    std::uint64_t most_voxels = max_voxels);

// The samples of a deep EXR that are meant.
struct DeepChoice {
    // Channels "<layer>.A", "<layer>.Z", ...; "": those without a layer. Absent: those without a layer, or, where they
    // are not there, the only layer with alpha and Z.
    std::optional<std::string> layer;
    // A part by its number from 0 on, or by its name. Neither: the only deep one.
    std::variant<std::monostate, std::string, int> part;
};

// A deep EXR: Z and, where present, ZBack; AR, AG and AB, and A for those of them that are not there. A sample without
// a back behind its front (ZBack below Z: 0 often) is a surface. One at infinity, or beyond max_coordinate, is kept and
// lies behind everything; so does what is spread from a nearer Z to there, of which no part is near, unless it is
// opaque: then it is a surface at Z. Files with mip levels are refused before their pixels are read.
DeepImage read_deep_image(const std::filesystem::path& file, const DeepChoice& choice = {});

}  // namespace shadowbench::scene

// Readers of scene files. Each throws Error: no_such_file, io, or bad_input with the line ("file:12") or the byte
// ("file: byte 340") of the fault. Bad input includes a value that is not finite, a count that the file is too short
// for, and a box or index out of range.
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

// TressFX 3 and 4 (.tfx). `radius` is the half-width at every point; it may be 0.
Hair read_tressfx(const std::filesystem::path& file, float radius);

// Cem Yuksel's .hair format (cemyuksel.com/research/hairmodels). The file's thickness is the full width; `radius` > 0
// overrides it.
Hair read_hair(const std::filesystem::path& file, float radius);

struct MeshFile {
    Mesh mesh;
    std::vector<PassedOver> passed_over;
};

// Chooses the format by the extension: .obj, .ply (ASCII and binary, faces and triangle strips), .stl, .gltf, .glb or .pbrt.
// Splits polygons into triangles that cover them once (triangulate.h); a polygon that crosses itself is bad input. A
// file may hold only vertices.
MeshFile read_mesh(const std::filesystem::path& file);

// The alpha channel of an image (its luminance where it has none): PNG, JPEG, TIFF, OpenEXR, DDS or TGA.
AlphaTexture read_alpha(const std::filesystem::path& file);

// The same; nothing for an image without an alpha channel.
std::optional<AlphaTexture> read_alpha_channel(const std::filesystem::path& file);

// How to treat densities below 0, which interpolation and rounding leave in files. clamp: set them all to 0, and report
// their number and the least of them in the volume's notes. refuse: refuse the file. Values that are not finite are
// always refused.
enum class Negative { clamp, refuse };

// Raw values, x fastest, little-endian, of a type of voxel_values.h by its name; see read_raw_values() of grid_files.h.
// The file must have exactly the size that these need. The caller sets the box and step.
GridVolume read_raw_volume(const std::filesystem::path& file, Vec3i size, const std::string& type,
                           Negative negative = Negative::clamp);

// A volume of the V3 library (.pvm: PVM, PVM2 or PVM3, packed or not): densities of 8 bits, or of 16 with the high byte
// first, scaled to [0, 1]. The box begins at the origin; a voxel's edges are the spacing of the file, or 1 without one.
// The caller sets the step. A small file can unpack to a large volume: more than `most_voxels` are bad input.
GridVolume read_pvm(const std::filesystem::path& file, std::uint64_t most_voxels = max_voxels);

// The channel of a texture that holds the density. usual: alpha or, in a texture of a single channel, that one.
// Luminance is red, green and blue.
enum class DdsChannel { usual, red, green, blue, alpha };

// The largest mip level of a DDS volume texture: BC2 or BC3 blocks (DXT3, DXT5), or channels of 8 bits without
// compression. Values are scaled to [0, 1]. The caller sets the box and step.
GridVolume read_dds_volume(const std::filesystem::path& file, DdsChannel channel = DdsChannel::usual,
                           std::uint64_t most_voxels = max_voxels);

// A grid by its name ("density[1]" if several have that name) or by its number from 0 on. Without either: "density" or,
// if no grid has that name, the file's only grid of float values.
using GridChoice = std::variant<std::monostate, std::string, int>;

// An OpenVDB float fog volume: the box of its active voxels. Inactive voxels in the box have the values that the file
// gives them; the density outside is 0. A voxel's edges may differ in length. Axes may be swapped and mirrored, which
// is exact; with a transform that shears, or turns by other than right angles, by more than the rounding of a float
// matrix, the volume has a frame (place_grid.h). A small file can hold a large box of equal voxels: more than
// `most_voxels` are bad input.
GridVolume read_vdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative = Negative::clamp,
                    std::uint64_t most_voxels = max_voxels);

// The same of a NanoVDB file (.nvdb): grids of float, double, Fp4, Fp8, Fp16 or FpN, packed by ZIP, BLOSC or not at
// all.
GridVolume read_nanovdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative = Negative::clamp,
                        std::uint64_t most_voxels = max_voxels);

// Chooses the samples of a deep EXR.
struct DeepChoice {
    // The channels "<layer>.A", "<layer>.Z", ...; "": those without a layer. Absent: those without a layer or, if there
    // are none, the only layer with A and Z.
    std::optional<std::string> layer;
    // A part by its number from 0 on, or by its name. Without either: the only deep one.
    std::variant<std::monostate, std::string, int> part;
};

// A deep EXR: Z and, if present, ZBack; AR, AG and AB, and A for those of them that are missing. A sample whose ZBack
// is below its Z (often 0) is a surface. A sample at infinity, or beyond max_coordinate, is kept and lies behind
// everything. So does a sample that spreads from a nearer Z to infinity, since no part of it is near; but if it is
// opaque, it is a surface at Z. Files with mip levels are refused before their pixels are read.
DeepImage read_deep_image(const std::filesystem::path& file, const DeepChoice& choice = {});

}  // namespace shadowbench::scene

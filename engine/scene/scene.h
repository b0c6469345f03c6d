// The content of a scenario as plain values. World space is right-handed; lengths are in the scene's own unit.
// load_scenario (scenario.h) makes it; every value is finite and inside the range stated beside it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/matrix.h"
#include "base/vec.h"
#include "scene/read_notes.h"

namespace shadowbench::scene {

using base::Box3d;
using base::Vec2d;
using base::Vec2f;
using base::Vec2i;
using base::Vec3d;
using base::Vec3f;
using base::Vec3i;

// An opacity texture, sampled bilinearly, repeated outside [0, 1]^2. Row 0 is v = 1 (image files start at the top).
struct AlphaTexture {
    int width = 0, height = 0;
    std::vector<float> alpha;  // width * height, row after row, in [0, 1]
};
float sample(const AlphaTexture& texture, float u, float v);

// Triangles. A light ray crosses each triangle once, whichever side it comes from.
struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Vec3i> triangles;               // indices into positions
    std::vector<Vec2f> corner_uv;               // 3 for each triangle; empty without a texture
    std::shared_ptr<const AlphaTexture> alpha;  // multiplies the object's opacity; null: no texture
};

// Sphere surfaces: a ray that enters one also leaves it, two crossings.
struct Spheres {
    std::vector<Vec3f> centres;
    std::vector<float> radii;  // > 0
};

// Strands of straight segments; each segment is a ribbon that faces the ray, of the half-width given at its points.
struct Hair {
    std::vector<Vec3f> points;                // strand after strand
    std::vector<float> radii;                 // half-width, one for each point, >= 0
    std::vector<std::uint32_t> strand_begin;  // strands + 1 indices into points
};

// The segments of all strands, each from one point to the next.
struct HairSegments {
    std::vector<std::uint32_t> first;
    std::vector<unsigned char> joined;  // whether an earlier segment of the strand ends where this one starts

    std::size_t bytes() const { return first.capacity() * sizeof(std::uint32_t) + joined.capacity(); }
};
HairSegments segments(const Hair& hair);

// Between the world and the space in which the box of a grid stands along the axes.
struct GridFrame {
    base::Matrix4d to_world, to_grid;
};

// Density on a regular grid, trilinear between voxel centres, 0 outside [lower, upper].
struct GridVolume {
    Vec3i size{0, 0, 0};                   // voxels
    std::vector<float> density;            // x fastest, >= 0
    Vec3d lower{0, 0, 0}, upper{0, 0, 0};  // box; voxel centres are half a voxel inside
    double step = 0.0;                     // for Media::steps; world length along the ray, > 0
    ReadNotes notes{};
    std::optional<GridFrame> frame{};  // absent: the box is in the world
};
void place(GridVolume& volume, const base::Matrix4d& move);  // moves it in the world
Box3d world_box(const GridVolume& volume);
// World lengths: the longest way through the box, and the least distance between neighbouring layers of voxels.
double longest_way(const GridVolume& volume);
double voxel_width(const GridVolume& volume);

// Spheres of a constant medium.
struct Particles {
    std::vector<Vec3f> centres;
    std::vector<float> radii;    // > 0
    std::vector<float> density;  // one for each particle, >= 0
};

// Something that the reader of a file passed over, and how often: {"faces of fewer than 3 corners", 2}.
struct PassedOver {
    std::string what;
    std::uint64_t count = 0;
};

struct Object {
    std::string name;
    bool casts_shadow = true;
    Vec3f opacity{1.0f, 1.0f, 1.0f};     // surfaces: a crossing transmits 1 - opacity, each in [0, 1]
    Vec3f extinction{1.0f, 1.0f, 1.0f};  // media: extinction per unit of density and of length, each >= 0
    Vec3f motion{0.0f, 0.0f, 0.0f};      // while the shutter is open: at time t in [0, 1) the object is at t * motion
    std::variant<Mesh, Spheres, Hair, GridVolume, Particles> shape;
    std::vector<PassedOver> passed_over;  // in its file
};

// Ready-made light rays: one for each pixel, straight along z, with the samples of a deep image. A sample whose z_back
// is beyond base::max_coordinate, or infinite, lies behind everything: no receiver is behind it.
struct DeepImage {
    int width = 0, height = 0;
    std::vector<std::uint64_t> begin;    // width * height + 1 offsets into the samples, row 0 first
    std::vector<float> z_front, z_back;  // a pixel's samples are sorted by z_front, then z_back; z_front <= z_back
    std::vector<float> transmittance;    // `channels` values for each sample: 1 - alpha, in [0, 1]
    int channels = 1;                    // 3 if the channels of any sample differ, else 1
    ReadNotes notes{};
};
bool behind_everything(const DeepImage& image, std::size_t sample);

struct Scene {
    std::vector<Object> objects;
    std::optional<DeepImage> deep_image;  // if present, there are no objects
};

// The width of a lookup's footprint: a square around the receiver, across the light's rays. Only map pixels change with
// the resolution of the map; with the other units, maps of different resolutions answer the same question. Widths are
// measured along the map's x axis, and the footprint is as wide in map pixels along y.
enum class WidthUnit {
    map_pixels,
    share,            // of the map's width
    length,           // world length, at the receiver
    receiver_pixels,  // the side of a square as large as the camera's pixel on the receiver, projected into the map
};
struct FilterWidth {
    WidthUnit unit = WidthUnit::map_pixels;
    double value = 1.0;  // above 0

    bool operator==(const FilterWidth&) const = default;
};

enum class LightType { directional, spot, deep_image };

struct Light {
    std::string name;
    std::string where;  // JSON pointer
    LightType type = LightType::directional;
    Vec3d position{0, 0, 0};    // spot: its position
    Vec3d target{0, 0, 0};      // the point at the middle of the map
    Vec3d direction{0, -1, 0};  // directional: the direction in which the light travels, unit length
    std::optional<Vec3d> up;    // the map's y axis, not along the light; chosen if absent
    Vec3f colour{1, 1, 1};
    std::optional<Vec2d> extent;  // directional: world width and height of the map; absent: the casters' bounds
    std::optional<double> angle;  // spot: full angle across the map's larger side, degrees in (0, 179); absent: fits
    double near = 0.0;            // spot: nearest planar depth; 0: a thousandth of the distance to the target
    std::optional<FilterWidth> softness;  // the width of its lookups; absent: that of the receivers
    std::optional<int> face;  // spot: it is this face of a point light (cube_face.h), and lights only receivers there
    double border = 0.0;      // face: how far its map reaches over its neighbours, as a share of half the face
};

enum class Pattern { regular, jittered };
// How grid volumes become segments of light rays: regular steps, or one exact segment for each voxel cell.
enum class Media { steps, cells };

struct RaySettings {
    Vec2i resolution{256, 256};  // map pixels
    int samples_per_pixel = 16;  // laid out as the most square grid of that many cells
    Pattern pattern = Pattern::jittered;
    Media media = Media::steps;
    std::uint64_t seed = 1;
};

struct Camera {
    Vec3d position{0, 0, 0}, target{0, 0, 0}, up{0, 1, 0};
    double fov = 40.0;  // vertical, degrees
};

// The places where visibility is looked up: what a camera sees (one surface for each pixel, drawn with the probability
// of its contribution, and points inside the media on the way), given points, or points spread evenly over the map and
// the casters' depths.
struct Receivers {
    std::optional<Camera> camera;
    Vec2i resolution{256, 256};  // camera: pixels
    int media_lookups = 8;       // camera: points that a view ray spreads over the media it passes
    std::vector<Vec3d> points;   // given, world space; if empty, a camera or spread points are used
    int count = 65536;           // the number of points to spread
    std::uint64_t seed = 7;      // for the spread points, and for the draw between a pixel's surfaces
    FilterWidth filter_width;
    double bias = 0.0;         // moves every receiver towards the light, world length, >= 0
    double slope_bias = 0.0;   // surfaces that a camera sees: moves them on towards the light, by this many map pixels
                               // times the change of the surface's depth over a map pixel, >= 0
    double normal_bias = 0.0;  // surfaces that a camera sees: moves them along their normal, by this many map pixels
                               // times the sine of the angle between normal and light, >= 0
};

struct Reference {
    int samples_per_pixel = 256;  // of the reference that lookups are compared with
    int queries = 4096;           // how many of the receivers are compared
    int spread_seeds = 4;         // further seeds, which measure the noise of the rays and of each technique
    std::uint64_t seed = 1234567;
};

// Builds and lookups are repeated until the interval of every median is narrow enough, or a limit is reached.
struct Timing {
    int repetitions = 7;        // at least
    int most_repetitions = 31;  // equal: their number is fixed
    double goal = 0.05;         // half width of a 95 % interval over the median, at which it is narrow enough
    double seconds = 20.0;      // for all repetitions of a light beyond the least ones
    int lookups = 65536;        // receivers looked up in one timed pass, at most
};

// One technique with its parameters as written; the technique itself reads them.
struct TechniqueRequest {
    std::string type;
    std::string parameters;  // JSON object without "type"
    std::string where;       // JSON pointer
};

struct Scenario {
    std::string name, purpose;
    Scene scene;
    std::vector<Light> lights;  // that cast shadows: each has a map
    std::vector<Light> fills;   // that cast none: only pictures show them
    RaySettings rays;
    Receivers receivers;
    Reference reference;
    Timing timing;
    std::vector<TechniqueRequest> techniques;
};

constexpr double mid_shutter = 0.5;  // the time at which cameras see the scene

// World bounds of an object without its motion.
Box3d bounds(const Object& object);

// World bounds of the objects that cast shadows (or of all objects) over their whole motion; empty if there are none.
Box3d bounds(const Scene& scene, bool casters_only);

// 3 if the opacities or extinctions of shadow casters, or the deep image's, differ between channels, else 1.
int channels(const Scene& scene);

// What the readers of the scene's files passed over, one line each after its place: "/scene/objects/0: ...". Printable.
std::vector<std::string> read_notes(const Scene& scene);

// The same, which lights have no map, and which have a border that is too narrow for their lookups.
std::vector<std::string> notes(const Scenario& scenario);

// Whether any shadow caster is a medium; whether any moves.
bool has_media(const Scene& scene);
bool has_motion(const Scene& scene);

}  // namespace shadowbench::scene

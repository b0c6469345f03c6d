#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"
#include "scene/procedural.h"
#include "scene/readers/extension.h"
#include "scene/readers/files.h"
#include "scene/readers/grid_files.h"
#include "scene/readers/pbrt_files.h"

namespace shadowbench::scene {
namespace {

void read_box(const json& from, const std::string& where, Vec3d& lower, Vec3d& upper) {
    read(from, "lower", lower);
    read(from, "upper", upper);
    for (int axis = 0; axis < 3; ++axis)
        if (!(upper[axis] - lower[axis] >= min_length))
            refuse(where + "/upper",
                   fmt::format("every coordinate of upper must be above that of lower, by {} at least", min_length));
}

// Sets the box around a volume in the world.
void fit(GridVolume& volume, const Box3d& box) {
    if (!volume.frame) {
        volume.lower = box.min;
        volume.upper = box.max;
        return;
    }
    const Box3d before = world_box(volume);
    if (before == box) return;
    base::Matrix4d stretch;
    for (int axis = 0; axis < 3; ++axis) {
        stretch[axis][axis] = (box.max[axis] - box.min[axis]) / (before.max[axis] - before.min[axis]);
        stretch[3][axis] = box.min[axis] - stretch[axis][axis] * before.min[axis];
    }
    place(volume, stretch);
}

void check_voxels(const Vec3i& size, const std::string& where) {
    const double voxels = static_cast<double>(size.x) * size.y * size.z;
    if (voxels > static_cast<double>(max_voxels))
        refuse(where, fmt::format("{} x {} x {} voxels; the limit is {}", size.x, size.y, size.z, max_voxels));
}

Negative negative_of(const json& from) {
    return from.value("negative", "clamp") == "refuse" ? Negative::refuse : Negative::clamp;
}

GridChoice grid_choice(const json& from) {
    const auto grid = from.find("grid");
    if (grid == from.end()) return {};
    if (grid->is_string()) return grid->get<std::string>();
    return grid->get<int>();
}

enum class VolumeKind { raw, vdb, nanovdb, pvm, dds, nrrd, metaimage, mitsuba, slc, pbrt };

// The reader of a file, by its extension. Raw values may have any other extension too.
struct VolumeFormat {
    std::string_view extension;
    VolumeKind kind;
};
constexpr std::array volume_formats{
    VolumeFormat{".vdb", VolumeKind::vdb},       VolumeFormat{".nvdb", VolumeKind::nanovdb},
    VolumeFormat{".pvm", VolumeKind::pvm},       VolumeFormat{".dds", VolumeKind::dds},
    VolumeFormat{".nrrd", VolumeKind::nrrd},     VolumeFormat{".nhdr", VolumeKind::nrrd},
    VolumeFormat{".mhd", VolumeKind::metaimage}, VolumeFormat{".mha", VolumeKind::metaimage},
    VolumeFormat{".vol", VolumeKind::mitsuba},   VolumeFormat{".slc", VolumeKind::slc},
    VolumeFormat{".pbrt", VolumeKind::pbrt},     VolumeFormat{".raw", VolumeKind::raw},
    VolumeFormat{".gz", VolumeKind::raw}};

// Refuses an unknown extension, unless the scenario says how to read raw values.
VolumeKind volume_kind(const json& from, const std::filesystem::path& file, const std::string& where) {
    const std::string extension = extension_of(file);
    std::vector<std::string_view> known;
    for (const VolumeFormat& format : volume_formats) {
        if (extension == format.extension) return format.kind;
        known.push_back(format.extension);
    }
    if (!extension.empty() && !from.contains("format") && !from.contains("size"))
        refuse(where + "/file", unknown_extension(file, "volume", known) +
                                    ", except as raw values, which need \"format\", \"size\", and \"spacing\" or "
                                    "\"lower\" and \"upper\"");
    return VolumeKind::raw;
}

void refuse_keys(const json& from, const std::string& where, std::initializer_list<const char*> keys,
                 const std::string& message) {
    for (const char* key : keys)
        if (from.contains(key)) refuse(fmt::format("{}/{}", where, key), message);
}

void need_keys(const json& from, const std::string& where, std::initializer_list<const char*> keys, const char* what) {
    for (const char* key : keys)
        if (!from.contains(key)) refuse(where, fmt::format("\"{}\" is missing: {} it", key, what));
}

GridVolume load_raw(const json& from, const std::filesystem::path& file, const std::string& where) {
    need_keys(from, where, {"format", "size"}, "raw values need");
    const bool spaced = from.contains("spacing");
    if (!spaced) need_keys(from, where, {"lower", "upper"}, "raw values without \"spacing\" need");
    if (spaced) refuse_keys(from, where, {"upper"}, "\"size\" and \"spacing\" give this corner; remove this key");
    RawFormat format;
    read(from, "size", format.size);
    check_voxels(format.size, where + "/size");
    format.type = value_type(from["format"].get<std::string>()).value();
    format.order = from.value("byte_order", "little") == "big" ? ByteOrder::big : ByteOrder::little;
    read(from, "skip", format.skip);
    GridVolume volume = read_raw_values(file, format, negative_of(from));
    if (spaced) {
        Vec3d spacing(1, 1, 1);
        read(from, "lower", volume.lower);
        read(from, "spacing", spacing);
        volume.upper = volume.lower + spacing * Vec3d(format.size);
        if (const std::optional<std::string> fault = box_fault(volume.lower, volume.upper))
            refuse(where + "/spacing", *fault);
    }
    return volume;
}

GridVolume load_dds(const json& from, const std::filesystem::path& file, const std::string& where) {
    need_keys(from, where, {"lower", "upper"}, "a .dds file has no world box, so it needs");
    const std::string channel = from.value("channel", "");
    return read_dds_volume(file, channel == "red"     ? DdsChannel::red
                                 : channel == "green" ? DdsChannel::green
                                 : channel == "blue"  ? DdsChannel::blue
                                 : channel == "alpha" ? DdsChannel::alpha
                                                      : DdsChannel::usual);
}

// The volume with the box of its file, if that has one.
GridVolume load_file(const json& from, const std::filesystem::path& file, VolumeKind kind, const std::string& where) {
    switch (kind) {
        case VolumeKind::vdb:
            return read_vdb(file, grid_choice(from), negative_of(from));
        case VolumeKind::nanovdb:
            return read_nanovdb(file, grid_choice(from), negative_of(from));
        case VolumeKind::pvm:
            return read_pvm(file);
        case VolumeKind::slc:
            return read_slc(file).volume;
        case VolumeKind::dds:
            return load_dds(from, file, where);
        case VolumeKind::nrrd:
            return read_nrrd(file, negative_of(from)).volume;
        case VolumeKind::metaimage:
            return read_metaimage(file, negative_of(from)).volume;
        case VolumeKind::mitsuba:
            return read_mitsuba_volume(file, negative_of(from)).volume;
        case VolumeKind::pbrt:
            return read_pbrt_medium(file, grid_choice(from));
        case VolumeKind::raw:
            break;
    }
    return load_raw(from, file, where);
}

// Loads what all procedural grids have: a size, a box and a step.
template <class Parameters>
GridVolume load_procedural(const json& from, const std::string& where, Parameters& parameters,
                           GridVolume (*make)(const Parameters&)) {
    read(from, "size", parameters.size);
    check_voxels(parameters.size, where + "/size");
    read_box(from, where, parameters.lower, parameters.upper);
    return make(parameters);
}

}  // namespace

void read_step(const json& from, const std::string& where, GridVolume& volume) {
    volume.step = 0.5 * voxel_width(volume);
    read(from, "step", volume.step);
    const double longest = longest_way(volume);
    if (longest > max_march_steps * volume.step)
        refuse(where + "/step",
               fmt::format("a step of {} crosses the volume in more than {} steps: make it at least {:.3g}",
                           volume.step, max_march_steps, longest / max_march_steps));
}

GridVolume load_volume(const json& from, const SearchPath& path, const std::string& where) {
    const std::filesystem::path file = find_file(path, from["file"].get<std::string>(), where + "/file");
    const VolumeKind kind = volume_kind(from, file, where);
    if (kind == VolumeKind::pbrt && negative_of(from) == Negative::refuse)
        refuse(where + "/negative", "densities below 0 of a .pbrt file count as 0; remove this key");
    const bool placed = kind == VolumeKind::vdb || kind == VolumeKind::nanovdb || kind == VolumeKind::pbrt;
    if (!placed)
        refuse_keys(from, where, {"grid"}, "only .vdb, .nvdb and .pbrt files have named grids; remove this key");
    if (kind != VolumeKind::dds)
        refuse_keys(from, where, {"channel"}, "only .dds files have channels; remove this key");
    if (kind != VolumeKind::raw)
        refuse_keys(from, where, {"format", "size", "byte_order", "skip", "spacing"},
                    fmt::format("a {} file has its own; remove this key", file.extension().string()));
    if (placed)
        refuse_keys(from, where, {"lower", "upper"},
                    fmt::format("a {} file has its own; remove this key", file.extension().string()));
    GridVolume volume = load_file(from, file, kind, where);
    if (!placed) {
        Box3d box = world_box(volume);
        read_box(from, where, box.min, box.max);
        fit(volume, box);
    }
    return volume;
}

GridVolume load_cloud(const json& from, const std::string& where) {
    Cloud cloud;
    read(from, "octaves", cloud.octaves);
    read(from, "coverage", cloud.coverage);
    read(from, "seed", cloud.seed);
    return load_procedural(from, where, cloud, make_cloud);
}

GridVolume load_density_box(const json& from, const std::string& where) {
    DensityBox box;
    return load_procedural(from, where, box, make_density_box);
}

GridVolume load_crossed_rods(const json& from, const std::string& where) {
    CrossedRods rods;
    read(from, "radius", rods.radius);
    return load_procedural(from, where, rods, make_crossed_rods);
}

}  // namespace shadowbench::scene

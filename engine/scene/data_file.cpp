#include "scene/data_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene/load.h"
#include "scene/readers/extension.h"
#include "scene/readers/grid_files.h"
#include "scene/readers/hair_files.h"
#include "scene/readers/kinds.h"
#include "scene/readers/pbrt_files.h"
#include "scene/readers/point_files.h"
#include "scene/readers/text_lines.h"
#include "scene/readers/unpacked_bytes.h"
#include "scene/stage.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

void add_object(DataFile& data, decltype(Object::shape) shape, std::vector<PassedOver> passed_over = {}) {
    Object object;
    object.shape = std::move(shape);
    object.passed_over = std::move(passed_over);
    data.scene.objects.push_back(std::move(object));
}

void read_mesh_file(DataFile& data) {
    MeshFile file = read_mesh(data.file);
    add_object(data, std::move(file.mesh), std::move(file.passed_over));
}

// Of hair without a width; see guessed_radius.
float guess_radius(const Hair& hair) {
    Box3d box;
    for (const Vec3f& point : hair.points) box.extendBy(Vec3d(point));
    if (box.isEmpty()) return 0.0f;
    const auto strands = static_cast<double>(hair.strand_begin.size() - 1);
    const double share = std::clamp(0.05 / std::sqrt(strands), 1.0 / 2000.0, 1.0 / 50.0);
    return static_cast<float>(to_digits(box.size().length() * share, 1));
}

void read_hair_file(DataFile& data) {
    HairFile file = read_strands(data.file, 0.0f);
    Hair& hair = file.hair;
    const auto strands = [&] { return hair.strand_begin.empty() ? std::size_t{0} : hair.strand_begin.size() - 1; };
    data.guessed_radius = std::none_of(hair.radii.begin(), hair.radii.end(), [](float radius) { return radius > 0; });
    if (data.guessed_radius) hair.radii.assign(hair.points.size(), guess_radius(hair));
    const std::size_t all = strands();
    merge_equal_points(hair);
    data.short_strands = all - strands();
    add_object(data, std::move(hair), std::move(file.passed_over));
}

// Of points on a surface; see guessed_radius.
float guess_radius(const Particles& points) {
    Box3d box;
    for (const Vec3f& centre : points.centres) box.extendBy(Vec3d(centre));
    if (box.isEmpty()) return 0.0f;
    const double size = std::max(box.size().length(), min_length);
    return static_cast<float>(to_digits(0.5 * size / std::sqrt(static_cast<double>(points.centres.size())), 1));
}

void read_point_file(DataFile& data) {
    PointFile file = read_points(data.file, 0.0f);
    data.guessed_radius = !file.has_radii;
    if (data.guessed_radius) file.points.radii.assign(file.points.centres.size(), guess_radius(file.points));
    add_object(data, std::move(file.points), std::move(file.passed_over));
}

void read_vdb_file(DataFile& data) {
    VdbFacts facts;
    add_object(data, read_vdb(data.file, data.choice.grid, Negative::clamp, max_voxels, facts));
    data.vdb = std::move(facts);
}

void read_nanovdb_file(DataFile& data) {
    VdbFacts facts;
    add_object(data, read_nanovdb(data.file, data.choice.grid, Negative::clamp, max_voxels, facts));
    data.vdb = std::move(facts);
}

void read_pvm_file(DataFile& data) {
    add_object(data, read_pvm(data.file));
}

void add_grid(DataFile& data, GridFile file) {
    data.facts = std::move(file.facts);
    add_object(data, std::move(file.volume));
}

void read_nrrd_file(DataFile& data) {
    add_grid(data, read_nrrd(data.file));
}

void read_metaimage_file(DataFile& data) {
    add_grid(data, read_metaimage(data.file));
}

void read_mitsuba_file(DataFile& data) {
    add_grid(data, read_mitsuba_volume(data.file));
}

void read_slc_file(DataFile& data) {
    add_grid(data, read_slc(data.file));
}

void add_without_box(DataFile& data, GridVolume volume) {
    volume.upper = Vec3d(volume.size);
    data.no_box = true;
    add_object(data, std::move(volume));
}

void read_dds_file(DataFile& data) {
    add_without_box(data, read_dds_volume(data.file));
}

void read_raw_file(DataFile& data) {
    const bool packed = extension_of(data.file) == ".gz";
    const RawLayout layout = raw_layout(data.file, packed ? gzip_bytes(data.file) : data.bytes);
    data.raw_type = layout.type;
    data.facts.push_back(fmt::format("read as {}, little-endian, {}", layout.type,
                                     layout.type_stated ? "as its name says" : "the type that fills the file"));
    add_without_box(data, read_raw_volume(data.file, layout.size, layout.type));
}

void read_deep_file(DataFile& data) {
    data.scene.deep_image = read_deep_image(data.file, data.choice.deep);
}

// An object of each type that the scene has something for; what is passed over is told with the first.
void read_pbrt_file(DataFile& data) {
    PbrtFile scene = read_pbrt(data.file);
    const std::size_t curves = scene.hair.strand_begin.size() - 1;
    merge_equal_points(scene.hair);
    data.short_strands = curves - (scene.hair.strand_begin.size() - 1);
    data.facts = std::move(scene.facts);
    if (scene.hair.strand_begin.size() > 1) add_object(data, std::move(scene.hair));
    if (!scene.particles.centres.empty()) add_object(data, std::move(scene.particles));
    for (PbrtMedium& medium : scene.media) {
        add_object(data, std::move(medium.volume));
        data.scene.objects.back().name = std::move(medium.name);
    }
    if (!scene.mesh.triangles.empty() || data.scene.objects.empty()) add_object(data, std::move(scene.mesh));
    data.scene.objects[0].passed_over = std::move(scene.passed_over);
}

void read_texture_file(DataFile& data) {
    auto texture = std::make_shared<const AlphaTexture>(read_alpha(data.file));
    const float half = 0.5f * static_cast<float>(texture->width) / static_cast<float>(texture->height);
    Mesh quad;
    quad.positions = {Vec3f(-half, 0, 0), Vec3f(half, 0, 0), Vec3f(half, 1, 0), Vec3f(-half, 1, 0)};
    quad.triangles = {Vec3i(0, 1, 2), Vec3i(0, 2, 3)};
    quad.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    quad.alpha = std::move(texture);
    add_object(data, std::move(quad));
}

constexpr const char* texture_title = "image, an alpha texture";

constexpr std::array formats{
    FileFormat{".obj", "Wavefront OBJ mesh", "mesh", nullptr, read_mesh_file},
    FileFormat{".ply", "PLY point cloud", "particles", is_point_cloud, read_point_file},
    FileFormat{".ply", "PLY mesh", "mesh", nullptr, read_mesh_file},
    FileFormat{".stl", "STL mesh", "mesh", nullptr, read_mesh_file},
    FileFormat{".gltf", "glTF mesh", "mesh", nullptr, read_mesh_file},
    FileFormat{".glb", "binary glTF mesh", "mesh", nullptr, read_mesh_file},
    FileFormat{".tfx", "TressFX hair", "hair", nullptr, read_hair_file},
    FileFormat{".txt", "strands in text, as of Mitsuba", "hair", nullptr, read_hair_file},
    FileFormat{".hair", "hair in Mitsuba's format", "hair", is_mitsuba_hair, read_hair_file},
    FileFormat{".hair", "hair in Cem Yuksel's format", "hair", nullptr, read_hair_file},
    FileFormat{".vdb", "OpenVDB grid", "volume", nullptr, read_vdb_file},
    FileFormat{".nvdb", "NanoVDB grid", "volume", nullptr, read_nanovdb_file},
    FileFormat{".pvm", "volume of the V3 library", "volume", nullptr, read_pvm_file},
    FileFormat{".dds", "DDS volume texture", "volume", is_dds_volume, read_dds_file},
    FileFormat{".nrrd", "NRRD volume", "volume", nullptr, read_nrrd_file},
    FileFormat{".nhdr", "header of an NRRD volume", "volume", nullptr, read_nrrd_file},
    FileFormat{".mha", "MetaImage volume", "volume", nullptr, read_metaimage_file},
    FileFormat{".mhd", "header of a MetaImage volume", "volume", nullptr, read_metaimage_file},
    FileFormat{".vol", "volume of Mitsuba", "volume", nullptr, read_mitsuba_file},
    FileFormat{".slc", "volume of VolVis", "volume", nullptr, read_slc_file},
    FileFormat{".raw", "volume of raw values", "volume", nullptr, read_raw_file},
    FileFormat{".gz", "volume of packed raw values", "volume", nullptr, read_raw_file},
    FileFormat{".pbrt", "pbrt scene", several_objects, nullptr, read_pbrt_file},
    FileFormat{".exr", "deep OpenEXR image", "deep_image", is_deep_image, read_deep_file},
    FileFormat{".exr", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".dds", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".png", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".jpg", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".jpeg", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".tif", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".tiff", texture_title, "quad", nullptr, read_texture_file},
    FileFormat{".tga", texture_title, "quad", nullptr, read_texture_file},
};

const FileFormat& format_of_file(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    std::vector<std::string_view> known;
    for (const FileFormat& format : formats) {
        if (extension == format.extension && (!format.is || format.is(file))) return format;
        if (std::find(known.begin(), known.end(), format.extension) == known.end()) known.push_back(format.extension);
    }
    throw Error(ErrorCode::bad_input, file.string(), unknown_extension(file, "data", known));
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// The size that "ball_32x32x24" states.
std::optional<Vec3i> size_in(std::string_view name) {
    const char* const end = name.data() + name.size();
    for (std::size_t at = 0; at < name.size(); ++at) {
        if (!is_digit(name[at]) || (at > 0 && is_digit(name[at - 1]))) continue;
        Vec3i size(0, 0, 0);
        const char* from = name.data() + at;
        int axis = 0;
        for (; axis < 3; ++axis) {
            if (axis > 0 && (from == end || (*from++ | 0x20) != 'x')) break;
            const auto [next, fault] = std::from_chars(from, end, size[axis]);
            if (fault != std::errc() || size[axis] < 1) break;
            from = next;
        }
        if (axis == 3) return size;
    }
    return std::nullopt;
}

// The type that "ball_32x32x24_int16" states.
std::optional<ValueType> type_in(std::string_view name) {
    const auto is_letter = [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
    const std::string text = lower_case(name);
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (!is_letter(text[at]) || (at > 0 && (is_letter(text[at - 1]) || is_digit(text[at - 1])))) continue;
        std::size_t end = at;
        while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
        if (const std::optional<ValueType> type = value_type(std::string_view(text).substr(at, end - at))) return type;
    }
    return std::nullopt;
}

// The cube whose number of voxels is nearest.
Vec3i cube(std::uint64_t voxels) {
    const int side = static_cast<int>(std::lround(std::cbrt(static_cast<double>(voxels))));
    return {side, side, side};
}

double voxels_of(const Vec3i& size) {
    return static_cast<double>(size.x) * size.y * size.z;
}

}  // namespace

std::span<const FileFormat> file_formats() {
    return formats;
}

const FileFormat* format_of_name(const std::filesystem::path& name) {
    const std::string extension = extension_of(name);
    const auto formats = file_formats();
    const auto found = std::find_if(formats.begin(), formats.end(),
                                    [&](const FileFormat& format) { return format.extension == extension; });
    return found == formats.end() ? nullptr : &*found;
}

DataFile read_data_file(const std::filesystem::path& file, const FileChoice& choice) {
    std::error_code fault;
    if (!std::filesystem::exists(file, fault))
        throw Error(ErrorCode::no_such_file, file.string(), "there is no such file");
    if (!std::filesystem::is_regular_file(file, fault))
        throw Error(ErrorCode::io, file.string(), "only a regular file can be read");
    DataFile data;
    data.file = file;
    data.choice = choice;
    data.bytes = std::filesystem::file_size(file, fault);
    if (fault) throw Error(ErrorCode::io, file.string(), "cannot be read: " + fault.message());
    data.format = &format_of_file(file);
    data.format->read(data);
    return data;
}

RawLayout raw_layout(const std::filesystem::path& file, std::uint64_t bytes) {
    const std::string name = file.stem().string();
    const std::optional<Vec3i> stated = size_in(name);
    const std::optional<ValueType> stated_type = type_in(name);
    std::vector<ValueType> types{ValueType::uint8, ValueType::float32};
    if (stated_type) types.assign(1, *stated_type);
    for (const ValueType type : types) {
        const std::uint64_t bytes_each = bytes_of_value(type);
        const Vec3i size = stated ? *stated : cube(bytes / bytes_each);
        const double voxels = voxels_of(size);
        if (voxels * static_cast<double>(bytes_each) != static_cast<double>(bytes) || voxels < 1.0) continue;
        if (voxels > static_cast<double>(max_voxels))
            throw Error(ErrorCode::bad_input, file.string(),
                        fmt::format("{} x {} x {} voxels; the limit is {}", size.x, size.y, size.z, max_voxels));
        return {size, std::string(name_of(type)), stated_type.has_value()};
    }
    const std::string held = stated_type ? std::string(name_of(*stated_type)) : "uint8 or float32";
    if (stated)
        throw Error(ErrorCode::bad_input, file.string(),
                    fmt::format("the name states {} x {} x {} voxels, but the file has {} bytes, which are not as many "
                                "of {}: state the type in the name, as in ball_32x32x24_int16.raw, or write a volume "
                                "with \"format\", \"size\" and \"skip\" into a scenario",
                                stated->x, stated->y, stated->z, bytes, held));
    throw Error(ErrorCode::bad_input, file.string(),
                fmt::format("{} bytes of raw values are no cube of {}: state the size and the type in the name of the "
                            "file, as in ball_32x32x24_int16.raw, or write a volume with \"format\", \"size\" and "
                            "\"spacing\" into a scenario",
                            bytes, held));
}

Box3d bounds(const DataFile& data) {
    Box3d box = bounds(data.scene, false);
    if (!box.isEmpty()) return box;
    for (const Object& object : data.scene.objects)
        if (const auto* mesh = std::get_if<Mesh>(&object.shape))
            for (const Vec3f& position : mesh->positions) box.extendBy(Vec3d(position));
    return box;
}

bool casts_shadow(const Object& object) {
    const auto any = [](const std::vector<float>& values) {
        return std::any_of(values.begin(), values.end(), [](float value) { return value > 0.0f; });
    };
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) return !mesh->triangles.empty();
    if (const auto* hair = std::get_if<Hair>(&object.shape)) return hair->strand_begin.size() > 1;
    if (const auto* points = std::get_if<Particles>(&object.shape)) return any(points->density);
    const auto* volume = std::get_if<GridVolume>(&object.shape);
    return volume && any(volume->density);
}

bool casts_shadow(const DataFile& data) {
    if (!data.scene.deep_image)
        return std::any_of(data.scene.objects.begin(), data.scene.objects.end(),
                           [](const Object& object) { return casts_shadow(object); });
    const DeepImage& image = *data.scene.deep_image;
    for (std::size_t sample = 0; sample < image.z_front.size(); ++sample)
        if (!behind_everything(image, sample)) return true;
    return false;
}

}  // namespace shadowbench::scene

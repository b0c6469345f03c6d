// What readers hold while they read. A file of a gigabyte would need two if its values were held twice.
#include <openvdb/openvdb.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "scene/readers/files.h"
#include "scene/readers/grid_files.h"
#include "scene/readers/hair_files.h"
#include "scene/support.h"
#include "techniques/live_bytes.h"

namespace shadowbench::scene {
namespace {

constexpr int side = 128;  // voxels: 8 MiB of densities
constexpr double voxels = double{side} * side * side;

// The most that is held at once while `read` runs, over so many bytes.
double peak_over(double bytes, const std::function<void()>& read) {
    techniques::testing::forget_peak();
    const std::size_t before = techniques::testing::live_bytes();
    read();
    return static_cast<double>(techniques::testing::peak_bytes() - before) / bytes;
}

double peak_over_densities(const std::function<GridVolume()>& read) {
    return peak_over(voxels * sizeof(float),
                     [&] { EXPECT_EQ(read().density.size(), static_cast<std::size_t>(voxels)); });
}

// Every voxel differs, so that the grid has a leaf for all of them and none is a tile.
openvdb::FloatGrid::Ptr full_grid(const openvdb::math::Transform::Ptr& transform) {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setTransform(transform);
    for (int x = 0; x < side; x += 8)
        for (int y = 0; y < side; y += 8)
            for (int z = 0; z < side; z += 8) {
                auto* leaf = grid->tree().touchLeaf({x, y, z});
                leaf->setValuesOn();
                for (openvdb::Index i = 0; i < 512; ++i)
                    leaf->setValueOnly(i, static_cast<float>(1 + x + y + z) + static_cast<float>(i) / 512.0f);
            }
    return grid;
}

std::filesystem::path write_vdb(const openvdb::FloatGrid::Ptr& grid) {
    const std::filesystem::path path = test::fresh_path("a.vdb");
    openvdb::io::File file(path.string());
    file.setCompression(openvdb::io::COMPRESS_NONE);
    file.write({grid});
    file.close();
    return path;
}

// The library would hold the whole tree beside them.
TEST(ReaderMemory, VdbIsNotHeldBesideItsDensities) {
    const auto straight = write_vdb(full_grid(openvdb::math::Transform::createLinearTransform(0.5)));
    EXPECT_LT(peak_over_densities([&] { return read_vdb(straight, {}); }), 1.25);
}

TEST(ReaderMemory, TurnedGridsAreNotHeldTwice) {
    const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
    transform->postRotate(0.5, openvdb::math::Z_AXIS);
    const auto turned = write_vdb(full_grid(transform));
    EXPECT_LT(peak_over_densities([&] { return read_vdb(turned, {}); }), 1.25);
}

TEST(ReaderMemory, ValuesOfHeadersAndRawFilesAreReadInBlocks) {
    const std::string values(static_cast<std::size_t>(voxels) * sizeof(float), '\x3e');
    const auto raw = test::write_file("a.raw", values);
    EXPECT_LT(peak_over_densities([&] { return read_raw_volume(raw, {side, side, side}, "float32"); }), 1.1);
    const auto nrrd = test::write_file("a.nrrd",
                                       "NRRD0004\ntype: float\ndimension: 3\nsizes: 128 128 128\n"
                                       "encoding: raw\nendian: little\n\n" +
                                           values);
    EXPECT_LT(peak_over_densities([&] { return read_nrrd(nrrd).volume; }), 1.1);
}

// The bytes of a file and the densities of 16 bits that it holds take half as much again as the densities.
TEST(ReaderMemory, PvmTakesHalfAsMuchAgain) {
    const std::string values(static_cast<std::size_t>(voxels) * 2, '\x3e');
    const auto pvm = test::write_file("a.pvm", "PVM\n128 128 128\n2\n" + values);
    EXPECT_LT(peak_over_densities([&] { return read_pvm(pvm); }), 1.51);
}

constexpr std::uint32_t strands = 1 << 10, per_strand = 1 << 9;
constexpr std::uint64_t hair_points = std::uint64_t{strands} * per_strand;
constexpr double hair_bytes = 16.0 * static_cast<double>(hair_points);

void expect_hair_is_held_once(const std::function<Hair()>& read) {
    EXPECT_LT(peak_over(hair_bytes, [&] { EXPECT_EQ(read().points.size(), hair_points); }), 1.2);
}

// Each would hold the floats of the file beside the points that it makes of them: another three quarters.
TEST(ReaderMemory, HairIsReadInBlocks) {
    using test::bytes_of;
    const std::string positions(hair_points * 12, '\x3e'), thickness(hair_points * 4, '\x3e');
    std::string head = "HAIR" + bytes_of(strands, static_cast<std::uint32_t>(hair_points), std::uint32_t{2 | 4},
                                         per_strand - 1, 0.5f, 0.0f, 1.0f, 1.0f, 1.0f);
    const auto hair = test::write_file("a.hair", head + std::string(88, ' ') + positions + thickness);
    expect_hair_is_held_once([&] { return read_hair(hair, 0.0f); });

    head = bytes_of(3.0f, strands, per_strand);
    head.resize(296, '\0');
    const auto tressfx = test::write_file("a.tfx", head + positions);
    expect_hair_is_held_once([&] { return read_tressfx(tressfx, 1.0f); });

    const auto mitsuba =
        test::write_file("b.hair", "BINARY_HAIR" + bytes_of(static_cast<std::uint32_t>(hair_points)) + positions);
    expect_hair_is_held_once([&] { return read_mitsuba_hair(mitsuba, 1.0f).hair; });
}

// A grid of quads, each split in two.
constexpr int quads = 512;  // along a side
constexpr std::size_t vertices = std::size_t{quads + 1} * (quads + 1), triangles = std::size_t{2} * quads * quads;
constexpr double mesh_bytes = 12.0 * static_cast<double>(vertices + triangles);

template <class Triangle>
void for_each_triangle(const Triangle& triangle) {
    for (int y = 0; y < quads; ++y)
        for (int x = 0; x < quads; ++x) {
            const int corner = y * (quads + 1) + x;
            triangle(corner, corner + 1, corner + quads + 1);
            triangle(corner + 1, corner + quads + 2, corner + quads + 1);
        }
}

std::string positions() {
    std::string bytes;
    for (int y = 0; y <= quads; ++y)
        for (int x = 0; x <= quads; ++x) bytes += test::bytes_of(static_cast<float>(x), static_cast<float>(y), 0.0f);
    return bytes;
}

double mesh_peak(double bytes, const std::filesystem::path& file) {
    return peak_over(bytes, [&] {
        const Mesh mesh = read_mesh(file).mesh;
        EXPECT_EQ(mesh.positions.size(), vertices);
        EXPECT_EQ(mesh.triangles.size(), triangles);
        EXPECT_EQ(mesh.triangles.back(), Vec3i(static_cast<int>(vertices) - quads - 2, static_cast<int>(vertices) - 1,
                                               static_cast<int>(vertices) - 2));
    });
}

// The file would be held beside it, as large as the mesh.
TEST(ReaderMemory, PlyIsReadInBlocks) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices, triangles);
    bytes += positions();
    for_each_triangle([&](int a, int b, int c) { bytes += '\x03' + test::bytes_of(a, b, c); });
    EXPECT_LT(mesh_peak(mesh_bytes, test::write_file("a.ply", bytes)), 1.15);
}

// Each mesh would be held once as in the file and once as its nodes place it, and its indices beside them.
TEST(ReaderMemory, MeshesOfGltfAreReadIntoTheirPlace) {
    std::string bytes = positions();
    for_each_triangle([&](int a, int b, int c) { bytes += test::bytes_of(a, b, c); });
    std::string document = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[)"
        R"({{"buffer":0,"byteOffset":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],"accessors":[)"
        R"({{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
        R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"nodes":[{{"mesh":0}}]}})",
        bytes.size(), 12 * vertices, 12 * vertices, 12 * triangles, vertices, 3 * triangles);
    document.resize((document.size() + 3) / 4 * 4, ' ');
    const auto size = [](std::size_t number) { return test::bytes_of(static_cast<std::uint32_t>(number)); };
    const auto file =
        test::write_file("a.glb", "glTF" + size(2) + size(28 + document.size() + bytes.size()) + size(document.size()) +
                                      "JSON" + document + size(bytes.size()) + std::string("BIN\0", 4) + bytes);
    EXPECT_LT(mesh_peak(mesh_bytes, file), 1.25);
}

// A copy of the lines, and all faces before they are split, would take more than twice the text.
TEST(ReaderMemory, ObjHoldsItsTextAndTheMesh) {
    std::string text;
    for (int y = 0; y <= quads; ++y)
        for (int x = 0; x <= quads; ++x) text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", 0.001 * x, 0.001 * y, 0.0);
    for_each_triangle([&](int a, int b, int c) { text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1); });
    const auto file = test::write_file("a.obj", text);
    EXPECT_LT(mesh_peak(static_cast<double>(text.size()) + mesh_bytes, file), 1.6);
}

}  // namespace
}  // namespace shadowbench::scene

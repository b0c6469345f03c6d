// What readers hold while they read. A file of a gigabyte would need two if its values were held twice.
#include <openvdb/openvdb.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "scene/readers/files.h"
#include "scene/readers/grid_files.h"
#include "scene/support.h"
#include "techniques/live_bytes.h"

namespace shadowbench::scene {
namespace {

constexpr int side = 128;  // voxels: 8 MiB of densities
constexpr double voxels = double{side} * side * side;

// The most that is held at once, over the bytes of the densities.
double peak_over_densities(const std::function<GridVolume()>& read) {
    techniques::testing::forget_peak();
    const std::size_t before = techniques::testing::live_bytes();
    const GridVolume volume = read();
    EXPECT_EQ(volume.density.size(), static_cast<std::size_t>(voxels));
    return static_cast<double>(techniques::testing::peak_bytes() - before) / (voxels * sizeof(float));
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

}  // namespace
}  // namespace shadowbench::scene

// Volumes and deep images in tests/cases: what their readers give, and where it lies. tests/bench/file_values_test.cpp
// takes the same files through the engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>

#include "scene/readers/files.h"
#include "scene/readers/grid_files.h"

namespace shadowbench::scene {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path case_file(const char* name) {
    return std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases" / name;
}

struct BoxCase {
    const char* file;
    int side;  // voxels along each axis
    Vec3d lower, upper;
};

// The box of a grid without its turn, or with voxels of one edge for all axes, would lie elsewhere.
TEST(ReadCases, BoxesOfDensityOneHalfLieWhereTheirTransformsPutThem) {
    const Vec3d origin(-0.5, -0.5, -0.5), end(15.5, 15.5, 15.5);
    for (const BoxCase& box :
         {BoxCase{"noname.vdb", 16, origin, end},
          BoxCase{"rot90.vdb", 16, Vec3d(-0.5, -15.5, -0.5), Vec3d(15.5, 0.5, 15.5)},  // a quarter turn about x
          BoxCase{"yzswap.vdb", 16, origin, end},
          BoxCase{"nonuniform.vdb", 16, Vec3d(0.95, 1.9, 2.85), Vec3d(2.55, 5.1, 7.65)},  // edges of 0.1, 0.2 and 0.3
          BoxCase{"tile.vdb", 64, origin, Vec3d(63.5, 63.5, 63.5)}}) {
        SCOPED_TRACE(box.file);
        const GridVolume volume = read_vdb(case_file(box.file), {});
        EXPECT_EQ(volume.size, Vec3i(box.side, box.side, box.side));
        EXPECT_THAT(volume.density, Each(0.5f));
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(volume.lower[axis], box.lower[axis], 1e-9);
            EXPECT_NEAR(volume.upper[axis], box.upper[axis], 1e-9);
        }
    }
}

TEST(ReadCases, ADensityJustBelow0IsTakenAs0AndCounted) {
    const GridVolume volume = read_vdb(case_file("tinyneg.vdb"), {});
    EXPECT_EQ(std::count(volume.density.begin(), volume.density.end(), 0.0f), 1);
    EXPECT_EQ(std::count(volume.density.begin(), volume.density.end(), 0.5f), 4095);
    EXPECT_THAT(volume.notes.lines, ElementsAre(HasSubstr("1 of 4096 densities are below 0, the least -1e-06")));
}

// A gradient along each axis, of several types, byte orders and packings: the density of voxel (x, y, z) is
// (x + 4 y + 16 z) / 64.
TEST(ReadCases, ARampIsTheSameInEveryFormat) {
    for (const char* name : {"ramp.nrrd", "ramp.nhdr", "ramp.mha", "ramp.mhd", "ramp.vol"}) {
        SCOPED_TRACE(name);
        const std::string extension = case_file(name).extension().string();
        const GridVolume volume = (extension == ".vol"                          ? read_mitsuba_volume(case_file(name))
                                   : extension == ".mha" || extension == ".mhd" ? read_metaimage(case_file(name))
                                                                                : read_nrrd(case_file(name)))
                                      .volume;
        EXPECT_EQ(volume.size, Vec3i(4, 4, 4));
        ASSERT_EQ(volume.density.size(), 64u);
        for (std::size_t v = 0; v < 64; ++v) EXPECT_EQ(volume.density[v], static_cast<float>(v) / 64.0f);
        EXPECT_EQ(volume.lower, Vec3d(0, 0, 0));
        EXPECT_EQ(volume.upper, Vec3d(4, 8, 2));
        EXPECT_TRUE(volume.notes.lines.empty());
    }
    const GridVolume grid = read_nanovdb(case_file("ramp.nvdb"), {}), slices = read_slc(case_file("ramp.slc")).volume,
                     bytes = read_pvm(case_file("ramp.pvm")), texture = read_dds_volume(case_file("ramp.dds"));
    for (const GridVolume* volume : {&grid, &slices, &bytes}) {
        EXPECT_EQ(volume->size, Vec3i(4, 4, 4));
        EXPECT_EQ(volume->lower, Vec3d(0, 0, 0));
        EXPECT_EQ(volume->upper, Vec3d(4, 8, 2));
    }
    for (std::size_t v = 0; v < 64; ++v) {
        EXPECT_EQ(grid.density[v], static_cast<float>(v) / 64.0f);
        for (const GridVolume* volume : {&slices, &bytes, &texture})
            EXPECT_EQ(volume->density[v], static_cast<float>(v) / 255.0f);
    }
    EXPECT_EQ(texture.size, Vec3i(4, 4, 4));
    for (const char* name : {"ramp_4x4x4_float32.raw", "ramp_4x4x4_float32.raw.gz"})
        EXPECT_EQ(read_raw_volume(case_file(name), {4, 4, 4}, "float32").density, grid.density) << name;
}

TEST(ReadCases, DeepSamplesKeepTheirDepths) {
    const DeepImage far = read_deep_image(case_file("inf.exr"));
    ASSERT_EQ(far.z_front.size(), 128u);
    for (std::size_t s = 0; s < 128; s += 2) {
        ASSERT_EQ(far.z_front[s], 3.0f);
        ASSERT_FALSE(behind_everything(far, s));
        ASSERT_TRUE(behind_everything(far, s + 1));
    }
    for (const char* file : {"layered.exr", "zback0.exr"}) {
        SCOPED_TRACE(file);
        const DeepImage image = read_deep_image(case_file(file));
        EXPECT_EQ(image.z_front.size(), 64u);
        EXPECT_THAT(image.z_front, Each(3.0f));
        EXPECT_THAT(image.z_back, Each(3.0f));
        EXPECT_THAT(image.transmittance, Each(0.5f));
    }
}

}  // namespace
}  // namespace shadowbench::scene

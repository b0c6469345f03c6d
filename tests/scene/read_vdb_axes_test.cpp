// Grids whose axes are swapped, mirrored, stretched, turned and sheared, against their transforms in double.
#include <openvdb/openvdb.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::HasSubstr;

const openvdb::Coord first(-3, 7, -11), size(5, 11, 19);  // more than one leaf, and no two axes alike

// The density of a voxel encodes its index.
openvdb::FloatGrid::Ptr grid_with(const openvdb::math::Mat4d& matrix) {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    for (int x = 0; x < size.x(); ++x)
        for (int y = 0; y < size.y(); ++y)
            for (int z = 0; z < size.z(); ++z)
                grid->tree().setValue(first.offsetBy(x, y, z), static_cast<float>(1 + x + 100 * y + 10000 * z));
    return grid;
}

GridVolume written_and_read(const openvdb::FloatGrid::Ptr& grid) {
    const std::filesystem::path path = test::fresh_path("a.vdb");
    openvdb::io::File file(path.string());
    file.write({grid});
    file.close();
    return read_vdb(path, "density");
}

// Index axis i runs along world axis order[i], by `step[i]` a voxel.
openvdb::math::Mat4d matrix_of(const std::array<int, 3>& order, const std::array<double, 3>& step) {
    openvdb::math::Mat4d matrix = openvdb::math::Mat4d::zero();
    for (int i = 0; i < 3; ++i) matrix[i][order[static_cast<std::size_t>(i)]] = step[static_cast<std::size_t>(i)];
    const std::array<double, 4> shift{10.5, -20.25, 3.125, 1.0};
    for (int i = 0; i < 4; ++i) matrix[3][i] = shift[static_cast<std::size_t>(i)];
    return matrix;
}

// Trilinear between voxel centres, at positions with all eight neighbours.
template <class Value>
double trilinear(const std::array<double, 3>& index, const Value& value) {
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        std::array<int, 3> at{};
        double weight = 1.0;
        for (std::size_t a = 0; a < 3; ++a) {
            const int up = corner >> a & 1;
            const double below = std::floor(index[a]);
            at[a] = static_cast<int>(below) + up;
            weight *= up ? index[a] - below : 1.0 - (index[a] - below);
        }
        if (weight != 0.0) sum += weight * value(at);
    }
    return sum;
}

// At random points the volume has the grid's value at the point that its transform gives.
void expect_same_field(const openvdb::FloatGrid& grid, const GridVolume& volume, double tolerance) {
    const Vec3d extent = volume.upper - volume.lower;
    base::Random random(5);
    for (int n = 0; n < 300; ++n) {
        openvdb::Vec3d index;
        for (int a = 0; a < 3; ++a) index[a] = first[a] + random.uniform(0.001, size[a] - 1.001);
        const openvdb::Vec3d there = grid.transform().indexToWorld(index);
        Vec3d world(there.x(), there.y(), there.z());
        ASSERT_TRUE(world_box(volume).intersects(world));
        if (volume.frame) world = base::map_point(volume.frame->to_grid, world);
        std::array<double, 3> place{};
        for (int a = 0; a < 3; ++a)
            place[static_cast<std::size_t>(a)] = (world[a] - volume.lower[a]) / extent[a] * volume.size[a] - 0.5;
        const double wanted = trilinear({index.x(), index.y(), index.z()}, [&](const std::array<int, 3>& at) {
            return static_cast<double>(grid.tree().getValue({at[0], at[1], at[2]}));
        });
        const double got = trilinear(place, [&](const std::array<int, 3>& at) {
            const std::size_t row = static_cast<std::size_t>(at[2]) * volume.size.y + at[1];
            return static_cast<double>(volume.density[row * static_cast<std::size_t>(volume.size.x) + at[0]]);
        });
        ASSERT_NEAR(got, wanted, tolerance) << "point " << n;
    }
}

TEST(ReadVdbAxes, SwapsAndMirrorsAllAxesExactly) {
    std::array<int, 3> order{0, 1, 2};
    do {
        for (int mirrors = 0; mirrors < 8; ++mirrors) {
            std::array<double, 3> step{0.5, 1.25, 0.3};
            for (std::size_t i = 0; i < 3; ++i)
                if (mirrors >> i & 1) step[i] = -step[i];
            SCOPED_TRACE(testing::Message() << order[0] << order[1] << order[2] << " mirrors " << mirrors);
            const openvdb::FloatGrid::Ptr grid = grid_with(matrix_of(order, step));
            const GridVolume volume = written_and_read(grid);
            for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(volume.size[order[i]], size[static_cast<int>(i)]);
            ASSERT_EQ(volume.density.size(), 5u * 11u * 19u);
            for (int a = 0; a < 3; ++a) ASSERT_LT(volume.lower[a], volume.upper[a]);
            expect_same_field(*grid, volume, 1e-6);  // of values up to 181,005
            EXPECT_TRUE(volume.notes.lines.empty());
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ReadVdbAxes, TakesTheRoundingOfAMatrixForRightAngles) {
    // Turned by a right angle in float, and by half of 3.14159: 4e-8 and 1e-6 off.
    for (const double angle : {static_cast<double>(std::numbers::pi_v<float>) / 2.0, 3.14159 / 2.0, 3.0 * 1.5707963})
        for (const openvdb::math::Axis axis : {openvdb::math::X_AXIS, openvdb::math::Y_AXIS, openvdb::math::Z_AXIS}) {
            const openvdb::FloatGrid::Ptr grid = grid_with(matrix_of({0, 1, 2}, {0.5, 1.25, 0.3}));
            grid->transform().postRotate(angle, axis);
            // A voxel apart values differ by 10^4, and the farthest corner is 40 voxels from the axis.
            expect_same_field(*grid, written_and_read(grid), 10000.0 * 200.0 * 3e-6);
        }
    const openvdb::FloatGrid::Ptr sheared = grid_with(matrix_of({1, 2, 0}, {-0.5, 1.25, 0.3}));
    openvdb::math::Mat4d matrix = sheared->transform().baseMap()->getAffineMap()->getMat4();
    matrix[0][0] = 1e-7;
    sheared->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    expect_same_field(*sheared, written_and_read(sheared), 10000.0 * 1e-5);
}

// The steps of a grid that is turned about the world's z axis, or sheared as well.
openvdb::math::Mat4d skewed(const std::array<double, 3>& edges, double angle, double shear) {
    openvdb::math::Mat4d matrix = matrix_of({0, 1, 2}, edges);
    matrix[2][0] = shear;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (int i = 0; i < 4; ++i) {
        const double x = matrix[i][0], y = matrix[i][1];
        matrix[i][0] = cosine * x - sine * y;
        matrix[i][1] = sine * x + cosine * y;
    }
    return matrix;
}

// Sampled at other points than its voxels, the field would differ between them by up to thousands.
TEST(ReadVdbAxes, TurnedAndShearedGridsKeepTheirVoxels) {
    for (const double angle : {0.5, -2.0, 0.001, std::numbers::pi / 2.0 + 1e-4})
        for (const double shear : {0.0, 0.2}) {
            SCOPED_TRACE(testing::Message() << "angle " << angle << " shear " << shear);
            const openvdb::FloatGrid::Ptr grid = grid_with(skewed({0.5, 0.25, 0.3}, angle, shear));
            const GridVolume volume = written_and_read(grid);
            ASSERT_TRUE(volume.frame);
            EXPECT_TRUE(volume.notes.lines.empty());
            EXPECT_EQ(volume.size, Vec3i(size.x(), size.y(), size.z()));
            EXPECT_EQ(volume.density[1], 2.0f) << "x fastest";
            expect_same_field(*grid, volume, 1e-6);  // of values up to 181,005
        }
}

TEST(ReadVdbAxes, RefusesMoreVoxelsThanTheLimitAndFlatGrids) {
    const openvdb::FloatGrid::Ptr grid = grid_with(skewed({0.5, 0.5, 0.5}, 0.5, 0.0));
    const std::filesystem::path path = test::fresh_path("a.vdb");
    openvdb::io::File file(path.string());
    file.write({grid});
    file.close();
    EXPECT_THAT(error_of([&] { read_vdb(path, "density", Negative::clamp, 1044); }).message(),
                HasSubstr("the limit is 1044"));
    EXPECT_NO_THROW(read_vdb(path, "density", Negative::clamp, 1045));
    // A long step all but along another axis.
    openvdb::math::Mat4d flat = matrix_of({0, 1, 2}, {1.0, 1.0, 0.5});
    flat[0][1] = 1e7;
    EXPECT_THAT(error_of([&] { written_and_read(grid_with(flat)); }).message(), HasSubstr("flattens it"));
}

// Constant boxes are tiles in the file; a box of leaves, tiles and nothing keeps them apart.
TEST(ReadVdbAxes, TurnsTilesAndWhatIsBetweenThem) {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix_of({2, 0, 1}, {-1.0, 1.0, -1.0})));
    grid->fill(openvdb::CoordBBox({0, 0, 0}, {7, 15, 7}), 0.5f);
    grid->fill(openvdb::CoordBBox({8, 0, 0}, {10, 2, 9}), 0.25f);
    ASSERT_GT(grid->activeVoxelCount(), grid->tree().activeLeafVoxelCount());
    const GridVolume volume = written_and_read(grid);
    EXPECT_EQ(volume.size, Vec3i(16, 10, 11));
    // Index (x, y, z) lies at world (y, 9 - z, 10 - x) of the box.
    const auto at = [&](int x, int y, int z) {
        return volume.density[(static_cast<std::size_t>(10 - x) * 10 + static_cast<std::size_t>(9 - z)) * 16 +
                              static_cast<std::size_t>(y)];
    };
    for (int x = 0; x < 11; ++x)
        for (int y = 0; y < 16; ++y)
            for (int z = 0; z < 10; ++z)
                ASSERT_EQ(at(x, y, z), grid->tree().getValue({x, y, z})) << x << ", " << y << ", " << z;
}

}  // namespace
}  // namespace shadowbench::scene

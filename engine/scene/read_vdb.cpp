// The only file that includes OpenVDB: it takes long to compile.
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <mutex>
#include <new>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/files.h"
#include "scene/limits.h"
#include "scene/vdb_check.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw Error(ErrorCode::bad_input, file.string(), message);
}

// Number of voxels in a box, which must not be over the limit.
double check_box(const openvdb::CoordBBox& box, std::uint64_t most_voxels, const std::filesystem::path& file) {
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= static_cast<double>(box.max()[axis]) - box.min()[axis] + 1.0;
    if (voxels > static_cast<double>(most_voxels))
        fail(file, fmt::format("the active box has {} voxels; the limit is {}", voxels, most_voxels));
    return voxels;
}

openvdb::FloatGrid::Ptr read_grid(const std::filesystem::path& file, const std::string& name) {
    const std::string names = check_vdb(file, name);
    openvdb::io::File vdb(file.string());
    vdb.open(false);
    if (!vdb.hasGrid(name))
        fail(file, fmt::format("there is no grid \"{}\"; the grids are: {}", name, names.empty() ? "none" : names));
    const openvdb::FloatGrid::Ptr result = openvdb::gridPtrCast<openvdb::FloatGrid>(vdb.readGrid(name));
    if (result->getGridClass() == openvdb::GRID_LEVEL_SET)
        fail(file, fmt::format("the grid \"{}\" is a level set, not a fog volume", name));
    return result;
}

// The grid must be a box in the world, not turned, sheared or mirrored.
void check_transform(const openvdb::math::Transform& transform, const std::filesystem::path& file) {
    if (!transform.isLinear()) fail(file, "the grid is not a box in the world: its transform is a frustum");
    const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const double value = matrix[row][column];
            if (!std::isfinite(value)) fail(file, "the grid's transform is not finite");
            if (row == column && !(value > 0.0)) fail(file, "the grid's transform mirrors or flattens it");
            if (row != column && value != 0.0)
                fail(file, "the grid's transform turns or shears it: it must be axis-aligned");
        }
}

GridVolume convert(const openvdb::FloatGrid& grid, std::uint64_t most_voxels, const std::filesystem::path& file) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) fail(file, "the grid has no active voxels");
    const double voxels = check_box(box, most_voxels, file);

    GridVolume volume;
    const openvdb::Coord size = box.dim();
    volume.size = Vec3i(size.x(), size.y(), size.z());
    volume.density.resize(static_cast<std::size_t>(voxels));
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, volume.density.data());
    openvdb::tools::copyToDense(grid, dense);

    // Index coordinates are voxel centres.
    const openvdb::Vec3d half(0.5);
    const openvdb::Vec3d lower = grid.transform().indexToWorld(box.min().asVec3d() - half);
    const openvdb::Vec3d upper = grid.transform().indexToWorld(box.max().asVec3d() + half);
    volume.lower = Vec3d(lower.x(), lower.y(), lower.z());
    volume.upper = Vec3d(upper.x(), upper.y(), upper.z());
    return volume;
}

void check_values(const GridVolume& volume, const std::filesystem::path& file) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(volume.lower[axis]) <= max_coordinate) || !(std::abs(volume.upper[axis]) <= max_coordinate) ||
            !(volume.upper[axis] - volume.lower[axis] >= min_length))
            fail(file,
                 fmt::format("the grid's world box runs from {} to {} along an axis; both must be finite, at most {} "
                             "from 0 and {} apart at least: mend its transform",
                             volume.lower[axis], volume.upper[axis], max_coordinate, min_length));
    for (const float density : volume.density)
        if (!(density >= 0.0f && density <= static_cast<float>(max_coordinate)))
            fail(file, fmt::format("the grid has the density {}, which is not a finite number of at least 0", density));
}

}  // namespace

GridVolume read_vdb(const std::filesystem::path& file, const std::string& grid, std::uint64_t most_voxels) {
    static std::once_flag once;
    std::call_once(once, [] { openvdb::initialize(); });
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        throw Error(ErrorCode::no_such_file, file.string(), "there is no such file");
    if (std::filesystem::is_regular_file(file, ignored) && std::filesystem::file_size(file, ignored) == 0)
        fail(file, "the file is empty");
    try {
        const openvdb::FloatGrid::Ptr source = read_grid(file, grid);
        check_transform(source->transform(), file);
        GridVolume volume = convert(*source, most_voxels, file);
        check_values(volume, file);
        return volume;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        fail(file, "the file is damaged or too large: there is not enough memory for what it says it holds");
    } catch (const std::ios_base::failure&) {
        fail(file, "the file is cut short or damaged");
    } catch (const std::exception& fault) {  // openvdb::Exception, and what a damaged file makes the library throw
        fail(file, fmt::format("not a readable OpenVDB file: {}", fault.what()));
    }
}

}  // namespace shadowbench::scene

// The only file that includes OpenVDB, which takes long to compile.
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene/readers/densities.h"
#include "scene/readers/files.h"
#include "scene/readers/grid_axes.h"
#include "scene/readers/place_grid.h"
#include "scene/readers/vdb_check.h"
#include "scene/readers/vdb_facts.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw Error(ErrorCode::bad_input, file.string(), message);
}

// The number of voxels in a box; throws if it is over the limit.
double check_box(const openvdb::CoordBBox& box, std::uint64_t most_voxels, const std::filesystem::path& file) {
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= static_cast<double>(box.max()[axis]) - box.min()[axis] + 1.0;
    if (voxels > static_cast<double>(most_voxels))
        fail(file, fmt::format("the active box has {} voxels; the limit is {}", voxels, most_voxels));
    return voxels;
}

openvdb::FloatGrid::Ptr read_grid(const std::filesystem::path& file, const VdbGrid& grid) {
    openvdb::io::File vdb(file.string());
    vdb.open(false);
    const openvdb::FloatGrid::Ptr result = openvdb::gridPtrCast<openvdb::FloatGrid>(vdb.readGrid(grid.library_name));
    if (!result) fail(file, fmt::format("the grid \"{}\" is not float", shown(grid)));
    if (result->getGridClass() == openvdb::GRID_LEVEL_SET)
        fail(file, fmt::format("the grid \"{}\" is a level set, not a fog volume", shown(grid)));
    return result;
}

GridPlace place_of(const openvdb::math::Transform& transform, const openvdb::Coord& lower,
                   const std::filesystem::path& file) {
    if (!transform.isLinear()) fail(file, "the grid is not a box in the world: its transform is a frustum");
    const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();  // row i: a step along axis i
    const openvdb::Vec3d first = transform.indexToWorld(lower);
    GridPlace place{{}, Vec3d(first.x(), first.y(), first.z())};
    for (int i = 0; i < 3; ++i) {
        Vec3d& step = place.steps[static_cast<std::size_t>(i)];
        for (int world = 0; world < 3; ++world) {
            if (!std::isfinite(matrix[i][world])) fail(file, "the grid's transform is not finite");
            step[world] = matrix[i][world];
        }
        if (step == Vec3d(0, 0, 0)) fail(file, "the grid's transform flattens it");
    }
    return place;
}

// Copies densities, x fastest along the world's axes, one slab of the grid at a time, so that turning it needs little
// memory.
void copy_densities(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box, const GridAxes& axes,
                    GridVolume& volume) {
    using Dense = openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ>;
    if (axes.as_they_are()) {
        Dense dense(box, volume.density.data());
        openvdb::tools::copyToDense(grid, dense);
        return;
    }
    const openvdb::Coord size = box.dim();
    const auto [first, step] = turned_steps(Vec3i(size.x(), size.y(), size.z()), axes);
    constexpr int thick = 8;  // voxels, the thickness of a leaf
    std::vector<float> slab;
    for (int z = 0; z < size.z(); z += thick) {
        const int layers = std::min(thick, size.z() - z);
        const openvdb::Coord lower = box.min().offsetBy(0, 0, z);
        slab.resize(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
                    static_cast<std::size_t>(layers));
        Dense dense({lower, {box.max().x(), box.max().y(), lower.z() + layers - 1}}, slab.data());
        openvdb::tools::copyToDense(grid, dense);
        const float* from = slab.data();
        for (int k = z; k < z + layers; ++k)
            for (int j = 0; j < size.y(); ++j)
                for (int i = 0; i < size.x(); ++i)
                    volume.density[static_cast<std::size_t>(first + i * step[0] + j * step[1] + k * step[2])] = *from++;
    }
}

void convert(openvdb::FloatGrid::Ptr grid, Negative negative, std::uint64_t most_voxels,
             const std::filesystem::path& file, GridVolume& volume, VdbFacts& facts) {
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    if (box.empty()) fail(file, "the grid has no active voxels");
    const double voxels = check_box(box, most_voxels, file);
    const openvdb::Coord size = box.dim();
    const GridPlace place = place_of(grid->transform(), box.min(), file);
    const std::optional<GridAxes> found = find_axes(place.steps, Vec3i(size.x(), size.y(), size.z()));
    const GridAxes axes = found.value_or(GridAxes());
    facts.active = grid->activeVoxelCount();
    if (!axes.as_they_are()) facts.axes = text_of(axes);

    for (std::size_t i = 0; i < 3; ++i) volume.size[axes.to[i]] = size[static_cast<int>(i)];
    volume.density.resize(static_cast<std::size_t>(voxels));
    copy_densities(*grid, box, axes, volume);
    grid.reset();  // its memory may be needed for what follows
    check_densities(volume, negative, file);
    if (const std::optional<std::string> fault = place_grid(volume, found, place, most_voxels))
        fail(file, *fault + ": mend its transform");
}

}  // namespace

GridVolume read_vdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                    std::uint64_t most_voxels) {
    VdbFacts unused;
    return read_vdb(file, grid, negative, most_voxels, unused);
}

GridVolume read_vdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                    std::uint64_t most_voxels, VdbFacts& facts) {
    static std::once_flag once;
    std::call_once(once, [] { openvdb::initialize(); });
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        throw Error(ErrorCode::no_such_file, file.string(), "there is no such file");
    if (std::filesystem::is_regular_file(file, ignored) && std::filesystem::file_size(file, ignored) == 0)
        fail(file, "the file is empty");
    try {
        const VdbGrid chosen = check_vdb(file, grid);
        openvdb::FloatGrid::Ptr source = read_grid(file, chosen);
        GridVolume volume;
        note_grid(chosen, chosen.passed_over, source->background(), volume.notes);
        convert(std::move(source), negative, most_voxels, file, volume, facts);
        facts.grid = shown(chosen);
        return volume;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        fail(file, "the file is damaged or too large: there is not enough memory for what it says it holds");
    } catch (const std::ios_base::failure&) {
        fail(file, "the file is cut short or damaged");
    } catch (const std::exception& fault) {  // openvdb::Exception, and others if the file is damaged
        fail(file, fmt::format("not a readable OpenVDB file: {}", fault.what()));
    }
}

}  // namespace shadowbench::scene

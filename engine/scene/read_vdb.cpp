// The only file that includes OpenVDB: it takes long to compile.
#include <openvdb/io/Archive.h>
#include <openvdb/io/File.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <mutex>
#include <new>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/files.h"
#include "scene/limits.h"

namespace shadowbench::scene {
namespace {

using base::Error;
using base::ErrorCode;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw Error(ErrorCode::bad_input, file.string(), message);
}

// Number of voxels in a box, which must not be over the limit.
double check_box(const openvdb::Coord& lower, const openvdb::Coord& upper, const std::filesystem::path& file) {
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= std::max(0.0, static_cast<double>(upper[axis]) - lower[axis] + 1.0);
    if (voxels > static_cast<double>(max_voxels))
        fail(file, fmt::format("the active box has {} voxels; the limit is {}", voxels, max_voxels));
    return voxels;
}

// The grids a file says it has. OpenVDB does not look whether its reads succeed: a file that is cut short would give a
// grid with holes. So the ends of the grids, which stand in their descriptors, are held against the size of the file
// first.
class Contents : private openvdb::io::Archive {
public:
    Contents(const std::filesystem::path& file, const std::string& wanted) {
        std::ifstream stream(file, std::ios::binary);
        if (!stream) throw Error(ErrorCode::io, file.string(), "cannot be opened");
        stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
        readHeader(stream);
        if (!inputHasGridOffsets()) fail(file, "the file was written as a stream, without the places of its grids");
        setFormatVersion(stream);
        setLibraryVersion(stream);
        openvdb::MetaMap().readMeta(stream);
        const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file));
        for (std::int32_t left = readGridCount(stream); left > 0; --left) {
            openvdb::io::GridDescriptor grid;
            grid.read(stream);
            if (grid.getEndPos() < stream.tellg() || grid.getEndPos() > size)
                throw Error(ErrorCode::bad_input, fmt::format("{}:{}", file.string(), size),
                            fmt::format("the file is cut short or damaged: the grid \"{}\" ends at byte {}",
                                        grid.gridName(), grid.getEndPos()));
            names_ += (names_.empty() ? "" : ", ") + grid.gridName();
            if (grid.gridName() == wanted) check_claims(stream, grid, file);
            grid.seekToEnd(stream);
        }
    }

    const std::string& names() const { return names_; }

private:
    // Refuses what the library would take memory for before it notices that the file does not hold it.
    void check_claims(std::istream& stream, const openvdb::io::GridDescriptor& grid,
                      const std::filesystem::path& file) {
        // Older files have another order, other grids another tree; an instance has none.
        if (openvdb::io::getFormatVersion(stream) < openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING ||
            grid.gridType() != openvdb::FloatGrid::gridType() || grid.isInstance())
            return;
        grid.seekToGrid(stream);
        readGridCompression(stream);
        openvdb::MetaMap metadata;
        metadata.readMeta(stream);
        const auto lower = metadata.getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
        const auto upper = metadata.getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
        if (lower && upper) check_box(openvdb::Coord(lower->value()), openvdb::Coord(upper->value()), file);
        openvdb::math::Transform().read(stream);
        struct {
            std::int32_t buffers;
            float background;
            std::uint32_t tiles, children;
        } root;
        static_assert(sizeof root == 16);
        stream.read(reinterpret_cast<char*>(&root), sizeof root);
        // A child begins with its place and two masks, a bit a slot each; a tile has its place, value and state.
        constexpr std::uint64_t child_bytes = 12 + 2 * openvdb::FloatTree::RootNodeType::ChildNodeType::NUM_VALUES / 8;
        constexpr std::uint64_t tile_bytes = 12 + 4 + 1;
        const auto left = static_cast<std::uint64_t>(std::max<std::int64_t>(0, grid.getEndPos() - stream.tellg()));
        if (root.children * child_bytes + root.tiles * tile_bytes > left)
            fail(file, fmt::format("the file is damaged: the grid \"{}\" has {} nodes and {} tiles in {} bytes",
                                   grid.gridName(), root.children, root.tiles, left));
    }

    std::string names_;
};

openvdb::FloatGrid::Ptr read_grid(const std::filesystem::path& file, const std::string& name) {
    const Contents contents(file, name);
    openvdb::io::File vdb(file.string());
    vdb.open(false);
    if (!vdb.hasGrid(name))
        fail(file, fmt::format("there is no grid \"{}\"; the grids are: {}", name,
                               contents.names().empty() ? "none" : contents.names()));
    const openvdb::GridBase::Ptr grid = vdb.readGrid(name);
    openvdb::FloatGrid::Ptr result = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (!result) fail(file, fmt::format("the grid \"{}\" has {} values, not float", name, grid->valueType()));
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
            if (row == column && !(value > 0.0)) fail(file, "the grid's transform mirrors or flattens it");
            if (row != column && value != 0.0)
                fail(file, "the grid's transform turns or shears it: it must be axis-aligned");
        }
}

GridVolume convert(const openvdb::FloatGrid& grid, const std::filesystem::path& file) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) fail(file, "the grid has no active voxels");
    const double voxels = check_box(box.min(), box.max(), file);

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
            !(volume.lower[axis] < volume.upper[axis]))
            fail(file, "the grid's world box is not finite");
    for (const float density : volume.density)
        if (!(density >= 0.0f && density <= static_cast<float>(max_coordinate)))
            fail(file, fmt::format("the grid has the density {}, which is not a finite number of at least 0", density));
}

}  // namespace

GridVolume read_vdb(const std::filesystem::path& file, const std::string& grid) {
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
        GridVolume volume = convert(*source, file);
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

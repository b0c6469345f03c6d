// The only file that includes OpenVDB, which takes long to compile.
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <mutex>
#include <new>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/readers/active_box.h"
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

struct Wanted {
    const std::filesystem::path& file;
    Negative negative;
    std::uint64_t most_voxels;
};

// The number of voxels in a box; throws if it is over the limit.
double check_box(const openvdb::CoordBBox& box, std::uint64_t most_voxels, const std::filesystem::path& file) {
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= static_cast<double>(box.max()[axis]) - box.min()[axis] + 1.0;
    if (voxels > static_cast<double>(most_voxels))
        fail(file, fmt::format("the active box has {} voxels; the limit is {}", voxels, most_voxels));
    return voxels;
}

// A file of which check_vdb() has checked every count and size. The library's own class for files reads a whole grid at
// once; here its leaves are read one after the other.
class VdbStream {
public:
    VdbStream(const std::filesystem::path& file, const VdbGrid& grid) : stream_(file, std::ios::binary) {
        if (!stream_) throw Error(ErrorCode::io, file.string(), "the file cannot be opened");
        stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
        openvdb::io::setStreamMetadataPtr(stream_, facts_);
        openvdb::io::setVersion(stream_, {grid.library_major, grid.library_minor}, grid.format);
    }

    // Reads the facts of the grid that begins at a byte; its tree follows.
    openvdb::FloatGrid::Ptr front(std::uint64_t begin) {
        stream_.seekg(static_cast<std::streamoff>(begin));
        std::uint32_t compression = 0;
        stream_.read(reinterpret_cast<char*>(&compression), sizeof compression);
        openvdb::io::setDataCompression(stream_, compression);
        openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create();
        grid->readMeta(stream_);
        grid->readTransform(stream_);
        return grid;
    }

    VdbStream(const VdbStream&) = delete;
    VdbStream& operator=(const VdbStream&) = delete;

    std::istream& stream() { return stream_; }

private:
    openvdb::io::StreamMetadata::Ptr facts_{new openvdb::io::StreamMetadata};  // the stream keeps its address
    std::ifstream stream_;
};

// Reads an internal node and those below it as the library does, and keeps nothing.
template <class Node>
void try_node(std::istream& stream, bool half) {
    typename Node::NodeMaskType children, active;
    children.load(stream);
    active.load(stream);
    std::vector<float> values(Node::NUM_VALUES);
    openvdb::io::readCompressedValues(stream, values.data(), Node::NUM_VALUES, active, half);
    for (auto child = children.beginOn(); child; ++child) {
        if constexpr (Node::LEVEL > 1)
            try_node<typename Node::ChildNodeType>(stream, half);
        else
            typename Node::ChildNodeType::NodeMaskType().load(stream);
    }
}

// Reads all nodes of a tree, and the values of none of its leaves. The library loses the memory of a child of the root
// that cannot be unpacked, so the nodes are tried first.
void read_topology(std::istream& stream, bool half, openvdb::FloatTree& tree) {
    using Child = openvdb::FloatTree::RootNodeType::ChildNodeType;
    const auto take = [&]<class Value>(Value value) {
        stream.read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    };
    const std::istream::pos_type begin = stream.tellg();
    take(std::int32_t());  // the number of buffers
    const float background = take(float());
    openvdb::io::setGridBackgroundValuePtr(stream, &background);
    const auto tiles = take(std::uint32_t()), children = take(std::uint32_t());
    constexpr std::uint64_t tile_bytes = 12 + 4 + 1;
    stream.seekg(static_cast<std::streamoff>(tiles * tile_bytes), std::ios::cur);
    for (std::uint32_t i = 0; i < children; ++i) {
        take(openvdb::Vec3i());  // the child's place
        try_node<Child>(stream, half);
    }
    stream.seekg(begin);
    tree.readTopology(stream, half);
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

// Reads the values of all leaves, in the order of the file, and frees each when it is copied.
void fill_from_leaves(std::istream& stream, openvdb::FloatTree& tree, bool half, BoxFilling& filling) {
    using Buffer = openvdb::FloatTree::LeafNodeType::Buffer;
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
        leaf->readBuffers(stream, half);
        Buffer values(openvdb::PartialCreate(), 0.0f);
        leaf->swap(values);
        const openvdb::Coord corner = leaf->origin();
        filling.leaf({corner.x(), corner.y(), corner.z()}, values.data());
    }
}

// Values that hold for whole nodes, a block as large as a leaf at a time. Not by an accessor of the library: it would give
// every leaf its values as it passes, before they are read.
void fill_from_tiles(const openvdb::FloatTree& tree, BoxFilling& filling) {
    constexpr std::int32_t side = BoxFilling::leaf_side;
    const ActiveBox& box = filling.box;
    for (std::int64_t x = box.lower[0] & -side; x <= box.upper[0]; x += side)
        for (std::int64_t y = box.lower[1] & -side; y <= box.upper[1]; y += side)
            for (std::int64_t z = box.lower[2] & -side; z <= box.upper[2]; z += side) {
                const Vec3i corner(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
                const openvdb::Coord place(corner.x, corner.y, corner.z);
                if (tree.probeConstLeaf(place)) continue;
                const float value = tree.getValue(place);
                if (value != tree.background()) filling.tile(corner, side, value, true);
            }
}

void convert(VdbStream& file_of, const VdbGrid& chosen, const Wanted& wanted, GridVolume& volume, VdbFacts& facts) {
    const std::filesystem::path& file = wanted.file;
    const openvdb::FloatGrid::Ptr front = file_of.front(chosen.begin);
    if (front->getGridClass() == openvdb::GRID_LEVEL_SET)
        fail(file, fmt::format("the grid \"{}\" is a level set, not a fog volume", shown(chosen)));
    const openvdb::FloatGrid::Ptr grid = chosen.tree_begin == chosen.begin ? front : file_of.front(chosen.tree_begin);
    openvdb::FloatTree& tree = grid->tree();
    read_topology(file_of.stream(), chosen.half, tree);
    note_grid(chosen, chosen.passed_over, tree.background(), volume.notes);
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    if (box.empty()) fail(file, "the grid has no active voxels");
    const double voxels = check_box(box, wanted.most_voxels, file);
    const openvdb::Coord dim = box.dim();
    const Vec3i size(dim.x(), dim.y(), dim.z());
    const GridPlace place = place_of(front->transform(), box.min(), file);
    const std::optional<GridAxes> found = find_axes(place.steps, size);
    const GridAxes axes = found.value_or(GridAxes());
    facts.active = grid->activeVoxelCount();
    facts.axes = text_of(found, place);

    volume.size = turned(size, axes);
    volume.density.assign(static_cast<std::size_t>(voxels), tree.background());
    ActiveBox bounds;
    for (int i = 0; i < 3; ++i) {
        bounds.lower[static_cast<std::size_t>(i)] = box.min()[i];
        bounds.upper[static_cast<std::size_t>(i)] = box.max()[i];
    }
    BoxFilling filling{bounds, turned_steps(size, axes), volume.density};
    fill_from_tiles(tree, filling);
    fill_from_leaves(file_of.stream(), tree, chosen.half, filling);
    check_densities(volume, wanted.negative, file);
    if (const std::optional<std::string> fault = place_grid(volume, found, place))
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
        VdbStream stream(file, chosen);
        GridVolume volume;
        convert(stream, chosen, {file, negative, most_voxels}, volume, facts);
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

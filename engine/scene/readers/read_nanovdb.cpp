// The layout of a grid is that of NanoVDB's structures (NanoVDB.h). The library follows the places in a grid wherever
// they lead, so the tree is walked here, and every place is checked.
#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <optional>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/readers/active_box.h"
#include "scene/readers/densities.h"
#include "scene/readers/files.h"
#include "scene/readers/nanovdb_file.h"
#include "scene/readers/place_grid.h"
#include "scene/readers/vdb_facts.h"

namespace shadowbench::scene {
namespace {

// "NanoVDB0", and "NanoVDB1" since NanoVDB 32.6.
constexpr std::uint64_t grid_magics[] = {NANOVDB_MAGIC_NUMBER, 0x314244566f6e614e};

struct NodeCount {
    std::uint64_t visited = 0;
};

// The structures of a grid at their places in it.
class Places {
public:
    Places(const FileReader& file, const NanoVdbGrid& grid) : file_(file), grid_(grid) {}

    [[noreturn]] void damaged(const std::string& what) const {
        file_.fail(grid_.begin, fmt::format("the grid that begins here is damaged: {}", what));
    }

    // The structure at `place`, with `more` bytes behind it.
    template <class T>
    const T& at(std::uint64_t place, std::uint64_t more = 0) const {
        if (place % alignof(T) != 0 || place > grid_.size || sizeof(T) > grid_.size - place ||
            more > grid_.size - place - sizeof(T))
            damaged(fmt::format("it has {} bytes, and something of {} at byte {}", grid_.size, sizeof(T), place));
        return *reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(grid_.blocks.data()) + place);
    }

    // The place that is `way` bytes from another; each node has one parent, so there are not more than fit the grid.
    template <class T>
    std::uint64_t child(std::uint64_t place, std::int64_t way, NodeCount& nodes) const {
        if (++nodes.visited > grid_.size / sizeof(T)) damaged("nodes have several parents");
        const std::uint64_t target = place + static_cast<std::uint64_t>(way);  // wraps if the way leads out
        at<T>(target);
        return target;
    }

private:
    const FileReader& file_;
    const NanoVdbGrid& grid_;
};

template <class Build>
using LeafOf = typename nanovdb::LeafNode<Build>::DataType;
template <class Build>
using LowerOf = typename nanovdb::InternalNode<nanovdb::LeafNode<Build>>::DataType;
template <class Build>
using UpperOf = typename nanovdb::InternalNode<nanovdb::InternalNode<nanovdb::LeafNode<Build>>>::DataType;
template <class Build>
using RootOf =
    typename nanovdb::RootNode<nanovdb::InternalNode<nanovdb::InternalNode<nanovdb::LeafNode<Build>>>>::DataType;

constexpr std::int32_t leaf_side = 8, lower_side = 128, upper_side = 4096;

// Of entry `n` of a node with 2^log2 entries along an axis.
Vec3i entry_corner(const Vec3i& corner, std::uint32_t n, unsigned log2, std::int32_t side) {
    const std::uint32_t last = (1u << log2) - 1u;
    return corner + side * Vec3i(static_cast<int>(n >> (2 * log2)), static_cast<int>(n >> log2 & last),
                                 static_cast<int>(n & last));
}

// The bits of a key that give a place: 20 for each axis.
constexpr std::uint64_t key_bits = std::uint64_t{0xfffff} | std::uint64_t{0xfffff} << 21 | std::uint64_t{0xfffff} << 42;

Vec3i root_corner(std::uint64_t key) {
    const auto along = [&](unsigned shift) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> shift & 0x1fffff) << 12);
    };
    return {along(42), along(21), along(0)};
}

// Beyond the range of float, infinity, which is no density.
float as_float(float value) {
    return value;
}
float as_float(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    return std::abs(value) > largest ? std::numeric_limits<float>::infinity() : static_cast<float>(value);
}

// Visits the whole tree: visitor.tile(corner, side, value, active), and visitor.voxel(corner, value, active) for the
// voxels of leaves.
template <class Build>
class TreeWalk {
public:
    TreeWalk(const Places& places, std::uint64_t root)
        : places_(places), root_at_(root), root_(places.at<Root>(root)) {}

    float background() const { return as_float(root_.mBackground); }

    template <class Visitor>
    void run(Visitor& visitor) {
        uppers_ = lowers_ = leaves_ = {};
        places_.at<Root>(root_at_, root_.mTableSize * std::uint64_t{sizeof(Tile)});
        std::vector<std::uint64_t> keys;
        for (std::uint32_t n = 0; n < root_.mTableSize; ++n) keys.push_back(tile(n).key);
        std::sort(keys.begin(), keys.end());
        if (std::adjacent_find(keys.begin(), keys.end()) != keys.end()) places_.damaged("two nodes at one place");
        for (const std::uint64_t key : keys)
            if ((key & ~key_bits) != 0) places_.damaged("a node at no place");
        for (std::uint32_t n = 0; n < root_.mTableSize; ++n) {
            const Tile& one = tile(n);
            const Vec3i corner = root_corner(one.key);
            if (one.child == 0)
                visitor.tile(corner, upper_side, as_float(one.value), one.state != 0);
            else
                upper(places_.child<Upper>(root_at_, one.child, uppers_), corner, visitor);
        }
    }

private:
    using Leaf = LeafOf<Build>;
    using Lower = LowerOf<Build>;
    using Upper = UpperOf<Build>;
    using Root = RootOf<Build>;
    using Tile = typename Root::Tile;

    const Tile& tile(std::uint32_t n) const {
        return places_.at<Tile>(root_at_ + sizeof(Root) + n * std::uint64_t{sizeof(Tile)});
    }

    template <class Visitor>
    void upper(std::uint64_t at, const Vec3i& corner, Visitor& visitor) {
        const Upper& node = places_.at<Upper>(at);
        for (std::uint32_t n = 0; n < 32768; ++n) {
            const Vec3i entry = entry_corner(corner, n, 5, lower_side);
            if (node.mChildMask.isOn(n))
                lower(places_.child<Lower>(at, node.mTable[n].child, lowers_), entry, visitor);
            else
                visitor.tile(entry, lower_side, as_float(node.mTable[n].value), node.mValueMask.isOn(n));
        }
    }

    template <class Visitor>
    void lower(std::uint64_t at, const Vec3i& corner, Visitor& visitor) {
        const Lower& node = places_.at<Lower>(at);
        for (std::uint32_t n = 0; n < 4096; ++n) {
            const Vec3i entry = entry_corner(corner, n, 4, leaf_side);
            if (node.mChildMask.isOn(n))
                leaf(places_.child<Leaf>(at, node.mTable[n].child, leaves_), entry, visitor);
            else
                visitor.tile(entry, leaf_side, as_float(node.mTable[n].value), node.mValueMask.isOn(n));
        }
    }

    template <class Visitor>
    void leaf(std::uint64_t at, const Vec3i& corner, Visitor& visitor) {
        const Leaf& node = places_.at<Leaf>(at);
        if constexpr (std::is_same_v<Build, nanovdb::FpN>) {
            constexpr unsigned most_bits = 16;
            const unsigned bits = 1u << (node.mFlags >> 5);
            if (bits > most_bits) places_.damaged(fmt::format("voxels of {} bits", bits));
            places_.at<Leaf>(at, bits * std::uint64_t{64});
        }
        for (std::uint32_t n = 0; n < 512; ++n)
            visitor.voxel(entry_corner(corner, n, 3, 1), as_float(node.getValue(n)), node.mValueMask.isOn(n));
    }

    const Places& places_;
    std::uint64_t root_at_;
    const Root& root_;
    NodeCount uppers_, lowers_, leaves_;
};

GridPlace place_of(const nanovdb::Map& map, const ActiveBox& box, const Places& places) {
    GridPlace place{{}, Vec3d(0, 0, 0)};
    for (std::size_t w = 0; w < 3; ++w) {
        double& first = (*place.first)[static_cast<int>(w)];
        first = map.mVecD[w];
        for (std::size_t i = 0; i < 3; ++i) {
            const double step = map.mMatD[3 * w + i];
            place.steps[i][static_cast<int>(w)] = step;
            first += step * static_cast<double>(box.lower[i]);
        }
        if (!std::isfinite(first)) places.damaged("its transform is not finite");
    }
    for (const Vec3d& step : place.steps)
        if (step == Vec3d(0, 0, 0)) places.damaged("its transform flattens it");
    return place;
}

struct Wanted {
    const std::filesystem::path& file;
    Negative negative;
    std::uint64_t most_voxels;
};

template <class Build>
GridVolume convert(const FileReader& file, NanoVdbGrid& grid, const Wanted& wanted, VdbFacts& facts) {
    const Places places(file, grid);
    const auto& data = places.at<nanovdb::GridData>(0);
    constexpr std::uint64_t tree_at = sizeof(nanovdb::GridData);
    const auto& tree = places.at<nanovdb::TreeData<3>>(tree_at);
    TreeWalk<Build> walk(places, tree_at + tree.mNodeOffset[3]);
    ActiveBox box;
    walk.run(box);
    if (box.count == 0) file.fail(grid.begin, "the grid has no active voxels");
    if (box.voxels() > static_cast<double>(wanted.most_voxels))
        file.fail(grid.begin,
                  fmt::format("the active box has {} voxels; the limit is {}", box.voxels(), wanted.most_voxels));

    Vec3i size(0, 0, 0);
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        size[a] = static_cast<int>(box.upper[axis] - box.lower[axis] + 1);
    }
    const GridPlace place = place_of(data.mMap, box, places);
    const std::optional<GridAxes> found = find_axes(place.steps, size);
    const GridAxes axes = found.value_or(GridAxes());
    facts.grid = shown(grid.name);
    facts.active = box.count;
    facts.axes = text_of(found, place);

    GridVolume volume;
    note_grid(grid.name, grid.passed_over, walk.background(), volume.notes);
    volume.size = turned(size, axes);
    volume.density.assign(static_cast<std::size_t>(box.voxels()), walk.background());
    BoxFilling filling{box, turned_steps(size, axes), volume.density};
    walk.run(filling);
    grid.blocks = std::vector<NanoVdbGrid::Block>();  // their memory may be needed for what follows
    check_densities(volume, wanted.negative, wanted.file);
    if (const std::optional<std::string> fault = place_grid(volume, found, place))
        file.fail(grid.begin, *fault + ": mend its transform");
    return volume;
}

// Gives the grid's bytes back when it has read them.
GridVolume convert_any(const FileReader& file, NanoVdbGrid& grid, const Wanted& wanted, VdbFacts& facts) {
    const Places places(file, grid);
    const auto& data = places.at<nanovdb::GridData>(0);
    if (std::find(std::begin(grid_magics), std::end(grid_magics), data.mMagic) == std::end(grid_magics))
        places.damaged("it has not the mark of a grid of NanoVDB");
    if (data.mGridClass == nanovdb::GridClass::LevelSet)
        file.fail(grid.begin, fmt::format("the grid \"{}\" is a level set, not a fog volume", shown(grid.name)));
    switch (data.mGridType) {
        case nanovdb::GridType::Float:
            return convert<float>(file, grid, wanted, facts);
        case nanovdb::GridType::Double:
            return convert<double>(file, grid, wanted, facts);
        case nanovdb::GridType::Fp4:
            return convert<nanovdb::Fp4>(file, grid, wanted, facts);
        case nanovdb::GridType::Fp8:
            return convert<nanovdb::Fp8>(file, grid, wanted, facts);
        case nanovdb::GridType::Fp16:
            return convert<nanovdb::Fp16>(file, grid, wanted, facts);
        case nanovdb::GridType::FpN:
            return convert<nanovdb::FpN>(file, grid, wanted, facts);
        default:
            places.damaged("its type differs from the one that the file's header gives");
    }
}

}  // namespace

GridVolume read_nanovdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                        std::uint64_t most_voxels) {
    VdbFacts unused;
    return read_nanovdb(file, grid, negative, most_voxels, unused);
}

GridVolume read_nanovdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                        std::uint64_t most_voxels, VdbFacts& facts) {
    // A voxel takes up to 8 bytes; nodes that are almost empty take more.
    constexpr std::uint64_t bytes_a_voxel = 8, bytes_of_nodes = std::uint64_t{1} << 26;
    FileReader reader(file);
    try {
        NanoVdbGrid chosen = read_nanovdb_grid(reader, file, grid, bytes_a_voxel * most_voxels + bytes_of_nodes);
        return convert_any(reader, chosen, {file, negative, most_voxels}, facts);
    } catch (const std::bad_alloc&) {
        reader.fail(0, "the file is damaged or too large: there is not enough memory for what it says it holds");
    }
}

}  // namespace shadowbench::scene

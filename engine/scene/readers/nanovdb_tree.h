// Walks over the tree of a grid of a .nvdb file. The layout of a grid is that of NanoVDB's structures (NanoVDB.h). The
// library follows the places in a grid wherever they lead; here every place is checked.
#pragma once

#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/readers/nanovdb_bytes.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// The structures of a grid at their places in it. Each is there until the next one is asked for.
class NanoVdbPlaces {
public:
    NanoVdbPlaces(const FileReader& file, const NanoVdbGrid& grid, NanoVdbBytes& bytes)
        : file_(file), grid_(grid), bytes_(bytes) {}

    std::uint64_t size() const { return grid_.size; }

    [[noreturn]] void damaged(const std::string& what) const {
        file_.fail(grid_.begin, "the grid that begins here is damaged: " + what);
    }

    // Throws unless a structure fits in the grid at `place`, with `more` bytes behind it.
    template <class T>
    void check(std::uint64_t place, std::uint64_t more = 0) const {
        if (place % alignof(T) != 0 || place > grid_.size || sizeof(T) > grid_.size - place ||
            more > grid_.size - place - sizeof(T))
            damaged("it has " + std::to_string(grid_.size) + " bytes, and something of " + std::to_string(sizeof(T)) +
                    " at byte " + std::to_string(place));
    }

    template <class T>
    const T& at(std::uint64_t place, std::uint64_t more = 0) {
        check<T>(place, more);
        return *reinterpret_cast<const T*>(bytes_.at(place, sizeof(T) + more));
    }

private:
    const FileReader& file_;
    const NanoVdbGrid& grid_;
    NanoVdbBytes& bytes_;
};

// The nodes of a level. Each has one parent, so there are not more than fit the grid.
template <class T>
class NanoVdbLevel {
public:
    struct Node {
        std::uint64_t place;
        Vec3i corner;
    };

    // The node that is `way` bytes from another.
    void add(const NanoVdbPlaces& places, std::uint64_t place, std::int64_t way, const Vec3i& corner) {
        if (nodes_.size() >= places.size() / sizeof(T)) places.damaged("nodes have several parents");
        const std::uint64_t target = place + static_cast<std::uint64_t>(way);  // wraps if the way leads out
        places.check<T>(target);
        nodes_.push_back({target, corner});
    }

    // In the order of the grid, so that it can be read from front to back.
    const std::vector<Node>& sorted() {
        std::sort(nodes_.begin(), nodes_.end(), [](const Node& a, const Node& b) { return a.place < b.place; });
        return nodes_;
    }

private:
    std::vector<Node> nodes_;
};

template <class Build>
using NanoVdbLeaf = typename nanovdb::LeafNode<Build>::DataType;
template <class Build>
using NanoVdbLower = typename nanovdb::InternalNode<nanovdb::LeafNode<Build>>::DataType;
template <class Build>
using NanoVdbUpper = typename nanovdb::InternalNode<nanovdb::InternalNode<nanovdb::LeafNode<Build>>>::DataType;
template <class Build>
using NanoVdbRoot =
    typename nanovdb::RootNode<nanovdb::InternalNode<nanovdb::InternalNode<nanovdb::LeafNode<Build>>>>::DataType;

inline constexpr std::int32_t leaf_side = 8, lower_side = 128, upper_side = 4096;

// Of entry `n` of a node with 2^log2 entries along an axis.
inline Vec3i entry_corner(const Vec3i& corner, std::uint32_t n, unsigned log2, std::int32_t side) {
    const std::uint32_t last = (1u << log2) - 1u;
    return corner + side * Vec3i(static_cast<int>(n >> (2 * log2)), static_cast<int>(n >> log2 & last),
                                 static_cast<int>(n & last));
}

// The bits of a key that give a place: 20 for each axis.
inline constexpr std::uint64_t key_bits =
    std::uint64_t{0xfffff} | std::uint64_t{0xfffff} << 21 | std::uint64_t{0xfffff} << 42;

inline Vec3i root_corner(std::uint64_t key) {
    const auto along = [&](unsigned shift) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> shift & 0x1fffff) << 12);
    };
    return {along(42), along(21), along(0)};
}

// Beyond the range of float, infinity, which is no density.
inline float as_float(float value) {
    return value;
}
inline float as_float(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    return std::abs(value) > largest ? std::numeric_limits<float>::infinity() : static_cast<float>(value);
}

// Visits the whole tree: visitor.tile(corner, side, value, active), and take_leaf(corner, leaf).
template <class Build>
class NanoVdbWalk {
public:
    using Leaf = NanoVdbLeaf<Build>;

    NanoVdbWalk(NanoVdbPlaces& places, std::uint64_t root) : places_(places), root_at_(root) {
        const Root& node = places.at<Root>(root);
        background_ = as_float(node.mBackground);
        const std::uint32_t tiles = node.mTableSize;
        places.check<Root>(root, tiles * std::uint64_t{sizeof(Tile)});
        for (std::uint32_t n = 0; n < tiles; ++n)
            tiles_.push_back(places.at<Tile>(root + sizeof(Root) + n * std::uint64_t{sizeof(Tile)}));
        check_keys();
    }

    float background() const { return background_; }

    template <class Visitor, class TakeLeaf>
    void run(Visitor& visitor, const TakeLeaf& take_leaf) {
        NanoVdbLevel<Upper> uppers;
        for (const Tile& tile : tiles_) {
            const Vec3i corner = root_corner(tile.key);
            if (tile.child == 0)
                visitor.tile(corner, upper_side, as_float(tile.value), tile.state != 0);
            else
                uppers.add(places_, root_at_, tile.child, corner);
        }
        NanoVdbLevel<Leaf> leaves =
            below<Leaf>(below<Lower>(std::move(uppers), lower_side, visitor), leaf_side, visitor);
        for (const auto& [place, corner] : leaves.sorted()) {
            const std::uint64_t more = bytes_behind(places_.at<Leaf>(place));
            take_leaf(corner, places_.at<Leaf>(place, more));
        }
    }

private:
    using Lower = NanoVdbLower<Build>;
    using Upper = NanoVdbUpper<Build>;
    using Root = NanoVdbRoot<Build>;
    using Tile = typename Root::Tile;

    void check_keys() const {
        std::vector<std::uint64_t> keys;
        for (const Tile& tile : tiles_) keys.push_back(tile.key);
        std::sort(keys.begin(), keys.end());
        if (std::adjacent_find(keys.begin(), keys.end()) != keys.end()) places_.damaged("two nodes at one place");
        for (const std::uint64_t key : keys)
            if ((key & ~key_bits) != 0) places_.damaged("a node at no place");
    }

    // The children of internal nodes, each `side` voxels wide. Visits the entries that have none.
    template <class Child, class Node, class Visitor>
    NanoVdbLevel<Child> below(NanoVdbLevel<Node> level, std::int32_t side, Visitor& visitor) {
        constexpr unsigned log2 = std::is_same_v<Node, Upper> ? 5 : 4;
        NanoVdbLevel<Child> children;
        for (const auto& [place, corner] : level.sorted()) {
            const Node& node = places_.at<Node>(place);
            for (std::uint32_t n = 0; n < 1u << 3 * log2; ++n) {
                const Vec3i entry = entry_corner(corner, n, log2, side);
                if (node.mChildMask.isOn(n))
                    children.add(places_, place, node.mTable[n].child, entry);
                else
                    visitor.tile(entry, side, as_float(node.mTable[n].value), node.mValueMask.isOn(n));
            }
        }
        return children;
    }

    std::uint64_t bytes_behind(const Leaf& node) const {
        if constexpr (std::is_same_v<Build, nanovdb::FpN>) {
            constexpr unsigned most_bits = 16;
            const unsigned bits = 1u << (node.mFlags >> 5);
            if (bits > most_bits) places_.damaged("voxels of " + std::to_string(bits) + " bits");
            return bits * std::uint64_t{64};
        }
        return 0;
    }

    NanoVdbPlaces& places_;
    std::uint64_t root_at_;
    float background_ = 0.0f;
    std::vector<Tile> tiles_;  // of the root
};

}  // namespace shadowbench::scene

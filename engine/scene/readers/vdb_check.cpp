// The format as OpenVDB 10 reads and writes it (io/Archive, io/GridDescriptor, io/Compression, tree/*.h), versions 222
// (2013) to 224.
#include "scene/readers/vdb_check.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/choose_grid.h"
#include "scene/readers/file_reader.h"

namespace shadowbench::scene {
namespace {

constexpr std::int64_t magic = 0x56444220;
constexpr std::uint32_t first_version = 222, last_version = 224;
constexpr std::uint64_t uuid_bytes = 36;
constexpr std::uint32_t max_name = 65536;  // bytes

// Compression flags of a grid.
enum Compression : std::uint32_t { zip = 1, active_mask = 2, blosc = 4 };

// How a node's inactive values are stored: its first byte.
enum Inactive : std::int8_t { one_value = 2, mask_none = 3, mask_one = 4, mask_two = 5, all_values = 6 };

struct TypeSize {
    std::string_view type;
    std::uint64_t bytes;
};
constexpr std::array map_sizes{
    TypeSize{"AffineMap", 128},
    TypeSize{"UnitaryMap", 128},
    TypeSize{"ScaleMap", 120},
    TypeSize{"UniformScaleMap", 120},
    TypeSize{"TranslationMap", 24},
    TypeSize{"ScaleTranslateMap", 144},
    TypeSize{"UniformScaleTranslateMap", 144},
};
// Metadata that the library reads at its own size, whatever size the file states.
constexpr std::array metadata_sizes{
    TypeSize{"bool", 1},   TypeSize{"int32", 4},  TypeSize{"int64", 8},  TypeSize{"float", 4},
    TypeSize{"double", 8}, TypeSize{"vec2i", 8},  TypeSize{"vec2s", 8},  TypeSize{"vec2d", 16},
    TypeSize{"vec3i", 12}, TypeSize{"vec3s", 12}, TypeSize{"vec3d", 24}, TypeSize{"vec4i", 16},
    TypeSize{"vec4s", 16}, TypeSize{"vec4d", 32}, TypeSize{"mat4s", 64}, TypeSize{"mat4d", 128},
};

struct Grid {
    std::string parent;  // unique name of the grid whose tree this one shares
    bool half = false;
    std::uint64_t begin = 0, end = 0;  // positions in the file
};

template <std::size_t log2_side>
struct Node {
    static constexpr std::size_t values = std::size_t{1} << (3 * log2_side);
    using Mask = std::array<std::uint64_t, values / 64>;

    static std::uint64_t count(const Mask& mask) {
        std::uint64_t on = 0;
        for (const std::uint64_t word : mask) on += static_cast<std::uint64_t>(std::popcount(word));
        return on;
    }
};

class Walk {
public:
    explicit Walk(const std::filesystem::path& file) : file_(file), reader_(file) {}

    VdbGrid run(const GridChoice& choice) {
        read_header();
        const std::size_t chosen = choose_grid(file_, names_, choice);
        check_grid(chosen);
        const std::size_t with_tree = grids_[chosen].parent.empty() ? chosen : parent_of(chosen);
        if (with_tree != chosen) check_grid(with_tree);
        VdbGrid result{
            names_[chosen],        {}, format_, library_[0], library_[1], grids_[chosen].begin, grids_[with_tree].begin,
            grids_[with_tree].half};
        for (std::size_t i = 0; i < grids_.size(); ++i)
            if (i != chosen) result.passed_over.push_back(shown(names_[i]));
        return result;
    }

private:
    [[noreturn]] void damaged(const std::string& what) const {
        reader_.fail(reader_.position(), "the file is cut short or damaged: " + what);
    }

    std::size_t parent_of(std::size_t grid) const {
        std::size_t parent = 0;
        while (parent < names_.size() && names_[parent].unique_name != grids_[grid].parent) ++parent;
        if (parent == names_.size() || !grids_[parent].parent.empty())
            reader_.fail(grids_[grid].begin,
                         fmt::format("the file is damaged: the grid \"{}\" shares the tree of another, and there is no "
                                     "such grid with a tree of its own",
                                     shown(names_[grid])));
        return parent;
    }

    void skip(std::uint64_t bytes, const char* what) {
        reader_.need(bytes, 1, what);
        reader_.seek(reader_.position() + bytes, what);
    }

    std::string string(const char* what) {
        const auto size = reader_.value<std::uint32_t>(what);
        if (size > max_name) damaged(fmt::format("a {} of {} bytes", what, size));
        return reader_.text(size, what);
    }

    // Reads the name, type, size and value of each entry. Returns the position of the value called `key` if it has
    // `bytes` bytes.
    std::optional<std::uint64_t> metadata(std::string_view key, std::uint32_t bytes) {
        std::optional<std::uint64_t> place;
        for (auto left = reader_.value<std::uint32_t>("metadata"); left > 0; --left) {
            const std::string name = string("name");
            const std::string type = string("type");
            const auto size = reader_.value<std::uint32_t>("metadata");
            reader_.need(size, 1, "metadata");
            const std::uint64_t at = reader_.position();
            if (name == key && size == bytes) place = at;
            for (const TypeSize& row : metadata_sizes)
                if (row.type == type && row.bytes != size)
                    damaged(fmt::format("its metadata has a {} of {} bytes", type, size));
            if (type == "__delayedload" && size > 0) check_leaf_sizes(at + size);
            reader_.seek(at + size, "metadata");
        }
        return place;
    }

    // A number of leaves, then a byte and 8 bytes for each, both after the length of their compressed form. A length of
    // 0 means that they are not compressed; one with all bits set, that they are left out.
    void check_leaf_sizes(std::uint64_t end) {
        const std::uint64_t leaves = reader_.value<std::uint32_t>("metadata");
        if (leaves > reader_.size()) damaged("it claims more leaves than it has bytes");
        for (const std::uint64_t each : {1, 8}) {
            const auto packed = reader_.value<std::uint32_t>("metadata");
            if (each == 8 && packed == 0xffffffff) continue;
            skip(packed > 0 ? packed : leaves * each, "metadata");
        }
        if (reader_.position() > end) damaged("the sizes of its leaves take more bytes than their header says");
    }

    void read_header() {
        if (reader_.value<std::int64_t>("header") != magic) reader_.fail(0, "not an OpenVDB file");
        format_ = reader_.value<std::uint32_t>("header");
        if (format_ > last_version)
            reader_.fail(8, fmt::format("version {} of the format is not supported; versions up to {} are", format_,
                                        last_version));
        if (format_ < first_version)
            reader_.fail(8, fmt::format("version {} of the format, written before 2013; save it with OpenVDB 1.2 or "
                                        "later",
                                        format_));
        library_ = reader_.value<std::array<std::uint32_t, 2>>("header");
        if (reader_.value<char>("header") == 0)
            reader_.fail(20, "the file was written as a stream, without the places of its grids");
        skip(uuid_bytes, "header");
        metadata("", 0);
        const auto count = reader_.value<std::uint32_t>("header");
        for (std::uint32_t i = 0; i < count; ++i) {
            read_descriptor();
            reader_.seek(grids_.back().end, "next grid");
        }
    }

    void read_descriptor() {
        constexpr std::string_view half = "_HalfFloat";
        Grid grid;
        VdbGridName name;
        const std::uint64_t at = reader_.position();
        name.unique_name = string("name");
        name.name = name.unique_name.substr(0, name.unique_name.find(vdb_suffix));
        name.type = string("type");
        grid.half = name.type.ends_with(half);
        if (grid.half) name.type.resize(name.type.size() - half.size());
        grid.parent = string("name");
        grid.begin = reader_.value<std::uint64_t>("places");
        reader_.value<std::uint64_t>("places");
        grid.end = reader_.value<std::uint64_t>("places");
        if (grid.begin < reader_.position() || grid.end < grid.begin || grid.end > reader_.size())
            reader_.fail(at,
                         fmt::format("the file is cut short or damaged: the grid \"{}\" lies from byte {} to {} of {}",
                                     name.name, grid.begin, grid.end, reader_.size()));
        grids_.push_back(grid);
        names_.push_back(name);
    }

    void check_grid(std::size_t index) {
        const Grid& grid = grids_[index];
        const VdbGridName& name = names_[index];
        // Before its data is read, since the types of other grids are not checked.
        if (name.type != vdb_float_tree)
            reader_.fail(grid.begin, fmt::format("the grid \"{}\" is a {}, not float", shown(name), name.type));
        half_ = grid.half;
        reader_.seek(grid.begin, "grid");
        compression_ = reader_.value<std::uint32_t>("compression");
        const std::uint64_t after = reader_.position();
        const auto lower = metadata("file_bbox_min", 12);
        const std::uint64_t end = reader_.position();
        reader_.seek(after, "metadata");
        const auto upper = metadata("file_bbox_max", 12);
        if (lower && upper) check_box(*lower, *upper);
        reader_.seek(end, "transform");
        check_transform();
        if (!grid.parent.empty()) return;
        check_tree(grid.end);
        if (reader_.position() > grid.end)
            damaged(fmt::format("the grid \"{}\" reaches beyond its end at byte {}", shown(name), grid.end));
    }

    void check_box(std::uint64_t lower_at, std::uint64_t upper_at) {
        reader_.seek(lower_at, "box");
        const auto lower = reader_.value<std::array<std::int32_t, 3>>("box");
        reader_.seek(upper_at, "box");
        const auto upper = reader_.value<std::array<std::int32_t, 3>>("box");
        double voxels = 1.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            voxels *= std::max(0.0, static_cast<double>(upper[axis]) - lower[axis] + 1.0);
        if (voxels > static_cast<double>(max_voxels))
            reader_.fail(upper_at, fmt::format("the active box has {} voxels; the limit is {}", voxels, max_voxels));
    }

    void check_transform() {
        const std::uint64_t at = reader_.position();
        const std::string type = string("transform");
        for (const TypeSize& row : map_sizes)
            if (row.type == type) return skip(row.bytes, "transform");
        reader_.fail(at, type == "NonlinearFrustumMap"
                             ? "the grid is not a box in the world: its transform is a frustum"
                             : fmt::format("the file is damaged: its transform is a \"{}\"", type.substr(0, 40)));
    }

    // Nodes of 32^3, 16^3 and 8^3 below a root: first the whole topology, then the values of the leaves, both depth
    // first.
    void check_tree(std::uint64_t end) {
        if (reader_.value<std::int32_t>("tree") != 1) damaged("the tree does not have exactly one buffer");
        skip(4, "background");
        const auto tiles = reader_.value<std::uint32_t>("root");
        const auto children = reader_.value<std::uint32_t>("root");
        constexpr std::uint64_t tile_bytes = 12 + 4 + 1, child_bytes = 12 + 2 * sizeof(Node<5>::Mask);
        constexpr std::int32_t child_side = 32 * 16 * 8;  // voxels
        if (reader_.position() > end || tiles * tile_bytes + children * child_bytes > end - reader_.position())
            damaged(fmt::format("it claims {} nodes and {} tiles", children, tiles));
        skip(tiles * tile_bytes, "tiles");
        leaves_ = 0;
        std::set<std::array<std::int32_t, 3>> places;
        for (std::uint32_t i = 0; i < children; ++i) {
            const auto place = reader_.value<std::array<std::int32_t, 3>>("node");
            for (const std::int32_t along : place)
                if (along % child_side != 0) damaged("a node of the tree lies between the places of nodes");
            // The library would keep the last of them, and lose the memory of the others.
            if (!places.insert(place).second) damaged("two nodes of the tree have the same place");
            for (std::uint64_t below = internal_node<5>(); below > 0; --below) {
                const std::uint64_t leaves = internal_node<4>();
                skip(leaves * sizeof(Node<3>::Mask), "leaves");
                leaves_ += leaves;
            }
        }
        for (; leaves_ > 0; --leaves_) values<3>(reader_.value<Node<3>::Mask>("leaf"));
    }

    // Returns the number of its children.
    template <std::size_t log2_side>
    std::uint64_t internal_node() {
        const auto children = reader_.value<typename Node<log2_side>::Mask>("node");
        const auto active = reader_.value<typename Node<log2_side>::Mask>("node");
        values<log2_side>(active);
        return Node<log2_side>::count(children);
    }

    template <std::size_t log2_side>
    void values(const typename Node<log2_side>::Mask& active) {
        const auto inactive = reader_.value<std::int8_t>("values");
        if (inactive < 0 || inactive > all_values) damaged(fmt::format("a node has the unknown kind {}", inactive));
        if (inactive == one_value || inactive == mask_one) skip(4, "values");
        if (inactive == mask_two) skip(8, "values");
        if (inactive == mask_none || inactive == mask_one || inactive == mask_two) skip(sizeof active, "values");
        const bool chosen = (compression_ & active_mask) != 0 && inactive != all_values;
        const std::uint64_t count = chosen ? Node<log2_side>::count(active) : Node<log2_side>::values;
        if (half_ && count == 0) return;
        const std::uint64_t bytes = count * (half_ ? 2 : 4);
        if ((compression_ & (zip | blosc)) == 0) return skip(bytes, "values");
        // The number of bytes that follow; negative if they are not compressed.
        const auto packed = reader_.value<std::int64_t>("values");
        if (packed <= 0 && static_cast<std::uint64_t>(-(packed + 1)) + 1 != bytes && !(packed == 0 && bytes == 0))
            damaged(fmt::format("a node of {} bytes claims {}", bytes, packed));
        skip(packed > 0 ? static_cast<std::uint64_t>(packed) : bytes, "values");
    }

    std::filesystem::path file_;
    FileReader reader_;
    std::vector<Grid> grids_;
    std::vector<VdbGridName> names_;  // of each grid
    std::uint32_t format_ = 0;
    std::array<std::uint32_t, 2> library_{};  // its version, major and minor
    std::uint32_t compression_ = 0;
    bool half_ = false;
    std::uint64_t leaves_ = 0;
};

}  // namespace

VdbGrid check_vdb(const std::filesystem::path& file, const GridChoice& choice) {
    return Walk(file).run(choice);
}

}  // namespace shadowbench::scene

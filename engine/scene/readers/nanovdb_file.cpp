#include "scene/readers/nanovdb_file.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace shadowbench::scene {
namespace {

// "NanoVDB0", and "NanoVDB2" since NanoVDB 32.6.
constexpr std::uint64_t nanovdb_magics[] = {0x304244566f6e614e, 0x324244566f6e614e};
constexpr std::uint32_t nanovdb_major = 32;
constexpr std::uint64_t boxes_bytes = 48 + 24 + 24;  // in the facts of a grid: world box, index box, edges of a voxel
constexpr std::uint64_t counts_bytes = 4 * 4 + 3 * 4 + 2 + 2 + 4;  // nodes, tiles, codec, padding, version
constexpr std::uint32_t longest_name = 65536;

// Types of grids with one number a voxel: float, double, Fp4, Fp8, Fp16 and FpN.
bool holds_densities(std::uint32_t type) {
    return type == 1 || type == 2 || (type >= 13 && type <= 16);
}

class Segments {
public:
    explicit Segments(FileReader& file) : file_(file) {}

    std::vector<NanoVdbGrid> read() {
        do read_segment();
        while (file_.position() < file_.size());
        return entries_;
    }

private:
    void read_segment() {
        const std::uint64_t at = file_.position();
        const auto magic = file_.value<std::uint64_t>("header");
        if (std::find(std::begin(nanovdb_magics), std::end(nanovdb_magics), magic) == std::end(nanovdb_magics))
            file_.fail(at, at == 0 ? "not a NanoVDB file" : "the file is damaged: no segment of NanoVDB begins here");
        const auto version = file_.value<std::uint32_t>("header");
        if (version >> 21 != nanovdb_major)
            file_.fail(at + 8, fmt::format("version {}.{} of NanoVDB; version {} is read: save the grid again with "
                                           "nanovdb_convert of that version",
                                           version >> 21, version >> 10 & 0x7ff, nanovdb_major));
        const auto grids = file_.value<std::uint16_t>("header");
        const auto codec = file_.value<std::uint16_t>("header");
        if (codec > static_cast<std::uint16_t>(NanoVdbCodec::blosc))
            file_.fail(at + 14, fmt::format("packing {}; none (0), ZIP (1) and BLOSC (2) are read", codec));
        const std::size_t first = entries_.size();
        for (unsigned i = 0; i < grids; ++i) read_entry(static_cast<NanoVdbCodec>(codec));
        for (std::size_t i = first; i < entries_.size(); ++i) {
            entries_[i].begin = file_.position();
            pass(entries_[i].bytes_in_file, "grid");
        }
    }

    void read_entry(NanoVdbCodec codec) {
        NanoVdbGrid entry;
        entry.codec = codec;
        entry.size = file_.value<std::uint64_t>("facts of a grid");
        entry.bytes_in_file = file_.value<std::uint64_t>("facts of a grid");
        pass(16, "facts of a grid");  // a hash of the name, the number of active voxels
        const auto type = file_.value<std::uint32_t>("facts of a grid");
        pass(4 + boxes_bytes, "facts of a grid");  // class, boxes
        const std::uint64_t name_at = file_.position();
        const auto name_bytes = file_.value<std::uint32_t>("facts of a grid");
        if (name_bytes > longest_name)
            file_.fail(name_at, fmt::format("the file is damaged: a name of {} bytes", name_bytes));
        pass(counts_bytes, "facts of a grid");
        const std::vector<char> name = file_.array<char>(name_bytes, "name");
        entry.name.name.assign(name.begin(), std::find(name.begin(), name.end(), '\0'));
        entry.name.unique_name = entry.name.name;
        entry.name.type = holds_densities(type) ? vdb_float_tree : fmt::format("grid of type {}", type);
        entries_.push_back(entry);
    }

    void pass(std::uint64_t bytes, const char* what) {
        file_.need(bytes, 1, what);
        file_.seek(file_.position() + bytes, what);
    }

    FileReader& file_;
    std::vector<NanoVdbGrid> entries_;
};

constexpr std::uint64_t most_packing_ratio = 1032;  // of the bytes that both kinds of packing shrink to one

}  // namespace

NanoVdbGrid find_nanovdb_grid(FileReader& file, const std::filesystem::path& name, const GridChoice& choice,
                              std::uint64_t most_bytes) {
    std::vector<NanoVdbGrid> grids = Segments(file).read();
    std::vector<VdbGridName> names;
    for (const NanoVdbGrid& grid : grids) names.push_back(grid.name);
    const std::size_t chosen = choose_grid(name, names, choice);
    NanoVdbGrid grid = std::move(grids[chosen]);
    if (grid.name.type != vdb_float_tree)
        file.fail(grid.begin, fmt::format("the grid \"{}\" is a {}; float, double, Fp4, Fp8, Fp16 and FpN are read",
                                          shown(grid.name), grid.name.type));
    if (grid.size > most_bytes)
        file.fail(grid.begin, fmt::format("a grid of {} bytes; the limit is {}", grid.size, most_bytes));
    const std::uint64_t ratio = grid.codec == NanoVdbCodec::none ? 1 : most_packing_ratio;
    if (grid.size / ratio > grid.bytes_in_file)
        file.fail(grid.begin, fmt::format("the file is damaged: {} bytes begin here, which cannot hold a grid of {}",
                                          grid.bytes_in_file, grid.size));
    for (std::size_t i = 0; i < names.size(); ++i)
        if (i != chosen) grid.passed_over.push_back(shown(names[i]));
    return grid;
}

}  // namespace shadowbench::scene

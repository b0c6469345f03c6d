#include "scene/readers/nanovdb_file.h"

#include <blosc.h>

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "scene/readers/unpacked_bytes.h"

namespace shadowbench::scene {
namespace {

// "NanoVDB0", and "NanoVDB2" since NanoVDB 32.6.
constexpr std::uint64_t nanovdb_magics[] = {0x304244566f6e614e, 0x324244566f6e614e};
constexpr std::uint32_t nanovdb_major = 32;
constexpr std::uint64_t boxes_bytes = 48 + 24 + 24;  // in the facts of a grid: world box, index box, edges of a voxel
constexpr std::uint64_t counts_bytes = 4 * 4 + 3 * 4 + 2 + 2 + 4;  // nodes, tiles, codec, padding, version
constexpr std::uint32_t longest_name = 65536;

enum class Codec : std::uint16_t { none, zip, blosc };

// Types of grids with one number a voxel: float, double, Fp4, Fp8, Fp16 and FpN.
bool holds_densities(std::uint32_t type) {
    return type == 1 || type == 2 || (type >= 13 && type <= 16);
}

struct GridEntry {
    VdbGridName name;
    Codec codec = Codec::none;
    std::uint64_t size = 0;                      // bytes of the grid
    std::uint64_t begin = 0, bytes_in_file = 0;  // of what it is packed into
};

class Segments {
public:
    explicit Segments(FileReader& file) : file_(file) {}

    std::vector<GridEntry> read() {
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
        if (codec > static_cast<std::uint16_t>(Codec::blosc))
            file_.fail(at + 14, fmt::format("packing {}; none (0), ZIP (1) and BLOSC (2) are read", codec));
        const std::size_t first = entries_.size();
        for (unsigned i = 0; i < grids; ++i) read_entry(static_cast<Codec>(codec));
        for (std::size_t i = first; i < entries_.size(); ++i) {
            entries_[i].begin = file_.position();
            pass(entries_[i].bytes_in_file, "grid");
        }
    }

    void read_entry(Codec codec) {
        GridEntry entry;
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
    std::vector<GridEntry> entries_;
};

constexpr std::uint64_t most_packing_ratio = 1032;  // of the bytes that both kinds of packing shrink to one

void unpack_blosc(FileReader& file, const GridEntry& entry, std::span<std::uint8_t> to) {
    constexpr std::size_t most_chunk = std::size_t{1} << 30;
    file.seek(entry.begin, "grid");
    while (!to.empty()) {
        const std::size_t chunk = std::min(to.size(), most_chunk);
        const std::uint64_t at = file.position();
        const std::vector<std::uint8_t> packed =
            file.array<std::uint8_t>(file.value<std::uint64_t>("packed grid"), "packed grid");
        std::size_t unpacked = 0;
        const bool sound = blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) == 0 && unpacked == chunk &&
                           blosc_decompress_ctx(packed.data(), to.data(), chunk, 1) == static_cast<int>(chunk);
        if (!sound) file.fail(at, fmt::format("the file is damaged: {} bytes are not packed here by BLOSC", chunk));
        to = to.subspan(chunk);
    }
}

void unpack_grid(FileReader& file, const GridEntry& entry, std::span<std::uint8_t> to) {
    if (entry.codec == Codec::blosc) return unpack_blosc(file, entry, to);
    const bool zip = entry.codec == Codec::zip;
    // The packed bytes follow their number.
    UnpackedBytes bytes(file, entry.begin + (zip ? sizeof(std::uint64_t) : 0), zip ? Packing::deflate : Packing::none);
    constexpr std::size_t most_at_once = std::size_t{1} << 20;
    while (!to.empty()) {
        const std::size_t count = std::min(to.size(), most_at_once);
        bytes.read(to.first(count), "grid");
        to = to.subspan(count);
    }
}

}  // namespace

NanoVdbGrid read_nanovdb_grid(FileReader& file, const std::filesystem::path& name, const GridChoice& choice,
                              std::uint64_t most_bytes) {
    const std::vector<GridEntry> entries = Segments(file).read();
    std::vector<VdbGridName> names;
    for (const GridEntry& entry : entries) names.push_back(entry.name);
    const std::size_t chosen = choose_grid(name, names, choice);
    const GridEntry& entry = entries[chosen];
    NanoVdbGrid grid{entry.name, {}, entry.begin, entry.size, {}};
    if (entry.name.type != vdb_float_tree)
        file.fail(entry.begin, fmt::format("the grid \"{}\" is a {}; float, double, Fp4, Fp8, Fp16 and FpN are read",
                                           shown(entry.name), entry.name.type));
    if (entry.size > most_bytes)
        file.fail(entry.begin, fmt::format("a grid of {} bytes; the limit is {}", entry.size, most_bytes));
    const std::uint64_t ratio = entry.codec == Codec::none ? 1 : most_packing_ratio;
    if (entry.size / ratio > entry.bytes_in_file)
        file.fail(entry.begin, fmt::format("the file is damaged: {} bytes begin here, which cannot hold a grid of {}",
                                           entry.bytes_in_file, entry.size));
    grid.blocks.resize(
        static_cast<std::size_t>((entry.size + sizeof(NanoVdbGrid::Block) - 1) / sizeof(NanoVdbGrid::Block)));
    unpack_grid(file, entry,
                std::span(reinterpret_cast<std::uint8_t*>(grid.blocks.data()), static_cast<std::size_t>(entry.size)));
    for (std::size_t i = 0; i < names.size(); ++i)
        if (i != chosen) grid.passed_over.push_back(shown(names[i]));
    return grid;
}

}  // namespace shadowbench::scene

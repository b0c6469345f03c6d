#include "techniques/deep/deep_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "techniques/deep/deep_file_format.h"
#include "techniques/deep/deep_lookup.h"
#include "techniques/deep/tile_cache.h"

namespace shadowbench::fuzz {
namespace {

using namespace techniques;

struct Entry {
    std::uint64_t offset;
    std::uint32_t words, checksum;
};

template <typename T>
T get(const std::string& file, std::uint64_t at) {
    T value;
    std::memcpy(&value, file.data() + at, sizeof value);
    return value;
}
template <typename T>
void put(std::string& file, std::uint64_t at, const T& value) {
    std::memcpy(file.data() + at, &value, sizeof value);
}

// Corrects the length and the checksums as far as the sizes in the header allow. Otherwise no input would reach the
// code behind them.
void repair(std::string& file) {
    if (file.size() < sizeof(deep_format::Header)) return;
    auto header = get<deep_format::Header>(file, 0);
    header.magic = deep_format::magic;
    header.byte_order = deep_format::byte_order;
    if (header.version != deep_format::wide_version) header.version = deep_format::unit_version;
    header.file_bytes = file.size();
    header.checksum = deep_format::header_checksum(header);
    put(file, 0, header);
    const auto side = [](std::uint32_t n) { return n >= 1 && n <= deep_format::max_side; };
    if (!side(header.width) || !side(header.height) || header.tile_size < 1 || header.tile_size > max_deep_tile ||
        header.levels < 1 || header.levels > deep_format::max_levels(header.width, header.height))
        return;
    const DeepTiling last = deep_format::tilings(static_cast<int>(header.width), static_cast<int>(header.height),
                                                 static_cast<int>(header.levels), static_cast<int>(header.tile_size))
                                .back();
    const std::uint64_t tiles = last.first + last.tiles(), start = sizeof header + header.text_bytes;
    const std::uint64_t end = start + tiles * sizeof(Entry);
    if (header.text_bytes > file.size() || end + 4 > file.size()) return;
    std::uint64_t next = end + 4;
    for (std::uint64_t at = start; at < end; at += sizeof(Entry)) {
        auto entry = get<Entry>(file, at);
        const std::uint64_t left = (file.size() - next) / 4;
        if (entry.words > left || at + sizeof(Entry) == end) entry.words = static_cast<std::uint32_t>(left);
        entry.offset = next;
        entry.checksum = deep_format::checksum(file.data() + next, std::size_t{entry.words} * 4);
        next += std::uint64_t{entry.words} * 4;
        put(file, at, entry);
    }
    put(file, end, deep_format::checksum(file.data() + sizeof header, end - sizeof header));
}

void expect_sound(const DeepLevel& level) {
    const std::size_t pixels = static_cast<std::size_t>(level.width) * level.height;
    expect(level.offsets.size() == pixels + 1 && level.offsets[0] == 0, "an offset a pixel, and one more");
    expect(std::is_sorted(level.offsets.begin(), level.offsets.end()), "offsets do not decrease");
    expect(level.floats.size() == level.offsets.back() + DeepLevel::padding, "offsets index floats");
    expect_finite(level.floats, "nodes are finite");
    for (std::size_t p = 0; p < pixels; ++p) {
        const float* depths = level.floats.data() + level.offsets[p];
        expect(std::is_sorted(depths, depths + level.nodes(p)), "depths do not decrease");
    }
}

std::vector<Query> queries_of(const DeepFile& file, const std::vector<DeepLevel>& levels) {
    std::vector<float> depths = {file.notes().z_min, file.notes().z_max, 0.0f, -3e38f, 3e38f};
    for (std::size_t i = 0; i < std::min<std::size_t>(levels[0].floats.size(), 32); ++i)
        depths.push_back(levels[0].floats[i]);
    std::vector<Query> queries;
    for (const float z : depths)
        for (const float share : {-0.1f, 0.01f, 0.5f, 0.99f, 2.0f})
            for (const float width : {0.1f, 1.0f, 3.0f})
                queries.push_back({share * static_cast<float>(levels[0].width),
                                   share * static_cast<float>(levels[0].height), z, width});
    return queries;
}

void read_all(const std::string& bytes) {
    const InputFile file(bytes, ".dsm");
    attempt({base::ErrorCode::bad_input}, [&] {
        const DeepFile deep(file.path());
        const std::vector<DeepLevel> levels = read_levels(deep);
        for (const DeepLevel& level : levels) expect_sound(level);
        const std::vector<Query> queries = queries_of(deep, levels);
        std::vector<float> visibility(queries.size() * static_cast<std::size_t>(deep.channels()));
        const std::vector<Footprint> footprints(queries.size(), Footprint{5.0f, 1.0f, -0.5f, 2.0f});
        const float least = deep.unit_range() ? deep_format::unit_least : deep_format::wide_least;
        const float most = deep.unit_range() ? deep_format::unit_most : deep_format::wide_most;
        TileCache cache(deep, 2);
        std::vector<float> of_tiles(visibility.size());
        for (const LookupRule& rule : {LookupRule{}, LookupRule{Kernel::tent, Mip::blend, Search::linear, 0},
                                       LookupRule{Kernel::pixels, Mip::nearest, Search::binary, 0},
                                       LookupRule{Kernel::box, Mip::nearest, Search::cached, 4}}) {
            if (rule.mip != Mip::none && levels.size() == 1) continue;
            lookup(levels, rule, queries, footprints, visibility);
            expect_in(visibility, least, most, "lookups stay in the range of the stored values");
            lookup(cache, rule, queries, footprints, of_tiles);
            expect(of_tiles == visibility, "lookups through tiles give the same");
        }
    });
}

}  // namespace

void deep_file(std::string_view bytes) {
    std::string file(bytes);
    read_all(file);
    repair(file);
    read_all(file);
}

}  // namespace shadowbench::fuzz

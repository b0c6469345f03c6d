#include "techniques/deep/tiled_map.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/temporary_folder.h"

namespace shadowbench::techniques {
namespace {

// The folder goes at once: the file stays readable as long as it is open, and nobody else can change it.
std::unique_ptr<const DeepFile> write_and_open(std::span<const DeepLevel> levels, const DeepFileNotes& notes) {
    try {
        const base::TemporaryFolder folder;
        const std::filesystem::path file = folder.path() / "map.dsm";
        write_deep_file(file, levels, tile_side, notes);
        return std::make_unique<const DeepFile>(file);
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::io) throw;
        throw base::Error(error.code(), error.where(),
                          fmt::format("{}; storage=tiled keeps the map in a temporary file there: free space, set "
                                      "TMPDIR to another folder, or choose storage=memory",
                                      error.message()));
    }
}

}  // namespace

TiledMap::TiledMap(std::span<const DeepLevel> levels, std::size_t slots, const DeepFileNotes& notes)
    : file_(write_and_open(levels, notes)), cache_(*file_, slots) {}

void TiledMap::lookup(const LookupRule& rule, std::span<const Query> queries, std::span<const Footprint> footprints,
                      std::span<float> visibility) const {
    const std::lock_guard lock(mutex_);
    techniques::lookup(cache_, rule, queries, footprints, visibility);
}

void TiledMap::touched(const LookupRule& rule, const Query& query, const Footprint& footprint,
                       std::vector<const void*>& lines) const {
    const std::lock_guard lock(mutex_);
    techniques::touched(cache_, rule, query, footprint, lines);
}

void TiledMap::stored(int x, int y, int channel, curves::Curve& out) const {
    const std::lock_guard lock(mutex_);
    const DeepFunction f = cache_.function(x, y, 0);
    const float* const values = f.values(f.channels == 3 ? channel : 0);
    out.resize(f.nodes);
    for (std::uint32_t i = 0; i < f.nodes; ++i) out[i] = {f.depths[i], values[i]};
}

TileCounts TiledMap::counts() const {
    const std::lock_guard lock(mutex_);
    return {file_->tiles(),     cache_.slots(),      cache_.hits(),
            cache_.misses(),    cache_.tile_bytes(), file_->bytes() + cache_.bytes(),
            file_->file_bytes()};
}

std::size_t TiledMap::bytes() const {
    return file_->bytes() + cache_.most_bytes();
}

}  // namespace shadowbench::techniques

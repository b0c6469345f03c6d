#include "bench/curve_check.h"

#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/curve_faults.h"
#include "bench/node_ratio.h"
#include "curves/norms.h"
#include "curves/sweep.h"

namespace shadowbench::bench {
namespace {

using curves::Curve;
using rays::LightRays;
using rays::MapLayout;
using techniques::Cells;

constexpr double finest = 0x1p-24;    // finer than this, floats do not distinguish lines from exponentials
constexpr double fine_bound = 16e-6;  // promises up to this are judged with the finer reference

// Number of rays whose cells are judged with the finer reference, which has up to forty times as many vertices.
constexpr std::size_t fine_rays = std::size_t{1} << 14;
constexpr std::size_t least_fine_cells = 64;

// The errors of one technique within one tile.
struct TileErrors {
    std::vector<double> max;  // one a checked cell
    double l1 = 0.0, worst = -1.0;
    double rise = 0.0, lowest = 0.0;
    int worst_x = 0, worst_y = 0;
    std::string broken;
    NodesBesideFewest nodes;
};

struct CellRays {
    int x, y;           // of the map of cells
    std::size_t first;  // ray
    std::size_t count;  // of rays
};

// The cells of pixel `p` of a tile, and the rays of each.
void cells_of_pixel(Cells kind, const LightRays& tile, const MapLayout& layout, std::size_t p,
                    std::vector<CellRays>& out) {
    out.clear();
    const std::size_t samples = static_cast<std::size_t>(tile.samples);
    const int x = tile.x0 + static_cast<int>(p % static_cast<std::size_t>(tile.width));
    const int y = tile.y0 + static_cast<int>(p / static_cast<std::size_t>(tile.width));
    if (kind == Cells::pixel) out.push_back({x, y, p * samples, samples});
    if (kind == Cells::centre)
        out.push_back(
            {x, y,
             p * samples + static_cast<std::size_t>((layout.samples_y / 2) * layout.samples_x + layout.samples_x / 2),
             1});
    if (kind == Cells::sample)
        for (std::size_t s = 0; s < samples; ++s)
            out.push_back({x * layout.samples_x + static_cast<int>(s) % layout.samples_x,
                           y * layout.samples_y + static_cast<int>(s) / layout.samples_x, p * samples + s, 1});
}

// Scratch for the cells of a pixel. The reference curve of a cell is shared by all techniques that store such cells.
struct PixelScratch {
    curves::SweepScratch sweep;
    Curve reference, stored;
    std::vector<float> depths;
    std::vector<CellRays> cells;
    std::vector<curves::WeightedRay> weights;
};

bool is_checked(const CellRays& cell, std::uint64_t share) {
    return share == 1 ||
           (share > 1 &&
            base::hash(static_cast<std::uint64_t>(cell.x), static_cast<std::uint64_t>(cell.y)) % share == 0);
}

struct Pass {
    const MapLayout& layout;
    std::span<const CheckedMap> maps;
    int apron;                                     // of the tiles; maps of other aprons are checked in other passes
    std::vector<std::uint64_t> share, fine_share;  // one cell in so many is checked, by technique; 0: none
    double coarse, finer;  // errors of the lines that approximate exponentials in the two references

    double linearisation(bool fine) const { return fine ? finer : coarse; }

    // Whether this cell of a map is held to the reference in question: the finer or the coarser one.
    bool checks(std::size_t m, Cells kind, bool fine, const CellRays& cell) const {
        if (maps[m].apron != apron || cells(*maps[m].maps) != kind) return false;
        const bool in_fine_share = is_checked(cell, fine_share[m]);
        return fine ? in_fine_share : !in_fine_share && is_checked(cell, share[m]);
    }
};

std::uint64_t share_of(Cells kind, const MapLayout& layout, std::size_t max_cells) {
    const std::uint64_t cells = static_cast<std::uint64_t>(layout.width) * static_cast<std::uint64_t>(layout.height) *
                                static_cast<std::uint64_t>(kind == Cells::sample ? layout.samples() : 1);
    return std::max<std::uint64_t>(1, (cells + max_cells - 1) / max_cells);
}

bool is_fine(const CheckedMap& map, const MapLayout& layout) {
    return layout.media && map.bound_holds && map.error_bound <= fine_bound;
}

// A sixteenth of the smallest bound that this reference is for.
double linearisation_for(const Pass& pass, bool fine) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const CheckedMap& map : pass.maps)
        if (map.bound_holds && is_fine(map, pass.layout) == fine) smallest = std::min(smallest, map.error_bound);
    return fine ? std::clamp(smallest / 16.0, finest, 1e-6) : std::clamp(smallest / 16.0, 1e-6, 1e-4);
}

std::size_t max_fine_cells(Cells kind, const MapLayout& layout) {
    const bool one_ray = kind == Cells::sample || kind == Cells::centre;
    const std::size_t rays = one_ray ? 1 : static_cast<std::size_t>(layout.samples());
    return std::max(fine_rays / rays, least_fine_cells);
}

void take_depths(PixelScratch& scratch) {
    scratch.depths.clear();
    for (const curves::Vertex& v : scratch.reference) scratch.depths.push_back(v.z);
}

void measure(const curves::Distance& d, const Curve& stored, const CellRays& cell, TileErrors& errors) {
    double least = std::numeric_limits<double>::infinity();
    for (const curves::Vertex& v : stored) {
        errors.rise = std::max(errors.rise, v.value - least);
        least = std::min<double>(least, v.value);
    }
    errors.lowest = std::min(errors.lowest, least);
    errors.max.push_back(d.max);
    errors.l1 += d.l1;
    if (d.max <= errors.worst) return;
    errors.worst = d.max;
    errors.worst_x = cell.x;
    errors.worst_y = cell.y;
}

// `fine`: whether `scratch` holds the finer reference.
void check_cell(const Pass& pass, std::size_t m, bool fine, int channel, const CellRays& cell, PixelScratch& scratch,
                TileErrors& errors) {
    const CheckedMap& checked = pass.maps[m];
    stored(*checked.maps, cell.x, cell.y, channel, scratch.depths, scratch.stored);
    const curves::Distance d =
        curves::distance(scratch.stored, scratch.reference, pass.layout.z_min, pass.layout.z_max);
    if (fine == is_fine(checked, pass.layout)) measure(d, scratch.stored, cell, errors);
    if (!errors.broken.empty()) return;
    std::string fault = fault_of(scratch.stored, checked.promises);
    const double slack = (pass.layout.media ? pass.linearisation(fine) : 0.0) + promise_rounding;
    const double allowed = checked.error_bound + slack;
    const techniques::Promises& promised = checked.promises;
    if (fault.empty() && checked.bound_holds && (!promised.localised || promised.approximate))
        fault = fault_of_ends(scratch.stored, scratch.reference, promised.early, promised.leak + slack);
    if (fault.empty() && checked.bound_holds && !(d.max <= allowed))
        fault = fmt::format("the curve error {:.6g} is above the promised {:.6g}", d.max, checked.error_bound);
    if (!fault.empty()) errors.broken = fmt::format("cell ({}, {}): {}", cell.x, cell.y, fault);
}

void check_kind(const Pass& pass, Cells kind, bool fine, int channel, const LightRays& rays, std::size_t pixel,
                PixelScratch& scratch, std::vector<TileErrors>& errors) {
    cells_of_pixel(kind, rays, pass.layout, pixel, scratch.cells);
    for (const CellRays& cell : scratch.cells) {
        bool have_reference = false;
        for (std::size_t m = 0; m < pass.maps.size(); ++m) {
            if (!pass.checks(m, kind, fine, cell)) continue;
            if (!have_reference) {
                curves::visibility(rays, cell.first, cell.count, pass.linearisation(fine), scratch.sweep,
                                   scratch.reference);
                take_depths(scratch);
                have_reference = true;
            }
            check_cell(pass, m, fine, channel, cell, scratch, errors[m]);
        }
    }
}

// For cells whose technique weighs rays: each technique has its own reference.
void check_filtered(const Pass& pass, bool fine, int channel, const LightRays& rays, int x, int y,
                    PixelScratch& scratch, std::vector<TileErrors>& errors) {
    const CellRays cell{x, y, 0, 0};
    for (std::size_t m = 0; m < pass.maps.size(); ++m) {
        if (!pass.checks(m, Cells::filtered, fine, cell)) continue;
        pass.maps[m].maps->parts[0]->weights(x, y, rays, scratch.weights);
        curves::visibility(rays, scratch.weights, pass.linearisation(fine), scratch.sweep, scratch.reference);
        take_depths(scratch);
        check_cell(pass, m, fine, channel, cell, scratch, errors[m]);
    }
}

std::vector<TileErrors> check_tile(const Pass& pass, const LightRays& tile) {
    std::vector<TileErrors> errors(pass.maps.size());
    PixelScratch scratch;
    for (std::size_t m = 0; m < pass.maps.size(); ++m)
        if (const CheckedMap& map = pass.maps[m]; map.nodes && map.apron == pass.apron)
            compare_nodes(*map.maps, tile, pass.layout, errors[m].nodes);
    for (int c = 0; c < tile.channels; ++c) {
        LightRays copy;
        if (tile.channels > 1) copy = rays::channel(tile, c);
        const LightRays& rays = tile.channels > 1 ? copy : tile;
        const rays::TileCore core = rays::core_of(pass.layout, tile.tile);
        for (int y = core.y0; y < core.y0 + core.height; ++y)
            for (int x = core.x0; x < core.x0 + core.width; ++x) {
                const std::size_t p = static_cast<std::size_t>(y - tile.y0) * static_cast<std::size_t>(tile.width) +
                                      static_cast<std::size_t>(x - tile.x0);
                for (const bool fine : {false, true}) {
                    for (const Cells kind : {Cells::pixel, Cells::sample, Cells::centre})
                        check_kind(pass, kind, fine, c, rays, p, scratch, errors);
                    check_filtered(pass, fine, c, rays, x, y, scratch, errors);
                }
            }
    }
    return errors;
}

CurveVerdict merge(std::span<const std::vector<TileErrors>> tiles, std::size_t map, double reference_error) {
    CurveVerdict verdict;
    results::CurveErrors errors;
    errors.reference_error = reference_error;
    std::vector<double> all;
    double worst = -1.0;
    for (const std::vector<TileErrors>& tile : tiles) {
        const TileErrors& part = tile[map];
        verdict.nodes.push_back(part.nodes);
        all.insert(all.end(), part.max.begin(), part.max.end());
        errors.mean_l1 += part.l1;
        errors.rise = std::max(errors.rise, part.rise);
        errors.lowest = std::min(errors.lowest, part.lowest);
        if (part.worst > worst) {
            worst = part.worst;
            errors.worst_x = part.worst_x;
            errors.worst_y = part.worst_y;
        }
        if (verdict.broken.empty()) verdict.broken = part.broken;
    }
    if (all.empty()) return verdict;
    errors.cells = all.size();
    errors.norms = metrics::error_norms(all);
    errors.mean_l1 /= static_cast<double>(all.size());
    verdict.errors = errors;
    return verdict;
}

}  // namespace

std::vector<CurveVerdict> check_curves(const RaySource& source, const MapLayout& layout,
                                       std::span<const CheckedMap> maps, std::size_t max_cells,
                                       const RaySource::Watch& watch) {
    Pass pass{layout, maps, 0, {}, {}, 0.0, 0.0};
    pass.coarse = linearisation_for(pass, false);
    pass.finer = linearisation_for(pass, true);
    std::set<int> aprons;
    for (const CheckedMap& map : maps) {
        const Cells kind = cells(*map.maps);
        const std::size_t fine_cells = std::min(max_cells, max_fine_cells(kind, layout));
        pass.share.push_back(share_of(kind, layout, max_cells));
        pass.fine_share.push_back(is_fine(map, layout) ? share_of(kind, layout, fine_cells) : 0);
        aprons.insert(map.apron);
    }

    std::vector<std::vector<TileErrors>> tiles;
    for (const int apron : aprons) {
        pass.apron = apron;
        source.for_each_batch(apron, [&](RaySource::Batch batch) {
            const std::size_t before = tiles.size();
            tiles.resize(before + batch.size());
            base::parallel_for(batch.size(), [&](std::size_t i) { tiles[before + i] = check_tile(pass, batch[i]); });
            if (watch) watch(tiles.size() / aprons.size());
        });
    }

    std::vector<CurveVerdict> verdicts;
    for (std::size_t m = 0; m < maps.size(); ++m) {
        if (std::string fault = bench::fault(*maps[m].maps); !fault.empty()) {
            verdicts.push_back({std::nullopt, std::move(fault), {}});
            continue;
        }
        verdicts.push_back(merge(tiles, m, layout.media ? pass.linearisation(is_fine(maps[m], layout)) : 0.0));
    }
    return verdicts;
}

}  // namespace shadowbench::bench

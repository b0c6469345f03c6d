#include "techniques/depth/pcf_samples.h"

#include <cmath>

namespace shadowbench::techniques {
namespace {

constexpr float largest_half = 1e9f;  // cells or pixels: a larger footprint says nothing about the map

// The box with these half-sizes around the position of a lookup.
Region box_region(const PcfSettings& settings, float sres, float tres) {
    const Partition p = partition(settings, sres, tres);
    Region r;
    r.left = -sres;
    r.bottom = -tres;
    r.ax = 2.0f * sres / static_cast<float>(p.ns);
    r.by = 2.0f * tres / static_cast<float>(p.nt);
    r.ns = p.ns;
    r.nt = p.nt;
    return r;
}

}  // namespace

// Figure 4 truncates sizes plus a half to whole numbers. If few cells lie in the region there is about one sample for
// each cell; otherwise num_samples, divided between the sides as the region is.
Partition partition(const PcfSettings& settings, float sres, float tres) {
    const float most = std::max(settings.num_samples, settings.min_samples);
    const auto whole = [&](float n) {  // n >= 0; limited first to what an int holds
        const float cut = static_cast<float>(static_cast<int>(std::min(n + 0.5f, most)));
        return std::max(cut, settings.min_samples);
    };
    float ns, nt;
    if (sres * tres * 4.0f < settings.num_samples) {
        ns = whole(sres * 2.0f);
        nt = whole(tres * 2.0f);
    } else {
        nt = whole(std::sqrt(tres * settings.num_samples / sres));
        ns = whole(settings.num_samples / nt);
    }
    return {static_cast<int>(ns), static_cast<int>(nt)};
}

Region square_region(const PcfSettings& settings, const CellGrid& grid, float width) {
    const float half = std::min(std::max(0.0f, 0.5f * width), largest_half);  // 0 for a NaN
    return box_region(settings, std::max(half * grid.per_pixel_x * settings.res_factor, settings.min_size),
                      std::max(half * grid.per_pixel_y * settings.res_factor, settings.min_size));
}

bool footprint_region(const PcfSettings& settings, const CellGrid& grid, const Footprint& f, bool shape, Region& out) {
    const float to_x = grid.per_pixel_x * settings.res_factor, to_y = grid.per_pixel_y * settings.res_factor;
    const float half_x = 0.5f * (std::abs(f.ux) + std::abs(f.vx)) * to_x;
    const float half_y = 0.5f * (std::abs(f.uy) + std::abs(f.vy)) * to_y;
    if (!f.known() || !(half_x < largest_half && half_y < largest_half)) return false;
    const float sres = std::max(half_x, settings.min_size), tres = std::max(half_y, settings.min_size);
    if (!(sres > 0.0f && tres > 0.0f)) return false;
    const float stretch_x = to_x * (sres / half_x), stretch_y = to_y * (tres / half_y);
    const bool flat = !(std::isfinite(stretch_x) && std::isfinite(stretch_y));  // too thin to be stretched to a size
    if (!shape || flat) {
        out = box_region(settings, sres, tres);
        return true;
    }
    const float ux = f.ux * stretch_x, uy = f.uy * stretch_y, vx = f.vx * stretch_x, vy = f.vy * stretch_y;
    const Partition p = partition(settings, 0.5f * std::sqrt(ux * ux + uy * uy), 0.5f * std::sqrt(vx * vx + vy * vy));
    const float ns = static_cast<float>(p.ns), nt = static_cast<float>(p.nt);
    out = {-0.5f * (ux + vx), -0.5f * (uy + vy), ux / ns, uy / ns, vx / nt, vy / nt, p.ns, p.nt};
    return true;
}

Extent extent(const Region& r, float x, float y) {
    const float ns = static_cast<float>(r.ns), nt = static_cast<float>(r.nt);
    const auto range = [](float from, float a, float b, float& low, float& high) {
        low = from + std::min(0.0f, a) + std::min(0.0f, b);
        high = from + std::max(0.0f, a) + std::max(0.0f, b);
    };
    Extent e;
    range(x + r.left, ns * r.ax, nt * r.bx, e.x0, e.x1);
    range(y + r.bottom, ns * r.ay, nt * r.by, e.y0, e.y1);
    return e;
}

const GaussianTable& gaussian_table() {
    static const GaussianTable table = [] {
        GaussianTable result;
        const double edge = 2.0;  // standard deviations
        const double half = std::erf(edge / std::sqrt(2.0));
        for (int i = 0; i <= GaussianTable::steps; ++i) {
            const double wanted = half * (2.0 * i / GaussianTable::steps - 1.0);
            double low = -edge, high = edge;
            for (int step = 0; step < 50; ++step) {
                const double middle = 0.5 * (low + high);
                (std::erf(middle / std::sqrt(2.0)) < wanted ? low : high) = middle;
            }
            result.quantile[i] = static_cast<float>(0.5 + 0.25 * (low + high) / edge);
        }
        return result;
    }();
    return table;
}

}  // namespace shadowbench::techniques

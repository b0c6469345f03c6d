// The usual storage, complete: one texel for each cell, each of the same number of floats, and lookups that filter over
// texels. A technique of this kind is a class Own : TexelMap<Own> that defines the content of a texel. It has
//
//   explicit Own(const ParameterValues&)                hands the values on to TexelMap
//   static int floats_a_texel(const ParameterValues&)
//   void fill(const rays::LightRays&)                   fills the texels of a tile, with for_each_texel; each texel is
//                                                       of one ray, which may be the mean of a pixel's rays: see
//                                                       sums_rays
//   prepare(float z) const                              what an evaluation needs of a depth; made once a lookup
//   float evaluate(texel, prepared) const               the visibility that a texel gives
//   int nodes_of(const float* texel) const              0 if the texel is empty
//   static constexpr int most_own_depths
//   int own_depths(const float* texel, float* out) const    the depths, sorted, that stored() samples its function at
//                                                           beside those it is given; their number
//
// and overrides the rest where it differs; a class that overrides stored() needs no own depths. Row fields:
// create_map<Own>, Own::least_bytes, texel_traits().
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "techniques/mean_rays.h"
#include "techniques/store/most_bytes.h"
#include "techniques/store/texels.h"

namespace shadowbench::techniques {

// The traits for the parameters filter_parameter and averaged_cells_parameter.
inline Traits texel_traits() {
    return {.pointwise = {{"filter", "point"}}, .whole_pixel = {{"filter", "footprint"}, {"cells", "pixel"}}};
}

template <class Own>
class TexelMap : public Map {
public:
    // If not 0: lookups filter this many floats of the texels, and call `evaluate` once, with their means as doubles.
    // If 0: lookups call `evaluate` for each texel and filter its answers.
    static constexpr int filtered_floats = 0;

    // If false: with cells=pixel, `fill` gets one ray a pixel, of the mean visibility of the pixel's rays. If true: it
    // gets all of them, and a texel is the sum over rays_a_texel() rays, from the one that for_each_texel gives on.
    static constexpr bool sums_rays = false;

    static constexpr int most_own_depths = 0;
    int own_depths(const float*, float*) const { return 0; }

    static std::size_t least_bytes(const ParameterValues& values, const rays::MapLayout& layout) {
        return Texels::bytes(values, layout, Own::floats_a_texel(values));
    }

    RayNeeds needs() const override { return {.means = !Own::sums_rays && texels_.kind == Cells::pixel}; }
    void begin(const BuildInput& input) override { allocate(input.layout); }
    void add(const rays::LightRays& tile) override {
        if (!TexelMap::needs().means || tile.samples == 1) return own().fill(tile);
        MeanRays means;
        means.of(tile);
        TexelMap::add_means(means);
    }
    void add_means(const MeanRays& means) override {
        own().fill(means.rays());
        scratch_.add(means.bytes());
    }
    void finish() override {}
    void set_lookups(const ParameterValues& values) override { texels_.filter = read_filter(values); }

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        if constexpr (Own::filtered_floats > 0) {
            texels_.template lookup_means<Own::filtered_floats>(
                queries, visibility, [this](float z) { return own().prepare(z); },
                [this](const auto* texel, const auto& prepared) { return own().evaluate(texel, prepared); });
        } else {
            std::array<decltype(own().prepare(0.0f)), block_queries> prepared;
            texels_.lookup(
                queries, visibility,
                [&](std::span<const Query> block) {
                    own().prepare_all(block, prepared);
                    // The empty places of slots are evaluated too.
                    if (block.size() >= Reads::fewest_in_slots)
                        std::fill(prepared.begin() + block.size(), prepared.end(), prepared[0]);
                },
                [&](Reads& reads) { own().evaluate_all(reads, prepared); });
        }
    }
    // prepared[k]: of the depth of query k of a block.
    template <class Prepared>
    void prepare_all(std::span<const Query> block, std::array<Prepared, block_queries>& prepared) const {
        for (std::size_t k = 0; k < block.size(); ++k) prepared[k] = own().prepare(block[k].z);
    }
    // The values of all reads; prepared[reads.query[r]] is what prepare() made of the depth of read r.
    template <class Prepared>
    void evaluate_all(Reads& reads, const std::array<Prepared, block_queries>& prepared) const {
        for (std::size_t r = 0; r < reads.count; ++r)
            reads.value[r] = own().evaluate(reads.texel[r], prepared[reads.query[r]]);
    }
    void touched(const Query& query, std::vector<const void*>& lines) const override {
        const std::size_t before = lines.size();
        texels_.for_each(query, [&](std::size_t cell, double) {
            touch_lines(texels_.at(cell), sizeof(float) * texels_.stride, lines);
        });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override { return texels_.bytes(); }
    std::size_t working_bytes() const override { return texels_.bytes() + scratch_.value(); }
    NodeStats nodes() const override {
        NodeStats stats;
        for (std::size_t cell = 0; cell < texels_.grid.count(); ++cell)
            stats.add(static_cast<std::uint32_t>(own().nodes_of(texels_.at(cell))));
        return stats;
    }
    Cells cells() const override { return texels_.kind; }
    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        out.clear();
        const float* texel = texels_.at(texels_.grid.index(x, y));
        if (own().nodes_of(texel) == 0) return;
        std::array<float, Own::most_own_depths> depth;
        const auto count = static_cast<std::size_t>(own().own_depths(texel, depth.data()));
        sample_function(
            std::span(depth).first(count), depths, [&](float z) { return own().evaluate(texel, own().prepare(z)); },
            out);
    }

protected:
    explicit TexelMap(const ParameterValues& values) : texels_(values), floats_(Own::floats_a_texel(values)) {}

    void allocate(const rays::MapLayout& layout) {
        layout_ = layout;
        texels_.allocate(layout_, floats_);
    }

    // Calls visit(texel, cell, ray) for every texel that a tile fills.
    template <class Visit>
    void for_each_texel(const rays::LightRays& tile, const Visit& visit) {
        for_each_cell(layout_, texels_.grid, texels_.kind, tile,
                      [&](std::size_t cell, std::size_t ray) { visit(texels_.at(cell), cell, ray); });
    }
    std::size_t rays_a_texel(const rays::LightRays& tile) const {
        return texels_.kind == Cells::pixel ? static_cast<std::size_t>(tile.samples) : 1;
    }

    Texels texels_;
    rays::MapLayout layout_;
    MostBytes scratch_;  // scratch memory that grows with the scene

private:
    Own& own() { return static_cast<Own&>(*this); }
    const Own& own() const { return static_cast<const Own&>(*this); }

    int floats_;
};

}  // namespace shadowbench::techniques

// Maps that grow together share the functions of rays in media and the means of a pixel's rays; each must be the map
// that grows by itself.
#include "bench/shared_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/build_timing.h"
#include "bench/contender.h"
#include "bench/memory.h"
#include "rays/capture.h"
#include "rays/scenes.h"

namespace shadowbench::bench {
namespace {

// Its add() fails and its add_means() only counts, so that all the time of its build is that of the shared means.
class MeansMap : public techniques::Map {
public:
    static inline int added = 0;
    static inline int begun = 0, most = 0;  // maps that were begun and still exist, and the most at a time
    static inline std::vector<const techniques::MeanRays*> given = {};

    ~MeansMap() override { begun -= begun_; }
    techniques::RayNeeds needs() const override { return {.means = true}; }
    void begin(const techniques::BuildInput&) override {
        begun_ = true;
        most = std::max(most, ++begun);
    }
    void add(const rays::LightRays&) override { ++added; }
    void add_means(const techniques::MeanRays& means) override { given.push_back(&means); }
    void finish() override {}
    void lookup(std::span<const techniques::Query>, std::span<float>) const override {}
    void touched(const techniques::Query&, std::vector<const void*>&) const override {}
    std::size_t bytes() const override { return 0; }
    std::size_t working_bytes() const override { return 0; }
    techniques::NodeStats nodes() const override { return {}; }
    techniques::Cells cells() const override { return techniques::Cells::pixel; }
    void stored(int, int, int, std::span<const float>, curves::Curve& out) const override { out.clear(); }

private:
    bool begun_ = false;
};

// The same for the functions of single rays.
class FunctionsMap final : public MeansMap {
public:
    static inline std::vector<const curves::RayFunctions*> handed = {};

    techniques::RayNeeds needs() const override { return {.functions = true}; }
    void add_functions(const rays::LightRays&, const curves::RayFunctions& functions) override {
        handed.push_back(&functions);
    }
};

template <class Made>
Contender counting() {
    static const techniques::Technique row{
        .id = "counts", .create = [](const techniques::ParameterValues&) -> std::unique_ptr<techniques::Map> {
            return std::make_unique<Made>();
        }};
    Contender contender;
    contender.row = &row;
    contender.needs = Made().needs();
    return contender;
}
Contender of_means() {
    return counting<MeansMap>();
}
Contender of_functions() {
    return counting<FunctionsMap>();
}

// A medium with hair before it and beside it, a channel or three.
class SharedTiles : public ::testing::Test {
protected:
    void light(int samples, bool coloured) {
        constexpr int resolution = 24;  // one tile
        MeansMap::added = 0;
        MeansMap::given.clear();
        FunctionsMap::handed.clear();
        scene_.objects.resize(2);
        scene::GridVolume slab = rays::testing::slab();
        slab.upper.x = 0.1f;  // some pixels have hair only
        scene_.objects[0].shape = slab;
        if (coloured) scene_.objects[0].extinction = {1.0f, 0.5f, 0.25f};
        scene_.objects[1] = rays::testing::curly_hair(40, 12, 0.02f, 5);
        scene_.objects[1].opacity = {0.6f, 0.6f, 0.6f};
        view_ = rays::make_light_view(rays::testing::directional(), scene_, {resolution, resolution}, "");
        layout_ = rays::make_layout(scene_, view_, rays::testing::rays(resolution, samples));
        capture_ = std::make_unique<rays::Capture>(scene_, view_, layout_);
        source_ = std::make_unique<RaySource>(*capture_, layout_, std::size_t{1} << 30, RaySource::Watch{});
    }
    techniques::BuildInput input() const { return {layout_, view_, nullptr}; }

    scene::Scene scene_;
    rays::LightView view_;
    rays::MapLayout layout_;
    std::unique_ptr<rays::Capture> capture_;
    std::unique_ptr<RaySource> source_;
};

std::vector<Contender> every_technique() {
    std::vector<Contender> contenders;
    for (const techniques::Technique& row : techniques::all()) {
        if (row.traits.traces) continue;
        contenders.push_back(make_contender({row.id, "{}", ""}, ""));
        contenders.push_back(make_contender({row.id, "{}", ""}, ""));  // the second finds what the first has used
    }
    contenders.push_back(make_contender({"avsm", R"({"nodes": 4, "order": "shuffled"})", ""}, ""));
    contenders.push_back(make_contender({"avsm", R"({"cells": "sample"})", ""}, ""));
    return contenders;
}

// Every map of every contender must have the bytes, nodes and functions of one that was built by itself, without
// anything shared.
void expect_as_alone(std::span<const Contender> contenders, const RaySource& source,
                     const techniques::BuildInput& input) {
    curves::Curve shared, alone;
    for (const Contender& contender : contenders) {
        ASSERT_TRUE(contender.ok()) << contender.row->id << contender.cell.reason;
        Maps maps = begin_maps(*contender.row, contender.values, input);
        source.for_each_batch(contender.needs.apron, [&](RaySource::Batch batch) {
            for (const rays::LightRays& tile : batch)
                for (std::size_t p = 0; p < maps.parts.size(); ++p)
                    maps.parts[p]->add(maps.parts.size() == 1 ? tile : rays::channel(tile, static_cast<int>(p)));
        });
        finish(maps);
        EXPECT_EQ(contender.cell.bytes, bytes(maps)) << contender.row->id;
        EXPECT_EQ(contender.cell.working_bytes, working_bytes(maps)) << contender.row->id;
        EXPECT_EQ(contender.cell.nodes.total, nodes(maps).total) << contender.row->id;
        for (int y = 0; y < input.layout.height; ++y)
            for (int x = 0; x < input.layout.width; ++x)
                for (int c = 0; c < input.layout.channels; ++c) {
                    stored(contender.maps, x, y, c, {}, shared);
                    stored(maps, x, y, c, {}, alone);
                    ASSERT_EQ(shared, alone) << contender.row->id << " at " << x << ", " << y << " channel " << c;
                }
    }
}

TEST_F(SharedTiles, make_every_map_as_if_it_grew_by_itself) {
    for (const bool coloured : {false, true}) {
        light(4, coloured);
        std::vector<Contender> contenders = every_technique();
        ask_for_needs(contenders, layout_);
        capture_ = std::make_unique<rays::Capture>(scene_, view_, layout_);
        source_ = std::make_unique<RaySource>(*capture_, layout_, std::size_t{1} << 30, RaySource::Watch{});
        build_all(contenders, *source_, input(), MemoryLimits{}.all, {});
        expect_as_alone(contenders, *source_, input());
    }
}

// Without sharing, each map would be given means of its own, or make them itself.
TEST_F(SharedTiles, hand_the_same_means_to_every_map) {
    light(4, false);
    std::vector<Contender> contenders;
    contenders.push_back(of_means());
    contenders.push_back(of_means());
    build_all(contenders, *source_, input(), MemoryLimits{}.all, {});
    ASSERT_EQ(MeansMap::given.size(), 2u);
    EXPECT_EQ(MeansMap::given[0], MeansMap::given[1]);
    EXPECT_EQ(MeansMap::added, 0);
}

// Without sharing, each map would composite the rays itself. Means are made of the same functions.
TEST_F(SharedTiles, hand_the_same_functions_to_every_map) {
    light(4, false);
    std::vector<Contender> contenders;
    contenders.push_back(of_functions());
    contenders.push_back(of_means());
    contenders.push_back(of_functions());
    build_all(contenders, *source_, input(), MemoryLimits{}.all, {});
    ASSERT_EQ(FunctionsMap::handed.size(), 2u);
    EXPECT_EQ(FunctionsMap::handed[0], FunctionsMap::handed[1]);
    EXPECT_EQ(MeansMap::given.size(), 1u);
    EXPECT_EQ(MeansMap::added, 0);
}

// They are what composite() makes, for every ray of a pixel that touches a medium, and nothing for other pixels.
TEST_F(SharedTiles, have_the_functions_of_rays_in_media) {
    light(4, false);
    const rays::LightRays tile = capture_->tile(0);
    const curves::RayFunctions functions(tile);
    curves::OpenMedia open;
    std::vector<curves::Node> alone;
    std::size_t made = 0, left_out = 0;
    for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
        curves::composite(tile, ray, 0, open, alone);
        const std::size_t first = ray / 4 * 4;
        bool media = false;
        for (std::size_t s = tile.begin[first]; s < tile.begin[first + 4]; ++s)
            media = media || tile.z_back[s] > tile.z_front[s];
        const std::span<const curves::Node> shared = functions.of(ray);
        if (!media) {
            EXPECT_TRUE(shared.empty());
            left_out += !alone.empty();
            continue;
        }
        made += !alone.empty();
        EXPECT_TRUE(std::ranges::equal(shared, alone, [](const curves::Node& a, const curves::Node& b) {
            return a.z == b.z && a.value == b.value;
        })) << ray;
    }
    EXPECT_GT(made, 100u);
    EXPECT_GT(left_out, 10u);
}

// Those of a tile of surfaces are not worth their memory, and those of a tile with very many segments would not fit.
TEST_F(SharedTiles, make_no_functions_of_surfaces_or_of_very_large_tiles) {
    light(4, false);
    const Maps maps = begin_maps(*of_functions().row, {}, input());
    rays::LightRays tile = capture_->tile(0);
    EXPECT_TRUE(reads_functions(maps, tile));
    tile.z_front.resize((std::size_t{1} << 19) + 1);
    EXPECT_FALSE(reads_functions(maps, tile));
    tile.z_front.resize(1);
    tile.z_back.clear();
    EXPECT_FALSE(reads_functions(maps, tile));
}

// One ray is not its own mean to the bit.
TEST_F(SharedTiles, make_no_means_of_one_ray_a_pixel) {
    light(1, false);
    std::vector<Contender> contenders;
    contenders.push_back(of_means());
    build_all(contenders, *source_, input(), MemoryLimits{}.all, {});
    EXPECT_EQ(MeansMap::added, 1);
    EXPECT_TRUE(MeansMap::given.empty());
}

// Their own parts take next to nothing. If only the first were charged, the second would seem to build for free.
TEST_F(SharedTiles, charge_the_means_to_every_build_that_reads_them) {
    light(16, true);
    for (const std::size_t kept : {std::size_t{1} << 30, std::size_t{0}}) {
        const RaySource source(*capture_, layout_, kept, {});
        std::vector<Contender> contenders;
        contenders.push_back(of_means());
        contenders.push_back(make_contender({"shadow_map", "{}", ""}, ""));
        contenders.push_back(of_means());
        std::vector<std::vector<double>> seconds(contenders.size());
        results::TimedPasses passes;
        MeansMap::given.clear();
        for (int build = 0; build < 4; ++build) time_builds(contenders, source, input(), seconds, passes);
        for (const std::vector<double>& of_one : seconds) ASSERT_EQ(of_one.size(), 4u);
        EXPECT_EQ(passes.passes, 12u);
        ASSERT_EQ(MeansMap::given.size(), 24u);
        // Of several builds one is not interrupted.
        const double first = *std::min_element(seconds[0].begin(), seconds[0].end());
        const double last = *std::min_element(seconds[2].begin(), seconds[2].end());
        EXPECT_GT(last, 0.5 * first);
        EXPECT_GT(first, 0.5 * last);
    }
}

// As with means.
TEST_F(SharedTiles, charge_the_functions_to_every_build_that_reads_them) {
    light(16, false);
    std::vector<Contender> contenders;
    contenders.push_back(of_functions());
    contenders.push_back(of_means());
    contenders.push_back(of_functions());
    std::vector<std::vector<double>> seconds(contenders.size());
    results::TimedPasses passes;
    time_builds(contenders, *source_, input(), seconds, passes);
    EXPECT_EQ(FunctionsMap::handed.size(), 2u);
    EXPECT_EQ(MeansMap::given.size(), 1u);
    for (const std::vector<double>& of_one : seconds) ASSERT_EQ(of_one.size(), 1u);
    EXPECT_GT(seconds[2][0], 0.5 * seconds[0][0]);
    EXPECT_GT(seconds[0][0], 0.5 * seconds[2][0]);
}

// Maps that grow together exist a second time, all of them. Near the memory limit they must not.
TEST_F(SharedTiles, grow_together_only_where_there_is_room) {
    light(4, false);
    for (const std::size_t kept : {std::size_t{1} << 30, std::size_t{0}}) {
        const RaySource source(*capture_, layout_, kept, {});
        const auto most_at_a_time = [&](std::size_t room) {
            std::vector<Contender> contenders;
            for (int i = 0; i < 5; ++i) {
                contenders.push_back(of_means());
                contenders.back().cell.working_bytes = 100;
            }
            std::vector<std::vector<double>> seconds(contenders.size());
            results::TimedPasses passes;
            MeansMap::most = 0;
            time_builds(contenders, source, input(), seconds, passes, room);
            for (const std::vector<double>& of_one : seconds) EXPECT_EQ(of_one.size(), 1u);
            return MeansMap::most;
        };
        EXPECT_EQ(most_at_a_time(500), 5);
        EXPECT_EQ(most_at_a_time(499), 4);
        EXPECT_EQ(most_at_a_time(200), 2);
        EXPECT_EQ(most_at_a_time(0), 1);
    }
}

// Kept rays take room that the second map of a timed build needs.
TEST_F(SharedTiles, drop_kept_rays_that_leave_no_room) {
    light(4, false);
    std::vector<Contender> contenders(1);
    contenders[0].cell.bytes = 1000;
    contenders[0].cell.working_bytes = 1500;
    const std::size_t kept = source_->kept_bytes();
    ASSERT_GT(kept, 0u);
    make_room(contenders, *source_, {.all = kept + 2500});
    EXPECT_TRUE(source_->kept());
    EXPECT_EQ(room_beside(contenders, *source_, {.all = kept + 2500}), 1500u);
    EXPECT_EQ(room_beside(contenders, *source_, {.all = kept + 2500, .held = 300}), 1200u);
    make_room(contenders, *source_, {.all = kept + 2499});
    EXPECT_FALSE(source_->kept());
    EXPECT_EQ(source_->kept_bytes(), 0u);
    std::size_t tiles = 0;
    source_->for_each_batch(0, [&](RaySource::Batch batch) { tiles += batch.size(); });
    EXPECT_EQ(tiles, static_cast<std::size_t>(layout_.tiles()));
    EXPECT_FALSE(source_->kept());  // the pass must not keep them again
    EXPECT_EQ(room_beside(contenders, *source_, {.all = 999}), 0u);
}

// All maps, the largest of them once more, and what the process holds take from what rays may be kept.
TEST_F(SharedTiles, keep_only_rays_beside_which_the_maps_fit) {
    light(4, false);
    const auto kept = [&](std::size_t all, std::size_t held, const std::vector<std::size_t>& maps) {
        std::vector<techniques::Technique> rows(maps.size());
        std::vector<Contender> contenders(maps.size());
        for (std::size_t i = 0; i < maps.size(); ++i) {
            rows[i].least_bytes = [bytes = maps[i]](const auto&, const auto&) { return bytes; };
            contenders[i].row = &rows[i];
        }
        return limits_beside(held, layout_, contenders, {.all = all, .kept_rays = 1 << 30}).kept_rays;
    };
    constexpr std::size_t all = 1 << 28;
    const std::size_t alone = kept(all, 0, {});
    ASSERT_GT(alone, 10000u);
    ASSERT_LT(alone, all);
    EXPECT_EQ(kept(all, 700, {}), alone - 700);
    EXPECT_EQ(kept(all, 0, {3000}), alone - 2 * 3000);
    EXPECT_EQ(kept(all, 700, {1000, 3000}), alone - 2 * 3000 - 1000 - 700);
    EXPECT_EQ(kept(100, 0, {}), 0u);
    EXPECT_EQ(kept(std::size_t{1} << 40, 0, {3000}), std::size_t{1} << 30);
    EXPECT_GT(resident_bytes(), std::size_t{1} << 20);
}

}  // namespace
}  // namespace shadowbench::bench

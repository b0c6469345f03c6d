// A deep shadow map written to a file and read through a cache gives the same bits as the map in memory.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>

#include "techniques/any_rays.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/deep_parameters.h"
#include "techniques/deep/tile_cache.h"
#include "techniques/deep_levels.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

bool same_bits(std::span<const float> a, std::span<const float> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Published compression may leave [0, 1], which the file states.
bool leaves_the_unit_range(std::span<const DeepLevel> levels) {
    for (const DeepLevel& level : levels)
        for (std::size_t p = 0; p + 1 < level.offsets.size(); ++p)
            for (std::size_t i = level.offsets[p] + level.nodes(p); i < level.offsets[p + 1]; ++i)
                if (level.floats[i] < 0.0f || level.floats[i] > 1.0f) return true;
    return false;
}

template <std::size_t count>
std::string any_of(const char* const (&words)[count]) {
    return words[*rc::gen::inRange<std::size_t>(0, count)];
}

// Any way to build the map and to look it up, in memory.
ParameterValues any_values(const Technique& row) {
    ParameterValues values = testing::defaults(row);
    values.values["tolerance"] = *rc::gen::element(0.01, 0.0, 1e-3, 0.25, 1.0);
    values.values["compression"] = any_of({"bounded", "published"});
    values.values["mip"] = any_of({"none", "nearest", "blend"});
    values.values["mip_from"] = any_of({"compressed", "samples"});
    values.values["kernel"] = any_of({"box", "tent", "pixels"});
    values.values["search"] = any_of({"binary", "linear", "cached"});
    values.values["probes"] = *rc::gen::element(0.0, 1.0, 3.0, 8.0);
    return values;
}

struct Questions {
    std::vector<Query> queries;
    std::vector<Footprint> footprints;  // a fifth of them not known

    std::vector<float> answers(const Map& map) const {
        std::vector<float> out(queries.size() * static_cast<std::size_t>(map.channels()));
        map.lookup_shaped(queries, footprints, out);
        return out;
    }
};

// Depths at which the map's functions change, anywhere in the map and a little outside, up to wider than the map.
Questions any_questions(const testing::HandRays& given) {
    Questions asked;
    base::Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000)));
    for (const float z : testing::telling_depths(given)) {
        asked.queries.push_back({static_cast<float>(random.uniform(-0.2, given.width)),
                                 static_cast<float>(random.uniform(-0.2, given.height)), z,
                                 static_cast<float>(random.uniform(0, 9))});
        const auto edge = [&] { return static_cast<float>(random.uniform(-4, 4)); };
        const bool known = random.below(5) != 0;
        asked.footprints.push_back(known ? Footprint{edge(), edge(), edge(), edge()} : Footprint{});
    }
    return asked;
}

RC_GTEST_PROP(DeepFileLookup, AnswersAsTheMapInMemory, ()) {
    const Technique& row = find("deep", "");
    testing::HandRays given = *testing::any_rays();
    given.coloured = *rc::gen::arbitrary<bool>();
    const ParameterValues values = any_values(row);
    const testing::HandMap built = make_map(row, values, given);

    const testing::TestFile path;
    write_deep_file(path.path, levels(*built.map), *rc::gen::inRange(1, 5), {});
    const DeepFile file(path.path);
    RC_ASSERT(file.unit_range() == !leaves_the_unit_range(levels(*built.map)));
    TileCache cache(file, static_cast<std::size_t>(*rc::gen::inRange(1, 4)));
    const Questions asked = any_questions(given);
    std::vector<float> answers(asked.queries.size() * static_cast<std::size_t>(built.map->channels()));
    lookup(cache, deep_parameters::rule_of(values), asked.queries, asked.footprints, answers);
    RC_ASSERT(same_bits(answers, asked.answers(*built.map)));

    const std::vector<DeepLevel> read = read_levels(file);
    RC_ASSERT(read.size() == levels(*built.map).size());
    for (std::size_t l = 0; l < read.size(); ++l) {
        RC_ASSERT(read[l].offsets == levels(*built.map)[l].offsets);
        RC_ASSERT(read[l].coloured == levels(*built.map)[l].coloured);
        RC_ASSERT(same_bits(read[l].floats, levels(*built.map)[l].floats));
    }
}

RC_GTEST_PROP(DeepFileLookup, AMapInTilesIsTheMapInMemory, ()) {
    const Technique& row = find("deep", "");
    testing::HandRays given = *testing::any_rays();
    given.coloured = *rc::gen::arbitrary<bool>();
    ParameterValues values = any_values(row);
    const testing::HandMap memory = make_map(row, values, given);
    values.values["storage"] = std::string("tiled");
    values.values["slots"] = static_cast<double>(*rc::gen::inRange(1, 5));
    const testing::HandMap tiled = make_map(row, values, given);

    const Questions asked = any_questions(given);
    RC_ASSERT(same_bits(asked.answers(*tiled.map), asked.answers(*memory.map)));
    RC_ASSERT(same_bits(tiled.lookup(asked.queries), memory.lookup(asked.queries)));
    RC_ASSERT(tiled.map->nodes().histogram == memory.map->nodes().histogram);
    RC_ASSERT(tiled.map->nodes().total == memory.map->nodes().total);
    curves::Curve one, other;
    for (int y = 0; y < given.height; ++y)
        for (int x = 0; x < given.width; ++x)
            for (int c = 0; c < memory.map->channels(); ++c) {
                tiled.map->stored(x, y, c, {}, one);
                memory.map->stored(x, y, c, {}, other);
                RC_ASSERT(one == other);
            }
    const TileCounts counts = tiles(*tiled.map).value();
    RC_ASSERT(counts.held_bytes <= tiled.map->bytes());
    RC_ASSERT(counts.slots <= counts.tiles);
    RC_ASSERT(!tiles(*memory.map));
}

}  // namespace
}  // namespace shadowbench::techniques

// A deep shadow map written to a file and read through a cache gives the same bits as the map in memory.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "techniques/any_rays.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/tile_cache.h"
#include "techniques/deep_levels.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

bool same_bits(std::span<const float> a, std::span<const float> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Published compression may leave [0, 1], which the file cannot hold.
bool leaves_the_unit_range(std::span<const DeepLevel> levels) {
    for (const DeepLevel& level : levels)
        for (std::size_t p = 0; p + 1 < level.offsets.size(); ++p)
            for (std::size_t i = level.offsets[p] + level.nodes(p); i < level.offsets[p + 1]; ++i)
                if (level.floats[i] < 0.0f || level.floats[i] > 1.0f) return true;
    return false;
}

RC_GTEST_PROP(DeepFileLookup, AnswersAsTheMapInMemory, ()) {
    const Technique& row = find("deep", "");
    testing::HandRays given = *testing::any_rays();
    given.coloured = *rc::gen::arbitrary<bool>();
    ParameterValues values = testing::defaults(row);
    values.values["tolerance"] = *rc::gen::element(0.01, 0.0, 1e-3, 0.25, 1.0);
    values.values["compression"] = std::string(*rc::gen::element("bounded", "published"));
    const bool mip = *rc::gen::arbitrary<bool>();
    if (mip) values.values["mip"] = std::string("nearest");
    const testing::HandMap built = make_map(row, values, given);

    const testing::TestFile path;
    const int tile = *rc::gen::inRange(1, 5);
    if (leaves_the_unit_range(levels(*built.map))) {
        RC_ASSERT_THROWS_AS(write_deep_file(path.path, levels(*built.map), tile, {}), base::Error);
        RC_ASSERT(!std::filesystem::exists(path.path));
        return;
    }
    write_deep_file(path.path, levels(*built.map), tile, {});
    const DeepFile file(path.path);
    TileCache cache(file, static_cast<std::size_t>(*rc::gen::inRange(1, 4)));
    std::vector<Query> queries;
    base::Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000)));
    for (const float z : testing::telling_depths(given))
        queries.push_back({static_cast<float>(random.uniform(-0.2, given.width)),
                           static_cast<float>(random.uniform(-0.2, given.height)), z,
                           static_cast<float>(random.uniform(0, mip ? 1.5 : 5))});  // so wide that lookups read level 0
    std::vector<float> answers(queries.size() * static_cast<std::size_t>(built.map->channels()));
    lookup(cache, 0, queries, answers);
    RC_ASSERT(same_bits(answers, built.lookup(queries)));

    const std::vector<DeepLevel> read = read_levels(file);
    RC_ASSERT(read.size() == levels(*built.map).size());
    for (std::size_t l = 0; l < read.size(); ++l) {
        RC_ASSERT(read[l].offsets == levels(*built.map)[l].offsets);
        RC_ASSERT(read[l].coloured == levels(*built.map)[l].coloured);
        RC_ASSERT(same_bits(read[l].floats, levels(*built.map)[l].floats));
    }
}

}  // namespace
}  // namespace shadowbench::techniques

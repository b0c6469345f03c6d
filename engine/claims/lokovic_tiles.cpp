// Lokovic and Veach, Deep Shadow Maps, 2000: section 5.4.
#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/seeded_light.h"
#include "techniques/deep/deep.h"

namespace shadowbench::claims::lokovic {
namespace {

using techniques::TileCounts;

constexpr int all_slots[] = {4, 16, 64, 1024};  // the last: one for every tile
constexpr std::size_t few = 1;                  // the place of the claim's number of slots in that list

// The picture decides which tiles are used, and not the rays: so each seed of the rays has a view of its own.
constexpr const char* views[] = {"receivers.position=[-1.5,4.6,8.2]", "receivers.position=[-3.4,4.1,7.4]",
                                 "receivers.position=[0.6,5.2,8.0]"};
static_assert(std::size(views) == ray_seeds);

const std::vector<std::string> smaller{"rays.resolution=128"};

std::vector<std::string> settings(int seed) {
    return {"rays.samples_per_pixel=64", views[seed]};
}

std::string maps() {
    std::string list = R"({"type":"deep"})";
    for (const int slots : all_slots) list += fmt::format(R"(,{{"type":"deep","storage":"tiled","slots":{}}})", slots);
    return set_techniques(list);
}

std::vector<std::string> with_maps(int seed) {
    std::vector<std::string> all = settings(seed);
    all.push_back(maps());
    return all;
}

// Magnified, as figure 6b: the picture shows a part of the shadow.
std::vector<std::string> magnified(int seed) {
    std::vector<std::string> all = settings(seed);
    all.insert(all.end(),
               {"receivers.fov=8", "receivers.target=[-1.3,0,-0.5]",
                set_techniques(fmt::format(R"({{"type":"deep"}},{{"type":"deep","storage":"tiled","slots":{}}})",
                                           all_slots[std::size(all_slots) - 1]))});
    return all;
}

// The lookups of one picture through one map in tiles, for every seed.
struct Caching {
    std::vector<double> image_hits, random_hits;  // share of the functions whose tile was held
    std::vector<double> loaded;                   // tiles loaded in image order
    std::vector<double> held, file, tiles;        // bytes held after both orders, bytes of the file, its tiles
};

struct Counted {
    std::vector<Caching> caching;  // one for each number of slots
    std::vector<double> memory;    // bytes of the map in memory, for every seed
    bool bounded = true;           // no map held more than all its slots at the largest tile
    Turns ns;                      // a lookup: in memory, then for each number of slots; in image order, then in random
};
constexpr std::size_t maps_in_all = 1 + std::size(all_slots);

// `most` of `count` indices.
std::vector<std::size_t> in_random_order(std::size_t count, std::size_t most) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    base::Random random(1);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    order.resize(std::min(count, most));
    return order;
}

// On this thread, in this order; the answers are those of the map in memory to the bit.
TileCounts look_up(const bench::Maps& tiled, const bench::Maps& memory, std::span<const techniques::Query> queries) {
    std::vector<float> expected(queries.size()), answers(queries.size());
    bench::lookup(memory, queries, expected);
    bench::lookup(tiled, queries, answers);
    if (answers != expected)
        throw base::Error(base::ErrorCode::internal, "deep storage=tiled", "its answers differ from those in memory");
    return techniques::tiles(*tiled.parts.front()).value();
}

double hit_share(const TileCounts& after, const TileCounts& before) {
    const auto hits = static_cast<double>(after.hits - before.hits);
    return hits / (hits + static_cast<double>(after.misses - before.misses));
}

// Of neighbouring rows of the picture, and of receivers all over it in random order.
void time_lookups(const std::vector<bench::Maps>& built, const bench::QuerySet& image, Counted& counted) {
    const std::size_t all = image.queries.size(), rows = std::min<std::size_t>(all, 16384);
    std::vector<std::size_t> order(rows);
    std::iota(order.begin(), order.end(), (all - rows) / 2);
    const bench::QuerySet ordered = bench::pick(image.asked(), order);
    const bench::QuerySet shuffled = bench::pick(image.asked(), in_random_order(all, 2048));
    std::vector<TimedLookups> timed;
    for (const bench::QuerySet* set : {&ordered, &shuffled})
        for (const bench::Maps& map : built) timed.push_back({&map, set->queries});
    const Compared compared[] = {{few + 1, 0}};
    counted.ns = lookup_turns(timed, compared);
}

Counted count_tiles(const Context& context) {
    Counted counted;
    counted.caching.resize(std::size(all_slots));
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const SeededLight light(context, ball_scene, with_maps(seed), smaller);
        const bench::QuerySet image = light.queries();
        const bench::QuerySet shuffled = bench::pick(image.asked(), in_random_order(image.queries.size(), 16384));
        const std::vector<bench::Maps> built = light.build(seed);
        counted.memory.push_back(static_cast<double>(bench::bytes(built[0])));
        for (std::size_t i = 0; i < std::size(all_slots); ++i) {
            const TileCounts first = look_up(built[i + 1], built[0], image.queries);
            const TileCounts both = look_up(built[i + 1], built[0], shuffled.queries);
            counted.bounded = counted.bounded && both.held_bytes <= bench::bytes(built[i + 1]);
            Caching& caching = counted.caching[i];
            caching.image_hits.push_back(hit_share(first, {}));
            caching.random_hits.push_back(hit_share(both, first));
            caching.loaded.push_back(static_cast<double>(first.misses));
            caching.held.push_back(static_cast<double>(both.held_bytes));
            caching.file.push_back(static_cast<double>(both.file_bytes));
            caching.tiles.push_back(static_cast<double>(both.tiles));
        }
        if (seed == 0) time_lookups(built, image, counted);
    }
    return counted;
}

// The tiles that the lookups of the magnified picture load, for every seed.
std::vector<double> tiles_of_detail(const Context& context) {
    std::vector<double> loaded;
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const SeededLight light(context, ball_scene, magnified(seed), smaller);
        const bench::QuerySet image = light.queries();
        const std::vector<bench::Maps> built = light.build(seed);
        loaded.push_back(static_cast<double>(look_up(built[1], built[0], image.queries).misses));
    }
    return loaded;
}

std::string percent(const std::vector<double>& shares) {
    return to_text(100.0 * mean_of(shares)) + " %";
}

Table tile_table(const Counted& counted) {
    const std::string file = bytes_text(mean_of(counted.caching.front().file).value);
    const std::string memory = bytes_text(mean_of(counted.memory).value);
    Table table{
        fmt::format("Section 5.4: lookups through tiles of 16 x 16 pixels of a file of {}; the map in memory has "
                    "{}. Hits are pixels read whose tile was held; means over three views, each with its own seed of "
                    "the light rays, times in the first",
                    file, memory),
        {"slots", "ns a lookup, image order", "random order", "hits, image order", "random order", "bytes held"},
        {}};
    const auto ns = [&](std::size_t map) { return to_text(counted.ns.time(map)); };
    table.rows.push_back({"in memory", ns(0), ns(maps_in_all), "-", "-", memory});
    for (std::size_t i = 0; i < std::size(all_slots); ++i) {
        const Caching& caching = counted.caching[i];
        const bool all = all_slots[i] >= caching.tiles.front();
        table.rows.push_back({all ? "all" : std::to_string(all_slots[i]), ns(i + 1), ns(maps_in_all + i + 1),
                              percent(caching.image_hits), percent(caching.random_hits),
                              bytes_text(mean_of(caching.held).value)});
        if (all) break;
    }
    return table;
}

}  // namespace

void tiles(const Context& context) {
    PaperReport& report = *context.report;
    const base::ThreadLimit threads(context.threads);
    const Counted counted = count_tiles(context);
    report.tables.push_back(tile_table(counted));

    const Caching& all = counted.caching.back();
    const Value of_scene = mean_of(all.loaded), of_detail = mean_of(tiles_of_detail(context));
    const Value in_file = exactly(all.tiles.front());  // as many in each file
    report.claims.push_back(
        {"section 5.4",
         "the tiled format lets us load and cache only the tiles that are actually accessed",
         fmt::format("the picture of the scene loads {} of {} tiles, a magnified one of the shadow {}",
                     to_text(of_scene), to_text(in_file), to_text(of_detail)),
         by_construction(of_scene.value <= in_file.value && of_detail.value < of_scene.value),
         "Means over three views of each kind. A tile is loaded when it is accessed first, and with a slot for every "
         "tile only then. The file lies in the system's page cache: a disk would add its own time to each tile that is "
         "loaded.",
         {of_scene, in_file, of_detail}});
    const Caching& fixed = counted.caching[few];
    const Value held = mean_of(fixed.held), memory = mean_of(counted.memory), hits = 100.0 * mean_of(fixed.image_hits);
    const Value slower = counted.ns.ratio(few + 1, 0);
    report.claims.push_back(
        {"section 5.4",
         "caching needs a fixed number of tile slots, each of which grows to the largest tile that it has seen",
         fmt::format(
             "{} slots hold {} times the bytes of the map in memory; {} % of the pixels read in image order find "
             "their tile, and lookups take {} times as long",
             all_slots[few], to_text(held / memory), to_text(hits), to_text(slower)),
         by_construction(counted.bounded),
         "Bytes held are those of slots, directory and tables; the answers are those of the map in memory to the bit.",
         {held / memory, hits, slower}});
}

}  // namespace shadowbench::claims::lokovic

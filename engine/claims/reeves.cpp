// Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987: table 2, and the order of the other
// parts.
#include "claims/reeves.h"

#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/intervals.h"
#include "claims/seen.h"
#include "claims/sheet.h"

namespace shadowbench::claims {
namespace reeves {

std::vector<std::string> moved(const Context& context, const char* scenario, std::uint64_t place,
                               std::vector<std::string> set) {
    const nlohmann::json document = context.document(scenario, set);
    const nlohmann::json& lights_there = document.at("lights");
    for (std::size_t light = 0; light < lights_there.size(); ++light) {
        nlohmann::json alone = document;
        alone["lights"] = nlohmann::json::array({lights_there.at(light)});
        const nlohmann::json at_place = with_moved_map(alone, light == 0 ? place : base::hash(place, light));
        set.push_back(fmt::format("/lights/{}/target={}", light, at_place.at("lights").at(0).at("target").dump()));
    }
    return set;
}

namespace {

using results::LightResult;

double stored_bytes(const results::Result& result, const char* way) {
    double sum = 0.0;
    for (const LightResult& light : result.variants.front().lights)
        sum += static_cast<double>(cell_of(light, "shadow_map", {fmt::format("storage={}", way)}).bytes);
    return sum;
}

// The paper's megabytes: raw depth maps of 32 bits, whose size follows from their resolutions, and what the schemes
// make of them, which it prints with one decimal.
struct Storage {
    double raw, box, tiles;
};

// The share of the raw maps, with the interval of what is rounded to the printed megabytes.
Value share_of_raw(double printed, double raw) {
    return {printed / raw, (printed - 0.05) / raw, (printed + 0.05) / raw};
}

// The shares of the raw maps.
struct Shares {
    double raw_bytes = 0.0;
    Value box, tiles;
};

Shares measure_storage(const Context& context, const char* name) {
    Shares shares;
    std::vector<double> box, tiles;
    for (std::uint64_t place = 0; place < map_places; ++place) {
        const results::Result result =
            context.run(name,
                        moved(context, name, place,
                              {R"(techniques=[{"type":"shadow_map","storage":"raw"},{"type":"shadow_map","storage":)"
                               R"("bounding_box"},{"type":"shadow_map","storage":"tiles"}])",
                               "reference.queries=64"}),
                        {});
        shares.raw_bytes = stored_bytes(result, "raw");  // the same at all places
        box.push_back(stored_bytes(result, "bounding_box") / shares.raw_bytes);
        tiles.push_back(stored_bytes(result, "tiles") / shares.raw_bytes);
    }
    shares.box = mean_of(box);
    shares.tiles = mean_of(tiles);
    return shares;
}

constexpr const char* of_rebuilt =
    "It depends on how much of the map the casters cover, which was estimated from the figures. The paper prints one "
    "decimal, so all values that round to it count as its own.";
constexpr const char* of_stand_in =
    "The bicycle store is not public. A room full of things stands in for it, and does not have its numbers.";

// `rebuilt`: the scene is rebuilt from the paper's figures, and no stand-in for one that is not public.
Shares add_storage(const Context& context, const char* name, const char* title, bool rebuilt, const Storage& theirs,
                   Table& table) {
    const Shares ours = measure_storage(context, name);
    const auto printed = [&](double megabytes) { return fmt::format("{:.1f} of {:.1f} MB", megabytes, theirs.raw); };
    table.rows.push_back({title, fmt::format("{:.3g}", ours.raw_bytes / 1048576.0), to_text(ours.box),
                          printed(theirs.box), to_text(ours.tiles), printed(theirs.tiles)});
    for (const auto& [scheme, paper, measured] :
         {std::tuple{"bounding box", theirs.box, ours.box}, {"tile", theirs.tiles, ours.tiles}})
        context.report->claims.push_back(
            {"section 5, table 2",
             fmt::format("{}: the {} scheme takes {} of raw depth maps", title, scheme, printed(paper)),
             fmt::format("{} of them", to_text(measured)),
             rebuilt ? judge_size(share_of_raw(paper, theirs.raw), 1.0, measured) : not_comparable(),
             rebuilt ? of_rebuilt : of_stand_in,
             {measured}});
    return ours;
}

std::string both_shares(const Shares& shares) {
    return fmt::format("tiles take {} of the raw maps, the bounding box {}", to_text(shares.tiles),
                       to_text(shares.box));
}

}  // namespace

void storage(const Context& context) {
    Table table{"Table 2: depth map storage, as a share of the raw maps; means over three places of the maps' cells",
                {"image", "raw MiB", "bounding box", "theirs", "tiles", "theirs"},
                {}};
    PaperReport& report = *context.report;
    add_storage(context, sphere, "Sphere and plane", true, {4.0, 0.4, 0.4}, table);
    add_storage(context, lights, "Coloured lights", true, {12.0, 2.6, 2.9}, table);
    report.claims.push_back(
        {"section 5, table 2",
         "Luxo Jr.: the bounding box scheme takes 13.0 of 24.0 MB of raw depth maps, the tile scheme 3.7",
         "not measured",
         not_comparable(),
         "The film's scene is not public, and nothing here stands in for it.",
         {}});
    const Shares of_store =
        add_storage(context, store, "Bike store (a room full of things)", false, {8.0, 5.6, 4.2}, table);
    report.claims.push_back(
        {"section 5",
         "where objects that cast shadows are everywhere, tiles may save more than the bounding box",
         both_shares(of_store),
         judge_less(of_store.tiles, of_store.box),
         "In a room full of things: the claim is about any such image, and not about one that is not public.",
         {of_store.tiles, of_store.box}});
    report.tables.push_back(std::move(table));
}

}  // namespace reeves

void measure_reeves(const Context& context) {
    using namespace reeves;
    context.report->conditions =
        "The sphere and plane and the three coloured lights are rebuilt from the figures, the bicycle store is "
        "replaced by a room full of things; Luxo Jr. and Red's Dream are not public. In table 1 images are 384 pixels "
        "wide where theirs have 1024, with 16 view rays a pixel, as theirs. Each ray is a region of its own: it is "
        "shaded once, and for each light it is mapped into light space and filtered with ResFactor 3, MinSize 2, "
        "MinSamples 2, 16 samples and the biases 0.3 and 0.4. Depth maps have as many pixels across as the images, as "
        "is usual in the paper. Times are of one thread. The light rays are regular. Figures 6 and 7 are of the sphere "
        "and plane, over regions 8 cells wide, with MinSize 0 and MinSamples 1, so that one sample is possible; figure "
        "10 is with MinSize 2 and MinSamples 2. Figures 3, 4 and 8 are of the straight edge of an opaque half-plane "
        "along the cells, with MinSize 0 and MinSamples 2, since their noise and widths are read across an edge. Figure "
        "4 and the softness of figure 8 take 64 samples, in regions ResFactor cells wide; the quantization of figure 8 "
        "has regions four times as wide, and figure 3 has regions 8 cells wide. "
        "Figure 9 is of the sphere and plane in a picture of 1024 x 768 pixels: the region is the pixel, mapped into "
        "the map, with 16 samples, ResFactor 3, MinSize 2 and MinSamples 2. Section 1 is of the same scene, without a "
        "bias; what is filtered there is a region 8 cells wide, with 16 samples, ResFactor 1, MinSize 2 and MinSamples "
        "2. "
        "Intervals are over three places of the map's cells against the scene in section 1, table 2, figures 6, 7 and "
        "10, over four in figure 9, and over eight places along the edge in figures 3, 4 and 8.";
    times(context);
    storage(context);
    edges(context);
    half_plane(context);
    depths(context);
    bias(context);
    context.report->sheets.push_back(
        picture_sheet(context, sphere,
                      {R"(techniques=[{"type":"shadow_map"},{"type":"pcf","num_samples":4,"res_factor":1},)"
                       R"({"type":"pcf","res_factor":1},{"type":"pcf","num_samples":64,"res_factor":1}])"}));
}

}  // namespace shadowbench::claims

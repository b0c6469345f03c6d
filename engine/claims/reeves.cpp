// Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987: table 2, and the order of the other
// parts.
#include "claims/reeves.h"

#include <tuple>

#include <fmt/format.h>

#include "claims/sheet.h"

namespace shadowbench::claims {
namespace reeves {
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

// `rebuilt`: the scene is rebuilt from the paper's figures, and no stand-in for one that is not public.
void add_storage(const Context& context, const char* name, const char* title, bool rebuilt, const Storage& theirs,
                 Table& table) {
    const results::Result result = context.run(
        name,
        {R"(techniques=[{"type":"shadow_map","storage":"raw"},{"type":"shadow_map","storage":"bounding_box"},)"
         R"({"type":"shadow_map","storage":"tiles"}])",
         "reference.queries=64"},
        {});
    const double raw = stored_bytes(result, "raw"), box = stored_bytes(result, "bounding_box") / raw,
                 tiles = stored_bytes(result, "tiles") / raw;
    const auto printed = [&](double megabytes) { return fmt::format("{:.1f} of {:.1f} MB", megabytes, theirs.raw); };
    table.rows.push_back({title, fmt::format("{:.3g}", raw / 1048576.0), fmt::format("{:.3f}", box),
                          printed(theirs.box), fmt::format("{:.3f}", tiles), printed(theirs.tiles)});
    for (const auto& [scheme, paper, measured] :
         {std::tuple{"bounding box", theirs.box, box}, {"tile", theirs.tiles, tiles}})
        context.report->claims.push_back(
            {"section 5, table 2",
             fmt::format("{}: the {} scheme takes {} of raw depth maps", title, scheme, printed(paper)),
             fmt::format("{:.3f} of them", measured),
             rebuilt ? judge_size(share_of_raw(paper, theirs.raw), 1.0, exactly(measured)) : not_comparable(),
             "It depends on how much of the map the casters cover, which was estimated from the figures. The paper "
             "prints one decimal, so all values that round to it count as its own.",
             {exactly(measured)}});
    if (rebuilt) return;
    context.report->claims.push_back(
        {"section 5",
         "where objects that cast shadows are everywhere, tiles may save more than the bounding box",
         fmt::format("tiles take {:.3f} of the raw maps, the bounding box {:.3f}", tiles, box),
         judge_less(exactly(tiles), exactly(box)),
         "In a room full of things: the claim is about any such image, and not about one that is not public.",
         {exactly(tiles), exactly(box)}});
}

}  // namespace

void storage(const Context& context) {
    Table table{"Table 2: depth map storage, as a share of the raw maps",
                {"image", "raw MiB", "bounding box", "theirs", "tiles", "theirs"},
                {}};
    add_storage(context, sphere, "Sphere and plane", true, {4.0, 0.4, 0.4}, table);
    add_storage(context, lights, "Coloured lights", true, {12.0, 2.6, 2.9}, table);
    add_storage(context, store, "Bike store (a room full of things)", false, {8.0, 5.6, 4.2}, table);
    context.report->tables.push_back(std::move(table));
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
        "is usual in the paper. Times are of one thread. The light rays are regular. In figures 6, 7 and 10 intervals "
        "are over three places of the map's cells against the scene, in figure 9 over four, in figures 3, 4 and 8 over "
        "eight places along an edge.";
    times(context);
    storage(context);
    edges(context);
    bias(context);
    context.report->sheets.push_back(
        picture_sheet(context, sphere,
                      {R"(techniques=[{"type":"shadow_map"},{"type":"pcf","num_samples":4,"res_factor":1},)"
                       R"({"type":"pcf","res_factor":1},{"type":"pcf","num_samples":64,"res_factor":1}])"}));
}

}  // namespace shadowbench::claims

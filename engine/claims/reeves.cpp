// Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987: tables 1 and 2, figures 6 to 10.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/load.h"
#include "claims/hand_made.h"
#include "claims/paper.h"
#include "claims/sheet.h"
#include "document/document.h"
#include "rays/tracer.h"
#include "render/shading_points.h"

namespace shadowbench::claims {
namespace {

using results::Cell;
using results::LightResult;

// --- table 1 -------------------------------------------------------------------------------------------------------

// Seconds of each repetition on one thread: finding what the camera sees and shading it, without shadows.
Value shading_seconds(const Context& context, const std::string& name, std::size_t& points) {
    const auto variants = document::expand(context.document(name));
    bench::ScenarioLoader loader(context.data);
    const scene::Scenario& scenario = loader.load(variants.front());
    const rays::Tracer tracer(scenario.scene, false);
    const base::ThreadLimit one_thread(1);
    render::ViewSettings view;
    view.camera = *scenario.receivers.camera;
    view.size = scenario.receivers.resolution;
    view.rays_per_side = 4;
    std::vector<double> seconds;
    for (int repetition = 0; repetition < 5; ++repetition) {
        const bench::Stopwatch stopwatch;
        const render::ShadingPoints found =
            render::find_shading_points(scenario.scene, scenario.lights, view, tracer, {});
        render::Picture picture = render::start_picture(found);
        const std::vector<float> lit(found.points(), 1.0f);
        for (std::size_t light = 0; light < scenario.lights.size(); ++light)
            render::add_light(found, light, lit, picture);
        seconds.push_back(stopwatch.seconds());
        points = found.points();
    }
    return of(results::summarise(seconds));
}

// `rebuilt`: the scene is rebuilt from the paper's figures, and no stand-in for one that is not public.
void table_1(const Context& context, const char* name, const char* title, bool rebuilt, double paper,
             const results::Result& result, Table& table) {
    std::size_t points = 0;
    const Value without = shading_seconds(context, name, points);
    Value first = exactly(0.0), second = exactly(0.0);
    for (const LightResult& light : result.variants.front().lights) {
        const Cell& pcf = cell_of(light, "pcf", {"num_samples=16"});
        first = first + exactly(results::capture_seconds_on_one_thread(light)) + 1e-3 * of(pcf.times->build_ms);
        second = second + 1e-9 * static_cast<double>(points) * time_of(pcf);
    }
    const Value increase = 100.0 * ((first + second) / without);
    table.rows.push_back({title, to_text(1e3 * without), std::to_string(result.variants.front().lights.size()),
                          to_text(1e3 * first), to_text(1e3 * second), to_text(increase) + " %",
                          fmt::format("{:.1f} %", paper)});
    context.report->claims.push_back(
        {"section 5, table 1",
         fmt::format("{}: shadows add {:.1f} % to the time of the image", title, paper),
         to_text(increase) + " %",
         rebuilt ? judge_ratio(0.01 * paper, 0.01 * increase) : not_comparable(),
         "The shading that shadows are compared with is one dot product here.",
         {increase}});
}

// --- table 2 -------------------------------------------------------------------------------------------------------

double stored_bytes(const results::Result& result, const char* storage) {
    double sum = 0.0;
    for (const LightResult& light : result.variants.front().lights)
        sum += static_cast<double>(cell_of(light, "shadow_map", {fmt::format("storage={}", storage)}).bytes);
    return sum;
}

void table_2(const Context& context, const char* title, bool rebuilt, double box_paper, double tiles_paper,
             const results::Result& result, Table& table) {
    const double raw = stored_bytes(result, "raw"), box = stored_bytes(result, "bounding_box") / raw,
                 tiles = stored_bytes(result, "tiles") / raw;
    table.rows.push_back({title, fmt::format("{:.3g}", raw / 1048576.0), fmt::format("{:.2f}", box),
                          fmt::format("{:.2f}", box_paper), fmt::format("{:.2f}", tiles),
                          fmt::format("{:.2f}", tiles_paper)});
    for (const auto& [scheme, paper, measured] :
         {std::tuple{"bounding box", box_paper, box}, {"tile", tiles_paper, tiles}})
        context.report->claims.push_back(
            {"section 5, table 2",
             fmt::format("{}: the {} scheme takes {:.2f} of the raw depth maps", title, scheme, paper),
             fmt::format("{:.2f}", measured),
             rebuilt ? judge_size(paper, 1.0, exactly(measured)) : not_comparable(),
             "It depends on how much of the map the casters cover, which was estimated from the figures.",
             {exactly(measured)}});
}

// --- figures 6 to 10 ----------------------------------------------------------------------------------------------

void figures_6_and_7(const LightResult& light, PaperReport& report) {
    const auto pcf = [&](int samples) -> const Cell& {
        return cell_of(light, "pcf", {fmt::format("num_samples={}", samples)});
    };
    const Value hard = error_of(cell_of(light, "shadow_map")), four = error_of(pcf(4)), sixteen = error_of(pcf(16)),
                many = error_of(pcf(64));
    report.claims.push_back(
        {"section 4.1, figure 6",
         "percentage closer filtering antialiases the edges of the depth map",
         fmt::format("error rms {} against {} of point sampling", to_text(sixteen), to_text(hard)),
         judge_much_less(sixteen, hard),
         "Against the exact visibility over the same region.",
         {sixteen, hard}});
    const Value cost = time_of(pcf(64)) / time_of(pcf(4));
    report.claims.push_back(
        {"section 4.2, figure 7",
         "more samples make edges less noisy and cost more",
         fmt::format("error rms {}, {}, {} with 4, 16, 64 samples; 64 take {} times as long as 4", to_text(four),
                     to_text(sixteen), to_text(many), to_text(cost)),
         both(both(judge_less(sixteen, four), judge_less(many, sixteen)), judge_growth(cost)),
         "MinSamples asks for two samples along each side: 4 are the fewest.",
         {four, sixteen, many, cost}});
}

// Width in cells of the transition from 90 to 10 % lit, for lookups across the straight edge of an opaque half-plane.
double transition(double res_factor) {
    rays::LightRays tile;
    tile.width = tile.height = 128;
    tile.begin.push_back(0);
    for (int ray = 0; ray < 128 * 128; ++ray) {
        if (ray % 128 < 64) {
            tile.z_front.push_back(1.0f);
            tile.transmittance.push_back(0.0f);
        }
        tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
    }
    const nlohmann::json parameters = {{"res_factor", res_factor}, {"num_samples", 64}, {"min_size", 0}};
    std::vector<techniques::Query> queries;
    constexpr int rows = 64;
    for (int x = 0; x < 480; ++x)
        for (int y = 0; y < rows; ++y)
            queries.push_back({34.0f + 0.125f * static_cast<float>(x), 32.3f + static_cast<float>(y), 2.0f, 1.0f});
    const std::vector<float> visibility = look_up("pcf", parameters, tile, 3.0f, queries);
    int between = 0;
    for (int x = 0; x < 480; ++x) {
        double mean = 0.0;
        for (int y = 0; y < rows; ++y) mean += visibility[static_cast<std::size_t>(x * rows + y)];
        between += mean > 0.1 * rows && mean < 0.9 * rows;
    }
    return 0.125 * between;
}

void figure_8(PaperReport& report) {
    const double narrow = transition(1), middle = transition(3), wide = transition(8);
    report.claims.push_back(
        {"section 4.2, figure 8",
         "increasing ResFactor produces softer shadow edges",
         fmt::format("edges are {:.2f}, {:.2f}, {:.2f} cells wide (10 to 90 %) with ResFactor 1, 3, 8", narrow, middle,
                     wide),
         both(judge_growth(exactly(middle / narrow)), judge_growth(exactly(wide / middle))),
         "The width of the region is the width of the edge.",
         {exactly(narrow), exactly(middle), exactly(wide)}});
}

// Errors against the visibility of the point itself: the footprint is a hundredth of a cell, and the receiver bias only
// outweighs the part of it that remains.
void figure_9(const Context& context) {
    const auto pcf = [](const char* bias0, const char* bias1) {
        return fmt::format(R"({{"type":"pcf","num_samples":16,"res_factor":3,"region":1,"bias0":{},"bias1":{}}})",
                           bias0, bias1);
    };
    const results::Result result = context.run(
        "reeves1987_sphere",
        {"receivers.filter_width=0.01", "receivers.bias=0.02",
         fmt::format("techniques=[{},{},{},{}]", pcf("0", "0"), pcf("0.2", "0.3"), pcf("0.3", "0.4"), pcf("3", "4"))},
        {});
    const auto mean = [&](const char* bias0) {
        return cell_of(light_of(result), "pcf", {fmt::format("bias0={}", bias0)}).lookup->signed_mean;
    };
    const double none = mean("0"), some = mean("0.2"), more = mean("0.3"), most = mean("3");
    context.report->claims.push_back(
        {"section 4.2, figure 9",
         "bias removes false self-shadowing, and moves the boundary when it grows",
         fmt::format(
             "mean error {:+.4f}, {:+.4f}, {:+.4f} with bias 0, 0.2 to 0.3, 0.3 to 0.4, and {:+.4f} with 3 to 4", none,
             some, more, most),
         both(judge_much_less(exactly(std::abs(more)), exactly(std::abs(none))),
              both(judge_less(exactly(none), exactly(0.0)), judge_less(exactly(more), exactly(most)))),
         "In a world of 100 units, as in the paper; a mean below 0 is shadow where there should be none.",
         {exactly(none), exactly(some), exactly(more), exactly(most)}});
}

// The filter keeps its width in the world: four cells of the largest map.
void figure_10(const Context& context) {
    std::vector<Value> errors;
    for (const int resolution : {256, 512, 1024}) {
        const results::Result result = context.run("reeves1987_sphere",
                                                   {fmt::format("rays.resolution={}", resolution),
                                                    fmt::format("receivers.filter_width={}", 4.0 * resolution / 1024.0),
                                                    R"(techniques=[{"type":"pcf","num_samples":16,"res_factor":1}])"},
                                                   {});
        errors.push_back(error_of(cell_of(light_of(result), "pcf")));
    }
    context.report->claims.push_back(
        {"section 4.2, figure 10",
         "depth maps that are too small make shadows blurry and noisy",
         fmt::format("error rms {}, {}, {} at 256, 512, 1024", to_text(errors[0]), to_text(errors[1]),
                     to_text(errors[2])),
         both(judge_less(errors[1], errors[0]), judge_less(errors[2], errors[1])),
         "MinSize keeps the region at four cells, however large these are.",
         errors});
}

}  // namespace

void measure_reeves(const Context& context) {
    PaperReport& report = *context.report;
    report.conditions =
        "The sphere and plane and the three coloured lights are rebuilt from the figures, the bicycle store is "
        "replaced by a room full of things; Luxo Jr. and Red's Dream are not public. Images have 16 view rays a pixel, "
        "as theirs, "
        "each shaded and looked up separately; times are of one thread.";
    const results::Result sphere = context.run("reeves1987_sphere", {}, {});
    const results::Result colours = context.run("reeves1987_lights", {}, {});
    const results::Result store = context.run("reeves1987_store", {}, {});
    Table times{"Table 1: milliseconds",
                {"image", "without shadows", "lights", "first pass", "second pass", "increase", "theirs"},
                {}};
    table_1(context, "reeves1987_sphere", "Sphere and plane", true, 37.3, sphere, times);
    table_1(context, "reeves1987_lights", "Coloured lights", true, 47.6, colours, times);
    table_1(context, "reeves1987_store", "Red's Dream (a room full of things)", false, 48.4, store, times);
    report.tables.push_back(std::move(times));
    Table storage{"Table 2: depth map storage, as a share of the raw maps",
                  {"image", "raw MiB", "bounding box", "theirs", "tiles", "theirs"},
                  {}};
    table_2(context, "Sphere and plane", true, 0.4 / 4.0, 0.4 / 4.0, sphere, storage);
    table_2(context, "Coloured lights", true, 2.6 / 12.0, 2.9 / 12.0, colours, storage);
    table_2(context, "Bike store (a room full of things)", false, 5.6 / 8.0, 4.2 / 8.0, store, storage);
    report.tables.push_back(std::move(storage));
    figures_6_and_7(light_of(sphere), report);
    figure_8(report);
    figure_9(context);
    figure_10(context);
    report.sheets.push_back(
        picture_sheet(context, "reeves1987_sphere",
                      {R"(techniques=[{"type":"shadow_map"},{"type":"pcf","num_samples":4,"res_factor":1},)"
                       R"({"type":"pcf","res_factor":1},{"type":"pcf","num_samples":64,"res_factor":1}])"}));
}

}  // namespace shadowbench::claims

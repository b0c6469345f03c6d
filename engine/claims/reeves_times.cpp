// Reeves, Salesin, Cook 1987: table 1, and the parts of the time that shadows add (section 5).
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "claims/first_light.h"
#include "claims/intervals.h"
#include "claims/reeves.h"
#include "rays/capture.h"
#include "rays/tracer.h"
#include "render/point_queries.h"
#include "render/shading_points.h"

namespace shadowbench::claims::reeves {
namespace {

constexpr int repetitions = 12;  // intervals leave out the two fastest and the two slowest

// What the paper's second pass does for a region, with the values of its figure 4 and section 4.2; and a single sample
// of the same depth map.
constexpr const char* filter =
    R"(techniques=[{"type":"pcf","num_samples":16,"res_factor":3,"min_size":2,"min_samples":2,"bias0":0.3,"bias1":0.4,)"
    R"("region":"pixel"},{"type":"shadow_map","bias":0.35}])";

// Seconds of each repetition on one thread: finding and shading what the camera sees; the depth maps; mapping the
// regions into light space; filtering the depth maps over them. The second pass is all but the depth maps. `point`:
// sampling the depth maps at one point of each region instead.
struct Passes {
    std::vector<double> image, first, mapping, filtering, point;
    std::vector<std::vector<double>> added;  // [light]: by the shadows of this light and those before it
    std::size_t lights = 0;

    // The whole image over the one with point-sampled shadows; filtering alone over point sampling.
    Value over_point_sampled() const {
        std::vector<double> filtered, sampled;
        for (std::size_t r = 0; r < image.size(); ++r) {
            const double common = image[r] + first[r] + mapping[r];
            filtered.push_back(common + filtering[r]);
            sampled.push_back(common + point[r]);
        }
        return ratio_of(filtered, sampled);
    }
    Value filtering_over_point() const { return ratio_of(filtering, point); }
    // Percent of the image's time that the shadows of the first lights add.
    Value percent_of_lights(std::size_t count) const { return 100.0 * ratio_of(added[count - 1], image); }

    Value of_each(double (*figure)(double image, double first, double mapping, double filtering)) const {
        std::vector<double> figures;
        for (std::size_t r = 0; r < image.size(); ++r)
            figures.push_back(figure(image[r], first[r], mapping[r], filtering[r]));
        return of(results::summarise(figures));
    }
};

class Timed {
public:
    Timed(const scene::Scenario& scenario, const bench::Contender& contender, const bench::Contender& point)
        : scenario_(scenario), contender_(contender), point_(point), tracer_(scenario.scene, false) {
        view_.camera = scenario.receivers.camera.value();
        view_.size = scenario.receivers.resolution;
        view_.rays_per_side = 4;
        passes_.lights = scenario.lights.size();
        passes_.added.resize(passes_.lights);
    }

    void repeat() {
        const bench::Stopwatch stopwatch;
        const render::ShadingPoints points =
            render::find_shading_points(scenario_.scene, scenario_.lights, view_, tracer_, {});
        render::Picture picture = render::start_picture(points);
        const std::vector<float> lit(points.points(), 1.0f);
        for (std::size_t light = 0; light < passes_.lights; ++light) render::add_light(points, light, lit, picture);
        passes_.image.push_back(stopwatch.seconds());
        for (std::vector<double>* part : {&passes_.first, &passes_.mapping, &passes_.filtering, &passes_.point})
            part->push_back(0.0);
        for (std::size_t light = 0; light < passes_.lights; ++light) {
            shadow(light, points);
            passes_.added[light].push_back(passes_.first.back() + passes_.mapping.back() + passes_.filtering.back());
        }
    }
    const Passes& passes() const { return passes_; }

private:
    void shadow(std::size_t light, const render::ShadingPoints& points) {
        const bench::Stopwatch first;
        const auto [view, layout, least] = bench::prepare_light(scenario_, light, {}, {});
        const rays::Capture capture(scenario_.scene, view, layout);
        const bench::Maps maps = build(contender_, capture, layout, view);
        passes_.first.back() += first.seconds();
        const bench::Maps same = build(point_, capture, layout, view);

        const bench::Stopwatch mapping;
        const render::PointQueries regions = render::point_queries(points, scenario_.receivers, view);
        passes_.mapping.back() += mapping.seconds();

        const bench::Stopwatch filtering;
        bench::lookup_all(maps, {regions.queries, regions.footprints});
        passes_.filtering.back() += filtering.seconds();

        const bench::Stopwatch point;
        bench::lookup_all(same, {regions.queries, regions.footprints});
        passes_.point.back() += point.seconds();
    }

    static bench::Maps build(const bench::Contender& contender, const rays::Capture& capture,
                             const rays::MapLayout& layout, const rays::LightView& view) {
        bench::Maps maps = bench::begin_maps(*contender.row, contender.values, {layout, view, nullptr});
        for (int tile = 0; tile < layout.tiles(); ++tile) bench::add(maps, capture.tile(tile));
        bench::finish(maps);
        return maps;
    }

    const scene::Scenario& scenario_;
    const bench::Contender &contender_, &point_;
    rays::Tracer tracer_;
    render::ViewSettings view_;
    Passes passes_;
};

Passes time_passes(const Context& context, const char* name) {
    std::vector<std::string> set{"rays.resolution=384", "receivers.resolution=[384,288]", "receivers.bias=0", filter};
    if (context.quick) set.insert(set.end(), {"rays.resolution=192", "receivers.resolution=[192,144]"});
    const nlohmann::json document = context.document(name, set);
    note_document(context, name, document);
    const FirstLight all(document, context.data);  // and the scenario's other lights
    const base::ThreadLimit one_thread(1);
    Timed timed(all.scenario, all.contenders.at(0), all.contenders.at(1));
    for (int repetition = 0; repetition < repetitions; ++repetition) timed.repeat();
    return timed.passes();
}

Value percent_added(const Passes& passes) {
    return passes.of_each([](double image, double first, double mapping, double filtering) {
        return 100.0 * (first + mapping + filtering) / image;
    });
}

// Percent of the time that shadows add: the depth maps, mapping, filtering.
std::array<Value, 3> split(const Passes& passes) {
    return {passes.of_each([](double, double first, double mapping, double filtering) {
                return 100.0 * first / (first + mapping + filtering);
            }),
            passes.of_each([](double, double first, double mapping, double filtering) {
                return 100.0 * mapping / (first + mapping + filtering);
            }),
            passes.of_each([](double, double first, double mapping, double filtering) {
                return 100.0 * filtering / (first + mapping + filtering);
            })};
}

// The image with shadows over that of an image for each light and one more.
Value share_of_naive(const Passes& passes) {
    return (1.0 / (1.0 + static_cast<double>(passes.lights))) *
           passes.of_each([](double image, double first, double mapping, double filtering) {
               return (image + first + mapping + filtering) / image;
           });
}

// One depth map over an image without shadows.
Value share_of_image(const Passes& passes) {
    return (1.0 / static_cast<double>(passes.lights)) *
           passes.of_each([](double image, double first, double, double) { return first / image; });
}

// The paper's minutes.
struct Row {
    const char* scenario;
    const char* title;
    bool rebuilt;  // from the paper's figures, and no stand-in for a scene that is not public
    double without, first, total, percent;
};
constexpr Row rows[] = {{sphere, "Sphere and plane", true, 42.0, 9.7, 57.7, 37.3},
                        {lights, "Coloured lights", true, 64.4, 14.2, 95.0, 47.6},
                        {store, "Red's Dream (a room full of things)", false, 261.3, 55.3, 387.4, 48.4}};

constexpr const char* not_public =
    "Red's Dream is not public; a room full of things, which stands in for it, does not have its times. ";

std::string depth_maps_text(const Row& row, const Value& depth_maps) {
    return fmt::format("The split differs, too: depth maps take {} % of the added time here, {:.0f} % there.",
                       to_text(depth_maps), 100.0 * row.first / (row.total - row.without));
}

void add_image(const Row& row, const Passes& passes, Table& table, Table& parts, PaperReport& report) {
    const Value increase = percent_added(passes);
    const auto ms = [](const Value& seconds) { return to_text(1e3 * seconds); };
    table.rows.push_back({row.title, ms(of(results::summarise(passes.image))), std::to_string(passes.lights),
                          ms(of(results::summarise(passes.first))),
                          ms(passes.of_each([](double image, double, double mapping, double filtering) {
                              return image + mapping + filtering;
                          })),
                          to_text(increase) + " %", fmt::format("{:.1f} %", row.percent)});
    const auto [depth_maps, mapping, filtering] = split(passes);
    parts.rows.push_back({row.title, to_text(depth_maps) + " %",
                          fmt::format("{:.0f} %", 100.0 * row.first / (row.total - row.without)),
                          to_text(mapping) + " %", to_text(filtering) + " %"});
    report.claims.push_back({"section 5, table 1",
                             fmt::format("{}: shadows add {:.1f} % to the time of the image", row.title, row.percent),
                             to_text(increase) + " %",
                             row.rebuilt ? judge_added(exactly(row.percent), increase) : not_comparable(),
                             std::string(row.rebuilt ? "" : not_public) +
                                 "The denominator is the time of the image without shadows, whose shading is one dot "
                                 "product here. Each of 16 rays a pixel is filtered by itself; a renderer of "
                                 "micropolygons, which the paper names, filters once for each of them. " +
                                 depth_maps_text(row, depth_maps),
                             {increase}});
}

// Of three lights: what their number does, and the row of Luxo Jr.
void add_lights(const Passes& passes, PaperReport& report) {
    std::vector<Value> values;
    std::string text;
    for (std::size_t count = 1; count <= passes.lights; ++count) {
        values.push_back(passes.percent_of_lights(count));
        text += fmt::format("{}{} %", count == 1 ? "" : ", ", to_text(values.back()));
    }
    report.claims.push_back({"section 5", "the cost grows as the number of lights casting shadows grows",
                             fmt::format("coloured lights: 1, 2, 3 lights add {}", text), by_construction(true),
                             "Each light adds a depth map and its own filtering to the same image.", values});
    report.claims.push_back({"section 5, table 1",
                             "Luxo Jr. (three lights): shadows add 50.9 % to the time of the image",
                             fmt::format("coloured lights: {} %", to_text(values.back())),
                             not_comparable(),
                             "The film's scene is not public. The coloured lights are three, too, but it is not they "
                             "that the row is about.",
                             {values.back()}});
}

}  // namespace

void times(const Context& context) {
    PaperReport& report = *context.report;
    Table table{"Table 1: milliseconds",
                {"image", "without shadows", "lights", "first pass", "second pass", "increase", "theirs"},
                {}};
    Table parts{"Parts of the time that shadows add",
                {"image", "depth maps", "theirs", "mapping regions into light space", "filtering"},
                {}};
    std::vector<Judged> less, faster;
    std::vector<Value> shares, depth_map_shares, increases, factors, lookups;
    std::string measured, depth_map_text, factor_text, lookup_text;
    for (const Row& row : rows) {
        const Passes passes = time_passes(context, row.scenario);
        add_image(row, passes, table, parts, report);
        if (row.rebuilt) {
            const Value share = share_of_naive(passes);
            less.push_back(judge_significant(share, exactly(1.0)));
            shares.push_back(share);
            measured += (measured.empty() ? "" : ", ") + to_text(share);
            const Value of_image = share_of_image(passes);
            faster.push_back(judge_less(of_image, exactly(1.0)));
            depth_map_shares.push_back(of_image);
            depth_map_text += (depth_map_text.empty() ? "" : ", ") + to_text(of_image);
            increases.push_back(percent_added(passes));
            factors.push_back(passes.over_point_sampled());
            lookups.push_back(passes.filtering_over_point());
            factor_text += (factor_text.empty() ? "" : ", ") + to_text(factors.back());
            lookup_text += (lookup_text.empty() ? "" : ", ") + to_text(lookups.back());
        }
        if (row.scenario != lights) continue;
        const auto [depth_maps, mapping, filtering] = split(passes);
        report.claims.push_back(
            {"section 5",
             "Luxo Jr. (three lights): of the time that shadows add, the depth maps take 50 %, filtering 28 % and "
             "mapping regions into light space 22 %",
             fmt::format("coloured lights: {} %, {} %, {} %", to_text(depth_maps), to_text(filtering),
                         to_text(mapping)),
             not_comparable(),
             "Their mapping is interpreted, in the light tree, and ours is compiled; Luxo Jr. is not public. Their "
             "depth maps come from their renderer, and ours from projecting the casters.",
             {depth_maps, filtering, mapping}});
        add_lights(passes, report);
    }
    parts.rows.push_back({"Luxo Jr., theirs", "", "50 %", "22 %", "28 %"});
    report.claims.push_back({"section 5, table 1",
                             "an image with shadows costs significantly less than 1 + lights images without",
                             fmt::format("sphere and plane, coloured lights: {} of that", measured), in_all(less),
                             "The paper's own images take 0.69 and 0.37 of it.", shares});
    const Value average = 0.5 * (increases[0] + increases[1]);
    report.claims.push_back({"section 5",
                             "on average, an image with shadows costs 40 % to 50 % more than the one without",
                             fmt::format("{} % more", to_text(average)),
                             judge_added({45.0, 40.0, 50.0}, average),
                             "The mean of the two images that are rebuilt, against the nearer end of 40 % to 50 %. The "
                             "paper's four cost 46 % more, and its own two of these 42 %.",
                             {average}});
    std::vector<Judged> dearer;
    for (const Value& factor : factors) dearer.push_back(judge_less(exactly(1.0), factor));
    factors.insert(factors.end(), lookups.begin(), lookups.end());
    const std::string factors_text = fmt::format(
        "sphere and plane, coloured lights: an image takes {} times as long as with point-sampled shadows; filtering "
        "alone takes {} times as long as point sampling",
        factor_text, lookup_text);
    report.claims.push_back(
        {"section 7", "the method is more expensive in time than evaluating a single sample", factors_text,
         in_all(dearer),
         "Judged by the image. Both images have the same depth maps, and map the same regions into light space.",
         factors});
    report.claims.push_back({"section 7", "in practice the factor by which it is more expensive is small", factors_text,
                             not_comparable(), "The paper gives no number for small.", factors});
    report.claims.push_back(
        {"section 3.1", "a depth map can be computed faster than a shaded image",
         fmt::format("sphere and plane, coloured lights: {} of the time of the image without shadows", depth_map_text),
         in_all(faster), "Of one depth map as many pixels across as the image, with one ray a pixel; the image has 16.",
         depth_map_shares});
    report.tables.push_back(std::move(table));
    report.tables.push_back(std::move(parts));
}

}  // namespace shadowbench::claims::reeves

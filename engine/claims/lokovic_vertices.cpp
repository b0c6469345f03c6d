// Lokovic and Veach, Deep Shadow Maps, 2000: section 4 and figure 8.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "claims/growth.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/pixel_classes.h"

namespace shadowbench::claims::lokovic {
namespace {

constexpr int most_with_all_seeds = 256;                        // samples a pixel: more take too long for three seeds
constexpr const char* compressed[] = {"published", "bounded"};  // the paper's text, and the program's default

std::string both_ways() {
    return set_techniques(fmt::format(R"({{"type":"deep","compression":"{}"}},{{"type":"deep","compression":"{}"}})",
                                      compressed[0], compressed[1]));
}

// Mean vertices over numbers of samples a pixel.
struct Vertices {
    std::vector<Growth> all, chosen, others;  // [way to compress]

    Vertices() : all(2), chosen(2), others(2) {}
    void add(int samples, const std::vector<MeanVertices>& means) {
        for (std::size_t way = 0; way < means.size(); ++way) {
            all[way].add(samples, means[way].all);
            chosen[way].add(samples, means[way].chosen);
            others[way].add(samples, means[way].others);
        }
    }
};

struct Experiment {
    Vertices ball, smoke;
    double hair_share = 0.0;  // of the pixels that hold hair
};

nlohmann::json noted(const Context& context, const std::string& scene, const std::vector<std::string>& settings) {
    nlohmann::json document = context.document(scene, settings);
    note_document(context, scene, document);
    return document;
}

// A scene, and the settings that leave only the class of interest in the map.
struct Scene {
    const char* name;
    int resolution;
    std::vector<std::string> alone;
};

// A pixel belongs to the class if any of 256 rays meets it. `whole`: the functions are of the whole scene.
Vertices count(const Context& context, const Scene& scene, bool whole, double& share) {
    std::vector<std::string> alone = scene.alone;
    const std::string resolution = fmt::format("rays.resolution={}", scene.resolution);
    alone.insert(alone.end(), {resolution, "rays.samples_per_pixel=256"});
    const std::vector<char> chosen = crossed_pixels(noted(context, scene.name, alone), context.data);
    share = static_cast<double>(std::count(chosen.begin(), chosen.end(), 1)) / static_cast<double>(chosen.size());
    Vertices vertices;
    for (const int samples : {16, 36, 64, 144, 256, 1024}) {
        if (context.quick && samples > 256) break;  // at a lower resolution pixels would hold other hair
        for (int seed = 1; seed <= (samples <= most_with_all_seeds ? ray_seeds : 2); ++seed) {
            std::vector<std::string> settings = whole ? std::vector<std::string>{} : scene.alone;
            settings.insert(settings.end(), {resolution, fmt::format("rays.samples_per_pixel={}", samples),
                                             fmt::format("rays.seed={}", seed), both_ways()});
            vertices.add(samples, mean_vertices(noted(context, scene.name, settings), context.data, chosen));
        }
    }
    return vertices;
}

Experiment run(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const std::vector<std::string> alone{"/scene/objects/1/casts_shadow=false", "/scene/objects/2/casts_shadow=false"};
    Experiment experiment;
    double smoke_share = 0.0;
    experiment.ball = count(context, {ball_scene, 256, alone}, true, experiment.hair_share);
    experiment.smoke = count(context, {smoke_scene, 64, alone}, false, smoke_share);
    return experiment;
}

struct Column {
    const char* name;
    const Growth& vertices;
};

std::vector<Column> columns_of(const Experiment& e) {
    return {{"all pixels", e.ball.all[0]},
            {"hair", e.ball.chosen[0]},
            {"geometry", e.ball.others[0]},
            {"smoke", e.smoke.chosen[0]},
            {"all, compression=bounded", e.ball.all[1]},
            {"hair, compression=bounded", e.ball.chosen[1]}};
}

void add_table(const std::vector<Column>& columns, PaperReport& report) {
    const Growth& first = columns.front().vertices;
    Table table{
        fmt::format("Figure 8: vertices a pixel; means over {} seeds of the light rays up to N = {}, then over 2",
                    ray_seeds, most_with_all_seeds),
        {"N"},
        {}};
    for (const Column& column : columns) table.header.emplace_back(column.name);
    for (std::size_t i = 0; i < first.size(); ++i) {
        std::vector<std::string> row{fmt::format("{:.0f}", first.x(i))};
        for (const Column& column : columns) row.push_back(to_text(column.vertices.at(i)));
        table.rows.push_back(std::move(row));
    }
    std::vector<std::string> fitted{"exponent, of the fit to all means"},
        of_seeds{fmt::format("exponent up to N = {}, mean over {} seeds", most_with_all_seeds, ray_seeds)};
    for (const Column& column : columns) {
        fitted.push_back(to_text(column.vertices.exponent()));
        of_seeds.push_back(to_text(column.vertices.exponent_over_seeds()));
    }
    table.rows.insert(table.rows.end(), {std::move(fitted), std::move(of_seeds)});
    report.tables.push_back(std::move(table));
}

void add_plot(const std::vector<Column>& columns, PaperReport& report) {
    Plot plot{"lokovic2000_figure8",
              "Figure 8: vertices a pixel over samples a pixel",
              "N",
              "vertices a pixel",
              true,
              true,
              {}};
    for (std::size_t c = 0; c < 4; ++c) plot.series.push_back({columns[c].name, columns[c].vertices.means(), true});
    const auto all = columns.front().vertices.means();
    Series theory{"N^(1/4)", {}, true};
    for (const auto& [n, vertices] : all)
        theory.points.emplace_back(n, all.front().second * std::pow(n / all.front().first, 0.25));
    plot.series.push_back(std::move(theory));
    report.plots.push_back(std::move(plot));
}

}  // namespace

void vertices(const Context& context) {
    PaperReport& report = *context.report;
    const Experiment experiment = run(context);
    const std::vector<Column> columns = columns_of(experiment);
    add_table(columns, report);
    add_plot(columns, report);
    const auto exponent = [&](std::size_t column) { return columns[column].vertices.exponent(); };
    const Value all = exponent(0), hair = exponent(1), geometry = exponent(2), smoke = exponent(3);
    const std::string fit = fmt::format(
        "Fitted over N from 16 to {:.0f}, with the paper's compression word for word; intervals are those of the fits "
        "(Student's t), and hold what the rays of each N change. The table has exponents over seeds, too.",
        columns.front().vertices.x(columns.front().vertices.size() - 1));
    report.claims.push_back(
        {"section 4, figure 8",
         "vertices a pixel grow as N^(1/4), in a map with hair in 40 % of its pixels and simple geometry in the rest",
         fmt::format("as N^{}, with hair in {:.0f} % of the pixels and geometry, N^{}, in the rest", to_text(all),
                     100.0 * experiment.hair_share, to_text(geometry)),
         judge_exponent(0.25, all),
         "The mean over all pixels, as in the figure. " + fit,
         {all, geometry}});
    report.claims.push_back(
        {"section 4",
         "a function that is piecewise smooth, the usual case, needs only O(N^(1/4)) vertices",
         fmt::format("hair N^{}, smoke N^{}", to_text(hair), to_text(smoke)),
         both(judge_at_most_exponent(0.25, hair), judge_at_most_exponent(0.25, smoke)),
         "Functions of pixels that hold hair, and of those that hold smoke, by the worse of both; O() is a bound. What "
         "grows faster than N^(1/4) is not smooth at these N. " +
             fit,
         {hair, smoke}});
    report.claims.push_back(
        {"section 4",
         "a compressed function has at most O(N^(1/2)) vertices, since it falls by at least the tolerance at each",
         fmt::format("hair N^{}, smoke N^{}", to_text(hair), to_text(smoke)),
         both(judge_at_most_exponent(0.5, hair), judge_at_most_exponent(0.5, smoke)),
         "The same functions. " + fit,
         {hair, smoke}});
}

}  // namespace shadowbench::claims::lokovic

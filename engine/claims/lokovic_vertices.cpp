// Lokovic and Veach, Deep Shadow Maps, 2000: section 4 and figure 8.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/pixel_classes.h"

namespace shadowbench::claims::lokovic {
namespace {

using Points = std::vector<std::pair<double, double>>;

constexpr const char* compressed[] = {"published", "bounded"};  // the paper's text, and the program's default

std::string both_ways() {
    return set_techniques(fmt::format(R"({{"type":"deep","compression":"{}"}},{{"type":"deep","compression":"{}"}})",
                                      compressed[0], compressed[1]));
}

// The means over numbers of samples a pixel.
struct Growth {
    std::vector<Points> all, chosen, others;  // [way to compress]

    Growth() : all(2), chosen(2), others(2) {}
    void add(int samples, const std::vector<MeanVertices>& means) {
        for (std::size_t way = 0; way < means.size(); ++way) {
            all[way].emplace_back(samples, means[way].all);
            chosen[way].emplace_back(samples, means[way].chosen);
            others[way].emplace_back(samples, means[way].others);
        }
    }
};

struct Experiment {
    Growth ball, smoke;
    double hair_share = 0.0;  // of the pixels that hold hair
};

nlohmann::json noted(const Context& context, const std::string& scene, const std::vector<std::string>& settings) {
    nlohmann::json document = context.document(scene, settings);
    context.report->documents.push_back(fmt::format("{} {}", scene, base::hash_text(document.dump())));
    return document;
}

// A scene, and the settings that leave only the class of interest in the map.
struct Scene {
    const char* name;
    int resolution;
    std::vector<std::string> alone;
};

// A pixel belongs to the class if any of 256 rays meets it. `whole`: the functions are of the whole scene.
Growth grow(const Context& context, const Scene& scene, bool whole, double& share) {
    std::vector<std::string> alone = scene.alone;
    const std::string resolution = fmt::format("rays.resolution={}", scene.resolution);
    alone.insert(alone.end(), {resolution, "rays.samples_per_pixel=256"});
    const std::vector<char> chosen = crossed_pixels(noted(context, scene.name, alone), context.data);
    share = static_cast<double>(std::count(chosen.begin(), chosen.end(), 1)) / static_cast<double>(chosen.size());
    Growth growth;
    for (const int samples : {16, 36, 64, 144, 256, 1024}) {
        if (context.quick && samples > 256) break;  // at a lower resolution pixels would hold other hair
        std::vector<std::string> settings = whole ? std::vector<std::string>{} : scene.alone;
        settings.insert(settings.end(), {resolution, fmt::format("rays.samples_per_pixel={}", samples), both_ways()});
        growth.add(samples, mean_vertices(noted(context, scene.name, settings), context.data, chosen));
    }
    return growth;
}

Experiment run(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const std::vector<std::string> alone{"/scene/objects/1/casts_shadow=false", "/scene/objects/2/casts_shadow=false"};
    Experiment experiment;
    double smoke_share = 0.0;
    experiment.ball = grow(context, {ball_scene, 256, alone}, true, experiment.hair_share);
    experiment.smoke = grow(context, {smoke_scene, 64, alone}, false, smoke_share);
    return experiment;
}

struct Column {
    const char* name;
    const Points& points;
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
    Table table{"Figure 8: vertices a pixel; intervals are those of the fits", {"N"}, {}};
    for (const Column& column : columns) table.header.emplace_back(column.name);
    for (std::size_t i = 0; i < columns.front().points.size(); ++i) {
        std::vector<std::string> row{fmt::format("{:.0f}", columns.front().points[i].first)};
        for (const Column& column : columns) row.push_back(fmt::format("{:.2f}", column.points[i].second));
        table.rows.push_back(std::move(row));
    }
    std::vector<std::string> row{"exponent"};
    for (const Column& column : columns) row.push_back(to_text(fitted_exponent(column.points)));
    table.rows.push_back(std::move(row));
    report.tables.push_back(std::move(table));
}

void add_plot(const std::vector<Column>& columns, PaperReport& report) {
    Plot plot{"lokovic2000_figure8", "Vertices a pixel over samples a pixel", "N", "vertices a pixel", true, true, {}};
    for (std::size_t c = 0; c < 4; ++c) plot.series.push_back({columns[c].name, columns[c].points, true});
    const Points& all = columns.front().points;
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
    const auto exponent = [&](std::size_t column) { return fitted_exponent(columns[column].points); };
    const Value all = exponent(0), hair = exponent(1), geometry = exponent(2), smoke = exponent(3);
    const std::string fit = fmt::format(
        "Fitted over N from 16 to {:.0f}, with the paper's compression word for word; intervals are those of the fits "
        "(Student's t).",
        columns.front().points.back().first);
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
         both(judge_exponent(0.25, hair), judge_exponent(0.25, smoke)),
         "Functions of pixels that hold hair, and of those that hold smoke. What grows faster than N^(1/4) is not "
         "smooth at these N. " + fit,
         {hair, smoke}});
}

}  // namespace shadowbench::claims::lokovic

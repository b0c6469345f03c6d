// Lokovic and Veach, Deep Shadow Maps, 2000: section 5.3, the size of mip levels.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/seeded_light.h"
#include "curves/norms.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/pixel_run.h"

namespace shadowbench::claims::lokovic {
namespace {

using techniques::DeepLevel;

constexpr const char* at_64_samples = "rays.samples_per_pixel=64";

// Ways to make levels: the paper's compression and the program's, each from compressed functions, as the paper does,
// and from the uncompressed ones.
struct Way {
    const char* compression;
    const char* from;
};
constexpr Way ways[] = {
    {"published", "compressed"}, {"published", "samples"}, {"bounded", "compressed"}, {"bounded", "samples"}};
constexpr std::size_t papers = 0;                  // the paper's way among them
constexpr std::size_t lossless = std::size(ways);  // the last map

std::string technique(const Way& way) {
    return fmt::format(R"({{"type":"deep","mip":"nearest","compression":"{}","mip_from":"{}"}})", way.compression,
                       way.from);
}

std::span<const DeepLevel> levels_of(const bench::Maps& maps) {
    return techniques::levels(*maps.parts.front());
}

// One way's levels, each with a value for every seed.
struct Levels {
    std::vector<std::vector<double>> nodes, size, error;  // [level][seed]; see add()
    std::vector<double> all;                              // [seed] bytes of all levels over those of the map

    // nodes: for each pixel that holds something; size: bytes over those of level 0; error: the largest of any
    // function, in tolerances of level 0.
    void add(std::span<const DeepLevel> levels, std::span<const DeepLevel> exact, double tolerance,
             const rays::MapLayout& layout) {
        nodes.resize(levels.size());
        size.resize(levels.size());
        error.resize(levels.size());
        double bytes = 0.0;
        for (std::size_t l = 0; l < levels.size(); ++l) {
            nodes[l].push_back(nodes_of(levels[l]));
            size[l].push_back(static_cast<double>(levels[l].bytes()) / static_cast<double>(levels[0].bytes()));
            error[l].push_back(error_of(levels[l], exact[l], layout) / tolerance);
            bytes += static_cast<double>(levels[l].bytes());
        }
        all.push_back(bytes / static_cast<double>(levels[0].bytes()));
    }

private:
    static double nodes_of(const DeepLevel& level) {
        double nodes_in_all = 0.0, pixels = 0.0;
        for (std::size_t p = 0; p + 1 < level.offsets.size(); ++p) {
            nodes_in_all += level.nodes(p);
            pixels += level.nodes(p) > 0;
        }
        return nodes_in_all / std::max(pixels, 1.0);
    }
    static double error_of(const DeepLevel& level, const DeepLevel& exact, const rays::MapLayout& layout) {
        curves::Curve stored, truth;
        double worst = 0.0;
        for (std::size_t p = 0; p + 1 < level.offsets.size(); ++p) {
            techniques::read_function(level, p, 0, stored);
            techniques::read_function(exact, p, 0, truth);
            worst = std::max(worst, curves::distance(stored, truth, layout.z_min, layout.z_max).max);
        }
        return worst;
    }
};

std::vector<Levels> measure_levels(const Context& context) {
    std::string list;
    for (const Way& way : ways) list += technique(way) + ",";
    list += R"({"type":"deep","mip":"nearest","mip_from":"samples","tolerance":0})";
    const SeededLight light(context, ball_scene, {at_64_samples, "rays.resolution=128", set_techniques(list)},
                            {"rays.resolution=64"});
    const double tolerance = 0.25 / std::sqrt(64.0);
    std::vector<Levels> found(std::size(ways));
    for (int seed = 0; seed < ray_seeds; ++seed) {
        const std::vector<bench::Maps> maps = light.build(seed);
        base::parallel_for(found.size(), [&](std::size_t way) {
            found[way].add(levels_of(maps[way]), levels_of(maps[lossless]), tolerance, light.layout());
        });
    }
    return found;
}

// A row for each level: the number of each way, then that of the paper's law.
Table level_table(const std::string& title, const std::vector<Levels>& found,
                  std::vector<std::vector<double>> Levels::*number, double (*law)(double level)) {
    Table table{title, {"level"}, {}};
    for (const Way& way : ways)
        table.header.push_back(fmt::format("compression={}, from {}", way.compression,
                                           way.from == std::string("samples") ? "samples" : "compressed functions"));
    table.header.push_back("the paper's law");
    const double first = mean_of((found[papers].*number)[0]).value;
    for (std::size_t l = 0; l < (found[papers].*number).size(); ++l) {
        std::vector<std::string> row{std::to_string(l)};
        for (const Levels& way : found) row.push_back(to_text(mean_of((way.*number)[l])));
        row.push_back(fmt::format("{:.3g}", first * law(static_cast<double>(l))));
        table.rows.push_back(std::move(row));
    }
    return table;
}

void add_level_tables(PaperReport& report, const std::vector<Levels>& found) {
    report.tables.push_back(
        level_table("Section 5.3: nodes of the functions in mip levels of a map of 128 x 128 pixels of the ball "
                    "scene, 64 samples a pixel, for each pixel that holds something; means over three seeds of the "
                    "light rays",
                    found, &Levels::nodes, [](double level) { return std::exp2(0.5 * level); }));
    Table sizes = level_table("Section 5.3: bytes of the same levels over those of level 0; means over the same seeds",
                              found, &Levels::size, [](double level) { return std::exp2(-1.5 * level); });
    std::vector<std::string> all{"all"};
    for (const Levels& way : found) all.push_back(to_text(mean_of(way.all)));
    all.push_back("1.55");
    sizes.rows.push_back(std::move(all));
    report.tables.push_back(std::move(sizes));
}

// The nodes of each level over those of two levels before.
std::vector<Value> growth_over_two_levels(const Levels& found) {
    std::vector<Value> growth;
    for (std::size_t l = 2; l < found.nodes.size(); ++l) {
        std::vector<double> of_seeds;
        for (std::size_t seed = 0; seed < found.nodes[l].size(); ++seed)
            of_seeds.push_back(found.nodes[l][seed] / found.nodes[l - 2][seed]);
        growth.push_back(mean_of(of_seeds));
    }
    return growth;
}

std::string joined(const std::vector<Value>& values) {
    std::string text;
    for (const Value& value : values) text += (text.empty() ? "" : ", ") + to_text(value);
    return text;
}

// The largest over the first levels, of this number; its interval is the range over the seeds.
Value largest_error(const Levels& found, std::size_t levels) {
    std::vector<double> of_seed(ray_seeds, 0.0);
    for (std::size_t l = 0; l < levels; ++l)
        for (std::size_t seed = 0; seed < of_seed.size(); ++seed)
            of_seed[seed] = std::max(of_seed[seed], found.error[l][seed]);
    const auto [low, high] = std::minmax_element(of_seed.begin(), of_seed.end());
    return {*high, *low, *high};
}

}  // namespace

void levels(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    const std::vector<Levels> found = measure_levels(context);
    add_level_tables(report, found);
    const Levels &published = found[papers], &of_samples = found[papers + 1];
    const Value size = mean_of(published.all), size_of_samples = mean_of(of_samples.all);
    report.claims.push_back(
        {"section 5.3",
         "all mip levels together are about 1.55 times as large as the base",
         fmt::format("{} times; {} times if the levels are averaged from the uncompressed functions", to_text(size),
                     to_text(size_of_samples)),
         judge_size(1.55, 4.0 / 3.0, size),
         "Judged as published: each level is averaged from the compressed functions of the one before, with half its "
         "tolerance. Section 6 also prints \"approximately 1.5 times larger\".",
         {size, size_of_samples}});
    const std::vector<Value> growth = growth_over_two_levels(published),
                             growth_of_samples = growth_over_two_levels(of_samples);
    std::vector<Judged> doubled;
    for (const Value& one : growth) doubled.push_back(judge_ratio(2.0, one));
    std::vector<Value> values = growth;
    values.insert(values.end(), growth_of_samples.begin(), growth_of_samples.end());
    report.claims.push_back(
        {"section 5.3", "the vertices of a function double once for every two mip levels",
         fmt::format("over those of two levels before, from level 2 on: {} times; {} times if the levels are averaged "
                     "from the uncompressed functions",
                     joined(growth), joined(growth_of_samples)),
         in_all(doubled),
         "Judged at every level, down to the single pixel of the last; of pixels that hold something. Intervals are "
         "over seeds. The means of compressed functions have few vertices to begin with: level 1 often needs fewer "
         "than level 0.",
         std::move(values)});
    const Value error = largest_error(published, published.error.size()), of_map = largest_error(published, 1);
    report.claims.push_back(
        {"section 3.3",
         "a compressed function is within the tolerance of the function for all z",
         fmt::format("the largest error of any function of the map is {} tolerances", to_text(of_map)),
         by_construction(of_map.high <= 1.0 + 1e-4),
         "Steps included, to both sides of each. The interval is the range over seeds.",
         {of_map}});
    report.claims.push_back(
        {"section 5.3",
         "if the tolerance is halved for each level, the total error is at most twice that of the highest "
         "resolution",
         fmt::format("the largest error of any function of any level is {} tolerances", to_text(error)),
         by_construction(error.high <= 2.0 + 1e-4),
         "The tolerances are a geometric series. The interval is the range over seeds.",
         {error}});
}

}  // namespace shadowbench::claims::lokovic

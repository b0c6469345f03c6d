// Pagot, Comba, Oliveira 2004: section 6. Selecting a second depth costs q samples a cell and saves r kernel samples a
// fragment, so two depths pay if there are more than q / r fragments a cell: equations 5 and 6. A shadow test on two
// depths costs more than one on a single depth.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/queries.h"
#include "claims/first_light.h"
#include "claims/intervals.h"
#include "claims/pagot.h"
#include "claims/seeded_light.h"
#include "rays/tracer.h"

namespace shadowbench::claims::pagot {
namespace {

constexpr int repetitions = 11;
constexpr double fragments_a_cell[] = {0.25, 0.5, 1, 1.5, 2, 3};  // of the image's pixels
constexpr std::array<Kernel, 2> kernels{Kernel{1, 4}, Kernel{2, 3}};

// The queries of one image, and the seconds that each kernel takes for the map's depths and all queries, of each
// repetition, on one thread.
struct Image {
    bench::QuerySet queries;
    double fragments = 0.0;  // a cell: pixels that see a surface inside the map
    std::array<std::vector<double>, kernels.size()> seconds;
};

// Capturing the map's rays is not timed, since both kernels share it.
void time_kernel(const FirstLight& first, std::span<const rays::LightRays> tiles, const bench::Contender& contender,
                 const Image& image, std::vector<double>& seconds) {
    bench::Maps maps = bench::begin_maps(*contender.row, contender.values, first.input());
    for (const rays::LightRays& tile : tiles) bench::add(maps, tile);
    std::vector<float> answers(image.queries.queries.size());
    const bench::Stopwatch stopwatch;
    bench::finish(maps);
    bench::lookup(maps, image.queries.asked(), answers);
    seconds.push_back(stopwatch.seconds());
}

// Camera images of the scene with more and more pixels.
std::vector<Image> make_images(const FirstLight& first) {
    const rays::Tracer all(first.scenario.scene, false);
    const double cells = static_cast<double>(first.light.layout.width) * first.light.layout.height;
    std::vector<Image> images;
    for (const double fragments : fragments_a_cell) {
        scene::Receivers receivers = first.scenario.receivers;
        const int side = static_cast<int>(std::lround(std::sqrt(fragments * cells)));
        receivers.resolution = {side, side};
        Image& image = images.emplace_back();
        image.queries = bench::queries_of_points(bench::camera_points(receivers, all), receivers, first.light.view);
        image.fragments = static_cast<double>(image.queries.queries.size()) / cells;
    }
    return images;
}

std::vector<Image> time_images(const Context& context) {
    std::vector<std::string> set{fmt::format("techniques=[{},{}]", request(kernels[0]), request(kernels[1]))};
    if (context.quick) set.push_back("rays.resolution=256");
    const nlohmann::json document = context.document(flat, set);
    note_document(context, flat, document);
    const FirstLight first(document, context.data);
    const std::vector<rays::LightRays> tiles = first.tiles();
    std::vector<Image> images = make_images(first);
    const base::ThreadLimit one_thread(1);
    for (int repetition = -1; repetition < repetitions; ++repetition)  // the first one warms up
        for (Image& image : images)
            for (std::size_t k = 0; k < kernels.size(); ++k) {
                std::vector<double> warm;
                time_kernel(first, tiles, first.contenders[k], image, repetition < 0 ? warm : image.seconds[k]);
            }
    return images;
}

Crossing crossing_in(const std::vector<Image>& images, std::size_t repetition) {
    std::vector<std::pair<double, double>> differences;
    for (const Image& image : images)
        differences.emplace_back(image.fragments, image.seconds[1][repetition] - image.seconds[0][repetition]);
    return crossing_of(differences);
}

Value median_of(const std::vector<Crossing>& crossings, double Crossing::*member, double scale) {
    std::vector<double> values;
    for (const Crossing& one : crossings) values.push_back(scale * one.*member);
    return claims::median_of(std::move(values));
}

// The time of a lookup of one kernel on two depths over that on one.
Value cost_of_two_depths(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const std::string list = fmt::format("techniques=[{},{}]", request({1, 3}), request({2, 3}));
    TimedMaps timed;
    timed.add(context, flat, {list}, {"rays.resolution=256", "receivers.resolution=[256,192]"}, 16384);
    const Compared compared[] = {{1, 0}};
    return timed.take(compared).ratio(1, 0);
}

void add_plot(const std::vector<Image>& images, PaperReport& report) {
    Plot plot{
        "pagot2004_equation6", "Selecting depths and looking them up", "fragments a cell", "ms", false, false, {}};
    for (std::size_t k = 0; k < kernels.size(); ++k) {
        Series series{title(kernels[k]), {}, true};
        for (const Image& image : images)
            series.points.emplace_back(image.fragments, 1e3 * results::summarise(image.seconds[k]).median);
        plot.series.push_back(std::move(series));
    }
    report.plots.push_back(std::move(plot));
}

}  // namespace

Crossing crossing_of(std::span<const std::pair<double, double>> differences) {
    const double n = static_cast<double>(differences.size());
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (const auto& [x, y] : differences) {
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx), start = (sy - slope * sx) / n;
    const double fragments = start <= 0.0 ? 0.0 : slope >= 0.0 ? never : std::min(never, -start / slope);
    return {start, -slope, fragments};
}

void crossing(const Context& context) {
    const std::vector<Image> images = time_images(context);
    add_plot(images, *context.report);
    std::vector<Crossing> crossings;
    for (std::size_t repetition = 0; repetition < static_cast<std::size_t>(repetitions); ++repetition)
        crossings.push_back(crossing_in(images, repetition));
    const double q = 9.0, r = 16.0 - 9.0, predicted = q / r;  // the paper prints 1.28
    const Value fragments = median_of(crossings, &Crossing::fragments, 1.0),
                selection = median_of(crossings, &Crossing::selection, 1e3),
                saved = median_of(crossings, &Crossing::saved, 1e3);
    const std::string costs =
        fmt::format("selection {} ms, {} ms saved by one fragment a cell", to_text(selection), to_text(saved));
    context.report->claims.push_back(
        {"section 6, equations 5 and 6",
         "2-SM with 3 x 3 beats 1-SM with 4 x 4 beyond 1.28 fragments a cell (q = 9, r = 7)",
         fragments.value < never ? fmt::format("beyond {} fragments a cell: {}", to_text(fragments), costs)
                                 : fmt::format("the lines do not cross: {}", costs),
         judge_ratio(predicted, fragments),
         "The paper counts only texture fetches; comparing a depth has a cost too. Lines that do not cross count as "
         "crossing at a million.",
         {fragments, selection, saved}});
    const Value dearer = cost_of_two_depths(context);
    context.report->claims.push_back(
        {"section 6",
         "a multiple-depth shadow test is slightly more expensive than a conventional one",
         fmt::format("a lookup of 3 x 3 cells on two depths takes {} times as long as on one", to_text(dearer)),
         both(judge_less(exactly(1.0), dearer), judge_constant(dearer)),
         "It costs more, and slightly so if by at most a factor of 1.25. Both kernels look up the same receivers in "
         "image order.",
         {dearer}});
}

}  // namespace shadowbench::claims::pagot

// Pagot, Comba, Oliveira 2004: section 6, equations 5 and 6. Selecting more depths costs q samples a cell and saves r
// kernel samples a fragment, so more depths pay if there are more than q / r fragments a cell.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/queries.h"
#include "claims/first_light.h"
#include "claims/intervals.h"
#include "claims/pagot.h"
#include "claims/turns.h"
#include "rays/tracer.h"

namespace shadowbench::claims::pagot {
namespace {

constexpr double fragments_a_cell[] = {0.25, 0.5, 1, 1.5, 2, 3};                       // of the image's pixels
constexpr std::size_t as_large_as_map = 2, largest = std::size(fragments_a_cell) - 1;  // places of two of them
constexpr std::array<Kernel, 3> kernels{Kernel{1, 4}, Kernel{2, 3}, Kernel{3, 3}};
constexpr std::size_t one_depth = 0, two_depths = 1, three_depths = 2;  // their places

// The queries of one image.
struct Image {
    bench::QuerySet queries;
    double fragments = 0.0;  // a cell: pixels that see a surface inside the map
};

// The seconds that each kernel takes for the map's depths and all queries of each image, on one thread.
struct Measured {
    std::vector<Image> images;
    Turns seconds;

    static std::size_t place(std::size_t image, std::size_t kernel) { return image * kernels.size() + kernel; }
    Value ratio(std::size_t image, std::size_t kernel) const {  // to the kernel on one depth
        return seconds.ratio(place(image, kernel), place(image, one_depth));
    }
    // Of each round, for this kernel and that on one depth.
    std::vector<Crossing> crossings(std::size_t kernel) const {
        std::vector<Crossing> result;
        for (std::size_t round = 0; round < seconds.times.front().size(); ++round) {
            std::vector<std::pair<double, double>> differences;
            for (std::size_t i = 0; i < images.size(); ++i)
                differences.emplace_back(images[i].fragments, seconds.times[place(i, kernel)][round] -
                                                                  seconds.times[place(i, one_depth)][round]);
            result.push_back(crossing_of(differences));
        }
        return result;
    }
};

// Capturing the map's rays is not timed, since all kernels share it.
double seconds_of(const FirstLight& first, std::span<const rays::LightRays> tiles, const bench::Contender& contender,
                  const Image& image) {
    bench::Maps maps = bench::begin_maps(*contender.row, contender.values, first.input());
    for (const rays::LightRays& tile : tiles) bench::add(maps, tile);
    std::vector<float> answers(image.queries.queries.size());
    const bench::Stopwatch stopwatch;
    bench::finish(maps);
    bench::lookup(maps, image.queries.asked(), answers);
    return stopwatch.seconds();
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

Measured measure(const Context& context) {
    std::string requests;
    for (const Kernel& kernel : kernels) requests += (requests.empty() ? "" : ",") + request(kernel);
    std::vector<std::string> set{fmt::format("techniques=[{}]", requests)};
    if (context.quick) set.push_back("rays.resolution=256");
    const nlohmann::json document = context.document(flat, set);
    note_document(context, flat, document);
    const FirstLight first(document, context.data);
    const std::vector<rays::LightRays> tiles = first.tiles();
    Measured measured{make_images(first), {}};
    const base::ThreadLimit one_thread(1);
    std::vector<std::function<double()>> works;
    for (const Image& image : measured.images)
        for (const bench::Contender& contender : first.contenders)
            works.push_back([&] { return seconds_of(first, tiles, contender, image); });
    for (const auto& work : works) work();  // warms up
    measured.seconds = take_turns(works, {}, fixed_rounds);
    return measured;
}

Value median_of(const std::vector<Crossing>& crossings, double Crossing::*member, double scale) {
    std::vector<double> values;
    for (const Crossing& one : crossings) values.push_back(scale * one.*member);
    return claims::median_of(std::move(values));
}

void add_plot(const Measured& measured, PaperReport& report) {
    Plot plot{
        "pagot2004_equation6", "Selecting depths and looking them up", "fragments a cell", "ms", false, false, {}};
    for (std::size_t k = 0; k < kernels.size(); ++k) {
        Series series{title(kernels[k]), {}, true};
        for (std::size_t i = 0; i < measured.images.size(); ++i)
            series.points.emplace_back(measured.images[i].fragments,
                                       1e3 * measured.seconds.time(Measured::place(i, k)).value);
        plot.series.push_back(std::move(series));
    }
    report.plots.push_back(std::move(plot));
}

void add_crossing(const Measured& measured, std::size_t kernel, const char* place, const std::string& says,
                  PaperReport& report) {
    const std::vector<Crossing> crossings = measured.crossings(kernel);
    const double q = 9.0, r = 16.0 - 9.0, predicted = q / r;  // the paper prints 1.28
    const Value fragments = median_of(crossings, &Crossing::fragments, 1.0),
                selection = median_of(crossings, &Crossing::selection, 1e3),
                saved = median_of(crossings, &Crossing::saved, 1e3);
    const std::string parts =
        fmt::format("selection {} ms, {} ms saved by one fragment a cell", to_text(selection), to_text(saved));
    report.claims.push_back(
        {place,
         says,
         fragments.value < never ? fmt::format("beyond {} fragments a cell: {}", to_text(fragments), parts)
                                 : fmt::format("the lines do not cross: {}", parts),
         judge_ratio(predicted, fragments),
         fmt::format("The paper counts only texture fetches; comparing a depth has a cost too. Medians over {} rounds "
                     "that pass over all images and kernels. Lines that do not cross count as crossing at a million.",
                     crossings.size()),
         {fragments, selection, saved}});
}

void add_sides_of_the_point(const Measured& measured, PaperReport& report) {
    const Value same = measured.ratio(as_large_as_map, two_depths), most = measured.ratio(largest, two_depths);
    report.claims.push_back(
        {"section 6, equation 6",
         "with a screen as large as the map, visible fragments alone never make the 2-SM cheaper, since q is above r",
         fmt::format("{:.3g} fragments a cell take {} times as long with the 2-SM",
                     measured.images[as_large_as_map].fragments, to_text(same)),
         judge_less(exactly(1.0), same),
         "Selecting depths and looking them up, 2-SM with 3 x 3 over 1-SM with 4 x 4. The map's pixels that the camera "
         "sees are fewer than the screen's.",
         {same}});
    report.claims.push_back({"section 6, equation 5",
                             "as fragments grow, there is a point where PCF(k + r, 1) costs more than PCF(k, 2)",
                             fmt::format("{:.3g} fragments a cell take {} times as long with the 2-SM",
                                         measured.images[largest].fragments, to_text(most)),
                             judge_less(most, exactly(1.0)),
                             "The same times for the largest image. This asks only on which side of the point it lies.",
                             {most}});
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
    const Measured measured = measure(context);
    PaperReport& report = *context.report;
    add_plot(measured, report);
    add_crossing(measured, two_depths, "section 6, equations 5 and 6",
                 "2-SM with 3 x 3 beats 1-SM with 4 x 4 beyond 1.28 fragments a cell (q = 9, r = 7)", report);
    add_crossing(measured, three_depths, "section 6",
                 "the cost analysis of a 3-SM is similar: with 3 x 3 it beats 1-SM with 4 x 4 beyond 1.28 fragments a "
                 "cell",
                 report);
    add_sides_of_the_point(measured, report);
}

}  // namespace shadowbench::claims::pagot

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

constexpr double printed = 656.0 * 656.0 / (512.0 * 512.0);  // fragments a cell of the paper's screen and map
constexpr double fragments_a_cell[] = {0.25, 0.5, 1.0, printed, 2.0, 3.0, 4.5, 6.0};                   // of the images
constexpr std::size_t as_large_as_map = 2, as_printed = 3, largest = std::size(fragments_a_cell) - 1;  // their places
constexpr std::array<Kernel, 4> kernels{Kernel{1, 4}, Kernel{2, 3}, Kernel{3, 3}, Kernel{1, 3}};
constexpr std::size_t one_depth = 0, two_depths = 1, three_depths = 2, smaller_on_one = 3;  // their places
constexpr int trial_side = 256;                                         // pixels

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
    Value ratio(std::size_t image, std::size_t kernel, std::size_t over = one_depth) const {
        return seconds.ratio(place(image, kernel), place(image, over));
    }
    // "6 fragments a cell take 0.9 [0.88, 0.92] times as long with the 2-SM"
    std::string ratio_text(std::size_t image, std::size_t kernel) const {
        return fmt::format("{:.3g} fragments a cell take {} times as long with the {}-SM", images[image].fragments,
                           to_text(ratio(image, kernel)), kernels[kernel].n);
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

Image image_of(const FirstLight& first, const rays::Tracer& all, int side) {
    scene::Receivers receivers = first.scenario.receivers;
    receivers.resolution = {side, side};
    Image image;
    image.queries = bench::queries_of_points(bench::camera_points(receivers, all), receivers, first.light.view);
    const double cells = static_cast<double>(first.light.layout.width) * first.light.layout.height;
    image.fragments = static_cast<double>(image.queries.queries.size()) / cells;
    return image;
}

// Camera images of the scene with more and more fragments. Not all pixels see a surface inside the map, so they have
// more pixels than fragments.
std::vector<Image> make_images(const FirstLight& first) {
    const rays::Tracer all(first.scenario.scene, false);
    const double of_trial = image_of(first, all, trial_side).fragments;
    std::vector<Image> images;
    for (const double fragments : fragments_a_cell) {
        const double side = trial_side * std::sqrt(fragments / of_trial);
        images.push_back(image_of(first, all, static_cast<int>(std::lround(side))));
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

// What is known of the point from which on a kernel on several depths costs less.
struct Point {
    Value fragments, selection, saved;  // a cell; ms; ms a fragment a cell

    Point(const Measured& measured, std::size_t kernel) {
        const std::vector<Crossing> crossings = measured.crossings(kernel);
        fragments = crossing_within(crossings, measured.images[largest].fragments);
        selection = median_of(crossings, &Crossing::selection, 1e3);
        saved = median_of(crossings, &Crossing::saved, 1e3);
    }
    // "beyond 2.1 [2, 2.2] fragments a cell"
    std::string where() const {
        if (fragments.low >= never) return "at no number of fragments";
        if (fragments.high < never) return fmt::format("beyond {} fragments a cell", to_text(fragments));
        return fmt::format("beyond {:.3g} fragments a cell or more, which no image has", fragments.low);
    }
    std::string text() const {
        return fmt::format("{}: selection {} ms, {} ms saved by one fragment a cell", where(), to_text(selection),
                           to_text(saved));
    }
    std::vector<Value> values() const { return {fragments, selection, saved}; }
};

constexpr double q = 9.0;  // samples that the selection reads a cell

// The paper's cost of a scene, in samples a cell: equation 4.
double samples(const Kernel& kernel, double fragments) {
    return (kernel.n > 1 ? q : 0.0) + fragments * kernel.side * kernel.side;
}

// Whether a kernel takes fewer samples than that on one depth.
bool saves(std::size_t kernel, double fragments) {
    return samples(kernels[kernel], fragments) < samples(kernels[one_depth], fragments);
}

constexpr const char* of_samples =
    "The paper counts samples, \"disregarding logical tests and latency times\", and leaves \"implementations directed "
    "towards performance evaluation\" to future work (section 7). So counted, this is arithmetic. The times of one thread "
    "stand beside it, and are not judged.";

void add_points(const Measured& measured, PaperReport& report) {
    const Point of_two(measured, two_depths), of_three(measured, three_depths);
    const double r = 16.0 - 9.0, point = q / r;  // the paper prints 1.28
    const bool exact = !saves(two_depths, 0.999 * point) && saves(two_depths, 1.001 * point);
    report.claims.push_back(
        {"section 6, equations 5 and 6",
         "2-SM with 3 x 3 beats 1-SM with 4 x 4 beyond 1.28 fragments a cell (q = 9, r = 7)",
         fmt::format("by samples beyond {:.3g}; by times {}", point, of_two.text()), by_construction(exact),
         fmt::format("{} In times the point is where a line through the differences is 0, over {} rounds that pass over "
                     "all images and kernels. If it is not inside the images, it is only known to lie beyond them.",
                     of_samples, measured.seconds.times.front().size()),
         of_two.values()});
    const Value two = measured.ratio(largest, two_depths), three = measured.ratio(largest, three_depths);
    std::vector<Value> values = of_three.values();
    values.push_back(three);
    report.claims.push_back(
        {"section 6", "the cost analysis of a 3-SM is similar: there is a point where 1-SM with 4 x 4 costs more",
         fmt::format("by samples beyond {:.3g}; by times {}; {}", point, of_three.text(),
                     measured.ratio_text(largest, three_depths)),
         by_construction(saves(three_depths, 1.001 * point)),
         "Equation 4 is that of both. Counted in samples, as for the 2-SM; the times are not judged.",
         std::move(values)});
    report.claims.push_back(
        {"section 6, equation 5", "as fragments grow, there is a point where PCF(k + r, 1) costs more than PCF(k, 2)",
         fmt::format("by times {}; {}", of_two.where(), measured.ratio_text(largest, two_depths)),
         by_construction(saves(two_depths, 2.0 * point)),
         "PCF(16, 1) and PCF(9, 2). Counted in samples, each fragment saves r. The times are not judged.",
         {of_two.fragments, two}});
}

void add_screens(const Measured& measured, PaperReport& report) {
    const Value same = measured.ratio(as_large_as_map, two_depths), larger = measured.ratio(as_printed, two_depths);
    report.claims.push_back(
        {"section 6, equation 6",
         "with a screen as large as the map, visible fragments alone never make the 2-SM cheaper, since q is above r",
         "by times " + measured.ratio_text(as_large_as_map, two_depths), by_construction(!saves(two_depths, 1.0)),
         "Selecting depths and looking them up, 2-SM with 3 x 3 over 1-SM with 4 x 4. Each pixel of such a screen is "
         "a fragment, so there is one a cell. Counted in samples; the times are not judged.",
         {same}});
    report.claims.push_back(
        {"section 6, equation 6",
         "for a map of 512 x 512 cells a screen of 656 x 656 pixels suffices to make the 2-SM cheaper",
         "by times " + measured.ratio_text(as_printed, two_depths), by_construction(saves(two_depths, printed)),
         "656 is 1.28 times 512, along each side: these are 1.64 fragments a cell, more than the q / r that equation 6 "
         "asks for. Counted in samples; the times are not judged.",
         {larger}});
    const Value small = measured.ratio(as_large_as_map, two_depths, smaller_on_one);
    report.claims.push_back(
        {"section 1", "multiple depths reduce aliasing with a small increase in cost",
         fmt::format("{:.3g} fragments a cell, selecting depths and looking them up, take {} times as long with the 2-SM "
                     "as with the same kernel on one depth",
                     measured.images[as_large_as_map].fragments, to_text(small)),
         not_comparable(),
         "3 x 3 cells. Aliasing is judged in a row of its own. How small the increase is, the paper does not say: it has "
         "no times. The test by itself is judged in section 6.",
         {small}});
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

Value crossing_within(const std::vector<Crossing>& crossings, double most) {
    const Value found = median_of(crossings, &Crossing::fragments, 1.0);
    if (found.low >= never || found.high <= most) return found;
    return {found.value, std::min(found.low, most), never};
}

void crossing(const Context& context) {
    const Measured measured = measure(context);
    PaperReport& report = *context.report;
    add_plot(measured, report);
    add_points(measured, report);
    add_screens(measured, report);
}

}  // namespace shadowbench::claims::pagot

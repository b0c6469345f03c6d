// Lokovic and Veach, Deep Shadow Maps, 2000: the errors of sections 2 and 4.
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/random.h"
#include "claims/fit.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_cover.h"

namespace shadowbench::claims::lokovic {
namespace {

// The errors over numbers of samples, once for each seed.
struct Experiment {
    std::string name;
    std::vector<int> samples;
    std::vector<std::vector<double>> errors;  // [seed][number of samples]

    Value error(std::size_t number) const {
        std::vector<double> sample;
        for (const std::vector<double>& of_seed : errors) sample.push_back(of_seed[number]);
        return mean_of(sample);
    }
    // The mean over seeds of a number that is read off the law fitted to the errors of each.
    Value of_laws(const std::function<double(const PowerLaw&)>& read) const {
        std::vector<double> sample;
        for (const std::vector<double>& of_seed : errors) {
            std::vector<std::pair<double, double>> points;
            for (std::size_t i = 0; i < samples.size(); ++i) points.emplace_back(samples[i], of_seed[i]);
            sample.push_back(read(fit_power(points)));
        }
        return mean_of(sample);
    }
    Value exponent() const {
        return of_laws([](const PowerLaw& law) { return law.exponent; });
    }
    Value samples_for(double error) const {
        return of_laws([error](const PowerLaw& law) { return std::pow(error / law.factor, 1.0 / law.exponent); });
    }
};

constexpr std::uint64_t seeds = 8;
constexpr int edge_samples[] = {4, 16, 36, 64, 100, 144, 196, 256, 400, 576};
constexpr int fur_samples[] = {16, 64, 144, 256, 576, 1024, 1600, 2500, 3600};
constexpr std::size_t edge_at_144 = 5, fur_at_2500 = 7;  // the paper's numbers in these lists, or the nearest

Experiment at_silhouette(int lookups, const char* placement) {
    Experiment experiment{"one silhouette", {std::begin(edge_samples), std::end(edge_samples)}, {}};
    const Cover cover = silhouette(256);
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        std::vector<double>& errors = experiment.errors.emplace_back();
        for (const int n : experiment.samples)
            errors.push_back(
                filtering_error(cover, 128, n, lookups, base::hash(seed, static_cast<std::uint64_t>(n)), placement));
    }
    return experiment;
}

Experiment in_fur(int lookups, const char* placement, const std::vector<int>& samples) {
    Experiment experiment{"fur", samples, {}};
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Cover cover = fur(1024, seed);
        std::vector<double>& errors = experiment.errors.emplace_back();
        for (const int n : experiment.samples)
            errors.push_back(
                filtering_error(cover, 512, n, lookups, base::hash(seed, static_cast<std::uint64_t>(n)), placement));
    }
    return experiment;
}

void plot_errors(const Experiment& edge, const Experiment& hair, PaperReport& report) {
    Plot plot{
        "lokovic2000_section2", "Section 2: error of filtering N jittered samples", "N", "error rms", true, true, {}};
    for (const Experiment* experiment : {&edge, &hair}) {
        Series measured{experiment->name, {}, false};
        for (std::size_t i = 0; i < experiment->samples.size(); ++i)
            measured.points.emplace_back(experiment->samples[i], experiment->error(i).value);
        plot.series.push_back(std::move(measured));
    }
    Series edge_theory{"N^(-3/4) / sqrt 6", {}, true}, fur_theory{"N^(-1/2) / 2", {}, true};
    for (const double n : {4.0, 576.0}) edge_theory.points.emplace_back(n, std::pow(n, -0.75) / std::sqrt(6.0));
    for (const double n : {16.0, 3600.0}) fur_theory.points.emplace_back(n, 0.5 / std::sqrt(n));
    plot.series.push_back(std::move(edge_theory));
    plot.series.push_back(std::move(fur_theory));
    report.plots.push_back(std::move(plot));
}

std::string whole(const Value& value) {
    return fmt::format("{:.0f} [{:.0f}, {:.0f}]", value.value, value.low, value.high);
}

}  // namespace

void noise(const Context& context) {
    PaperReport& report = *context.report;
    const int lookups = context.quick ? 500 : 2000;
    const Experiment edge = at_silhouette(lookups, "jittered"), random_edge = at_silhouette(lookups, "uniform"),
                     hair = in_fur(lookups, "jittered", {std::begin(fur_samples), std::end(fur_samples)}),
                     random_hair = in_fur(lookups, "uniform", {fur_samples[fur_at_2500]});
    plot_errors(edge, hair, report);

    const Value edge_exponent = edge.exponent(), hair_exponent = hair.exponent();
    report.claims.push_back({"section 2, figure 2a",
                             "at an isolated silhouette the expected error of N jittered samples is O(N^(-3/4))",
                             fmt::format("as N^{}", to_text(edge_exponent)),
                             judge_exponent(-0.75, edge_exponent),
                             "A law and not only a bound: the footnote derives it with its constant. A horizontal "
                             "silhouette at a random height; only the parts that it crosses are in doubt.",
                             {edge_exponent}});
    const Value random_exponent = random_edge.exponent(),
                gained = edge.error(edge_at_144) / random_edge.error(edge_at_144);
    report.claims.push_back({"section 2",
                             "near large silhouettes stratified samples are much better than unstratified ones, whose "
                             "expected error is O(N^(-1/2))",
                             fmt::format("unstratified as N^{}; the error of 144 stratified samples is {} of theirs",
                                         to_text(random_exponent), to_text(gained)),
                             both(judge_exponent(-0.5, random_exponent), judge_much_less(gained, exactly(1.0))),
                             "By both halves; the second at about the 140 samples that the paper names.",
                             {random_exponent, gained}});
    const Value hair_gained = hair.error(fur_at_2500) / random_hair.error(0);
    report.claims.push_back({"section 2, figure 2b",
                             "in hair or fur it is O(N^(-1/2)): stratified samples are no better than others",
                             fmt::format("as N^{}; the error of 2,500 stratified samples is {} of that of unstratified "
                                         "ones",
                                         to_text(hair_exponent), to_text(hair_gained)),
                             both(judge_exponent(-0.5, hair_exponent), judge_alike(hair_gained, exactly(1.0))),
                             "Hairs one cell wide cover half of the map and cross all parts of the region.",
                             {hair_exponent, hair_gained}});
    const Value edge_needs = edge.samples_for(0.01), hair_needs = hair.samples_for(0.01);
    report.claims.push_back({"section 2",
                             "an expected error of 1 % takes about 140 samples at an isolated silhouette",
                             whole(edge_needs) + " samples",
                             judge_ratio(140.0, edge_needs),
                             "From the law that is fitted to the errors from 4 to 576 samples. The paper's constant is "
                             "1 / sqrt 6.",
                             {edge_needs}});
    report.claims.push_back({"section 2",
                             "it takes 2,500 samples where dense fur covers 50 %",
                             whole(hair_needs) + " samples",
                             judge_ratio(2500.0, hair_needs),
                             "From the law that is fitted to the errors from 16 to 3,600 samples. The paper's constant "
                             "is 1 / 2.",
                             {hair_needs}});
    std::vector<double> sample, of_centres;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Cover cover = fur(2048, seed);
        sample.push_back(deep_error(cover, 250, 10.0, lookups, seed));
        of_centres.push_back(deep_error(cover, 250, 10.0, lookups, seed, "pixels"));
    }
    const Value deep = mean_of(sample), by_centres = mean_of(of_centres);
    report.claims.push_back(
        {"section 4",
         "10 pixels of a deep map with 250 samples a pixel give an expected error of 1 % in dense "
         "hair",
         fmt::format("error rms {}, and {} with whole pixels by their centres", to_text(deep), to_text(by_centres)),
         in_readings({judge_ratio(0.01, deep), judge_ratio(0.01, by_centres)}),
         "Squares of 10 pixels' area at random places; all hairs lie at one depth. The map is "
         "compressed as by default. Two readings of the filter: whole pixels are 9 to 16, and not "
         "the square that is asked for.",
         {deep, by_centres}});
}

}  // namespace shadowbench::claims::lokovic

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/table.h"
#include "results/differences.h"
#include "results/report.h"
#include "results/settled.h"
#include "results/table_lines.h"

namespace shadowbench::results {
namespace {

constexpr std::size_t most_rivals = 3;   // named
constexpr std::size_t most_spoken = 4;   // lights that get sentences of their own
constexpr std::size_t most_counted = 3;  // techniques that are counted by name, of many lights

constexpr double far_apart = 2.0;        // ratio of errors that a result should be able to tell apart
constexpr std::size_t enough_seeds = 5;  // further ones, that mostly do so
constexpr std::size_t most_seeds = 64;   // that a scenario may ask for
constexpr double noisy_truth =
    1.0 / 3;                       // standard error of the truth, as a share of the error, above which it is named
constexpr double truth_sds = 4.0;  // a difference below so many standard deviations of the truth is its noise

// The least of some choices, and those of which the intervals do not say that they are more.
struct Least {
    std::size_t best = 0;
    std::vector<std::size_t> ties, undecided;
};

// `difference` takes a < b.
template <class Value, class Difference>
Least least_of(const std::vector<std::size_t>& among, const Value& value, const Difference& difference) {
    Least least;
    least.best = *std::min_element(among.begin(), among.end(),
                                   [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
    for (const std::size_t other : among) {
        if (other == least.best) continue;
        metrics::Interval more = difference(std::min(other, least.best), std::max(other, least.best));
        if (other > least.best) more = {-more.high, -more.low};
        if (more.low == 0.0 && more.high == 0.0)
            least.ties.push_back(other);
        else if (more.low <= 0.0)
            least.undecided.push_back(other);
    }
    return least;
}

std::vector<std::size_t> all_of(const Least& least) {
    std::vector<std::size_t> all{least.best};
    all.insert(all.end(), least.ties.begin(), least.ties.end());
    all.insert(all.end(), least.undecided.begin(), least.undecided.end());
    std::sort(all.begin(), all.end());
    return all;
}

// Names cells, each with its error when it is first named.
class Speaker {
public:
    // Without an error where it stands beside the name, or is that of a tie.
    std::string name(const Cell& cell, bool with_error = true) {
        const bool is_new = named_.insert(&cell).second;
        if (!is_new || !with_error) return title(cell);
        return fmt::format("{} at rms {}", title(cell), base::error_text(cell.lookup->norms.rms));
    }

    // ", a tie with pcf, undecided against deep at rms 0.1"; empty if the least is certain.
    std::string rivals(const Differences& choices, const Least& least, bool of_errors = false) {
        std::string text;
        if (!least.ties.empty()) text += ", a tie with " + names(choices, least.ties, !of_errors);
        if (!least.undecided.empty()) text += ", undecided against " + names(choices, least.undecided, true);
        return text;
    }

private:
    std::string names(const Differences& choices, const std::vector<std::size_t>& some, bool with_error) {
        std::string text;
        for (std::size_t i = 0; i < std::min(some.size(), most_rivals); ++i)
            text += (i ? ", " : "") + name(choices.cell(some[i]), with_error);
        if (some.size() > most_rivals) text += fmt::format(" and {} more", some.size() - most_rivals);
        return text;
    }

    std::set<const Cell*> named_;
};

// What would tell the smallest error from one that is far larger as measured, and still undecided; empty: nothing is.
std::string advice(const Differences& choices, const Least& least) {
    const auto rms = [&](std::size_t i) { return choices.cell(i).lookup->norms.rms; };
    const auto farthest = std::max_element(least.undecided.begin(), least.undecided.end(),
                                           [&](std::size_t a, std::size_t b) { return rms(a) < rms(b); });
    if (farthest == least.undecided.end() || !(rms(*farthest) > far_apart * rms(least.best))) return "";
    const Cell &best = choices.cell(least.best), &other = choices.cell(*farthest);
    const std::size_t seeds = best.over_seeds.size();
    const double difference = std::abs(rms(*farthest) * rms(*farthest) - rms(least.best) * rms(least.best));
    const bool noise = difference < truth_sds * (best.lookup->truth_sd + other.lookup->truth_sd);
    const bool random = seeds > 0 || !best.lookup->interval || !best.lookup->interval->covers_rays;
    const std::string apart = fmt::format("errors that differ by more than a factor of {}", far_apart);
    if (noise || !random)
        return fmt::format(" The truth is too noisy to decide between {}: ask for more reference.samples_per_pixel.",
                           apart);
    if (seeds == 0)
        return fmt::format(" One seed of the rays cannot decide between {}: ask for reference.spread_seeds {}.", apart,
                           enough_seeds);
    if (seeds >= most_seeds) return "";
    return fmt::format(" reference.spread_seeds {} are too few to decide between {}: ask for {}.", seeds, apart,
                       seeds < enough_seeds ? enough_seeds : std::min(2 * seeds, most_seeds));
}

// The cheapest of the cells that may have the smallest error.
struct Cheapest {
    std::vector<std::size_t> among;    // numbers of cells of the light
    std::string error, bytes, lookup;  // in words
    std::string advice;                // a sentence, or empty
    double least_error = 0.0;          // rms
    std::string bytes_name;            // who takes the fewest bytes; empty if that is undecided or a tie
};

std::string fewest_bytes(const LightResult& light, const std::vector<std::size_t>& among, Speaker& speaker,
                         std::string& name) {
    std::vector<std::size_t> stored;
    for (const std::size_t cell : among)
        if (light.cells[cell].bytes > 0) stored.push_back(cell);
    if (stored.empty()) return "none stores a map";
    const Differences choices(light, stored);
    std::vector<std::size_t> numbers(stored.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
    const Least least = least_of(
        numbers, [&](std::size_t i) { return choices.mean_bytes(i); },
        [&](std::size_t a, std::size_t b) { return choices.bytes(a, b); });
    const Cell& best = choices.cell(least.best);
    if (least.ties.empty() && least.undecided.empty()) name = title(best);
    const std::string who = speaker.name(best);
    return fmt::format("{} takes the fewest bytes ({}{})", who, base::bytes_text(best.bytes),
                       speaker.rivals(choices, least));
}

std::string fastest_lookup(const LightResult& light, const std::vector<std::size_t>& among, Speaker& speaker) {
    std::vector<std::size_t> timed;
    for (const std::size_t cell : among)
        if (light.cells[cell].times) timed.push_back(cell);
    if (timed.empty()) return "";
    if (timed.size() > 1 && !times_count(light))
        return settling(light).disturbed() ? "which answers fastest is undecided, since the machine was not quiet"
                                           : "which answers fastest is undecided, since the repetitions are too few";
    const Differences choices(light, timed);
    std::vector<std::size_t> numbers(timed.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
    const Least least = least_of(
        numbers, [&](std::size_t i) { return choices.cell(i).times->random_order.ns.median; },
        [&](std::size_t a, std::size_t b) { return choices.times(a, b); });
    const Cell& best = choices.cell(least.best);
    const std::string who = speaker.name(best);
    return fmt::format("{} answers fastest ({} ns{})", who, time_text(best.times->random_order.ns, light),
                       speaker.rivals(choices, least));
}

// Empty `among`: no cell has an error.
Cheapest cheapest_of(const LightResult& light) {
    Cheapest found;
    const std::vector<std::size_t> cells = comparable(light, false);
    if (cells.empty()) return found;
    const Differences choices(light, cells);
    std::vector<std::size_t> numbers(cells.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
    const Least least = least_of(
        numbers, [&](std::size_t i) { return choices.cell(i).lookup->norms.rms; },
        [&](std::size_t a, std::size_t b) { return choices.errors(a, b); });
    for (const std::size_t i : all_of(least)) found.among.push_back(cells[i]);
    Speaker speaker;
    const Cell& best = choices.cell(least.best);
    found.least_error = best.lookup->norms.rms;
    const std::string who = speaker.name(best, false);
    found.error = fmt::format("{} has the smallest error (rms {}{})", who, base::error_text(best.lookup->norms.rms),
                              speaker.rivals(choices, least, true));
    found.bytes = fewest_bytes(light, found.among, speaker, found.bytes_name);
    found.lookup = fastest_lookup(light, found.among, speaker);
    found.advice = advice(choices, least);
    return found;
}

// What an inexact truth adds to the errors, unless that is little beside them.
std::string truth_text(const LightResult& light, double least_error) {
    const double noise = light.reference.error_rms;
    if (!(noise > noisy_truth * least_error)) return "";
    return fmt::format(
        " The truth itself has a standard error of {:.2g}, which each error includes: an exact one would "
        "be about sqrt(error^2 - {:.2g}^2).",
        noise, noise);
}

std::string sentences(const LightResult& light) {
    if (sees_nothing(light)) return "nothing casts a shadow, so there is nothing to choose.";
    const Cheapest found = cheapest_of(light);
    if (found.among.empty()) return "no technique has an error to compare.";
    if (found.among.size() == 1) {
        const Cell& cell = light.cells[found.among[0]];
        return fmt::format("{}. It takes {}{}.", found.error, base::bytes_text(cell.bytes),
                           cell.times ? " and " + time_text(cell.times->random_order.ns, light) + " ns a lookup" : "") +
               truth_text(light, found.least_error);
    }
    return fmt::format("{}. Of these, {}{}.{}", found.error, found.bytes,
                       found.lookup.empty() ? "" : (found.lookup[0] == 'w' ? "; " : ", and ") + found.lookup,
                       found.advice) +
           truth_text(light, found.least_error);
}

// In how many lights a technique takes the fewest bytes of those that may have the smallest error.
std::string tally(const std::vector<const LightResult*>& lights) {
    std::map<std::string, std::size_t> wins;
    std::size_t open = 0, judged = 0;
    for (const LightResult* light : lights) {
        if (sees_nothing(*light)) continue;
        const Cheapest found = cheapest_of(*light);
        if (found.among.empty()) continue;
        ++judged;
        found.bytes_name.empty() ? ++open : ++wins[found.bytes_name];
    }
    std::vector<std::pair<std::string, std::size_t>> sorted(wins.begin(), wins.end());
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string text =
        fmt::format("The fewest bytes of those that may have the smallest error, in {} tables: ", judged);
    std::size_t others = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i < most_counted)
            text += fmt::format("{}{} in {}", i ? ", " : "", sorted[i].first, sorted[i].second);
        else
            others += sorted[i].second;
    }
    if (others > 0) text += fmt::format(", others in {}", others);
    if (open > 0) text += fmt::format("{}undecided or a tie in {}", sorted.empty() ? "" : ", ", open);
    return text + ".\n";
}

}  // namespace

std::string meaning_text(const Result& result, const TableStyle& style) {
    std::vector<const LightResult*> lights;
    std::string text;
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights) {
            lights.push_back(&light);
            if (lights.size() > most_spoken) continue;
            std::string place = "light " + light.name;
            for (const document::Setting& setting : variant.settings)
                place += fmt::format(", {} = {}", setting.pointer, setting.value);
            text += fmt::format("{}: {}\n", place, sentences(light));
        }
    return base::wrapped(lights.size() > most_spoken ? tally(lights) : text, style.width);
}

}  // namespace shadowbench::results

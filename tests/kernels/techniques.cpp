// Every row of the registry: building its map from light rays, and lookups in it.
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "base/random.h"
#include "kernels/inputs.h"
#include "kernels/judged.h"
#include "kernels/kernel.h"

namespace shadowbench::kernels {
namespace {

constexpr std::size_t side = 48;        // of the grid of lookups
constexpr std::size_t traced_side = 8;  // of a technique that reads no map: shadow rays take microseconds
constexpr std::size_t most_lines = std::size_t{1} << 20;

enum class Order { image, random };

Subject prepare_build(const Setting& setting) {
    const SharedJudged judged = judge(setting);
    Subject subject;
    subject.exact = judged->exact();
    subject.exact.lookup_error.reset();
    subject.pass = [judged] { benchmark::DoNotOptimize(judged->build().parts.data()); };
    if (bench::cells(judged->maps()) == techniques::Cells::none) return subject;  // builds nothing from the rays
    subject.vertices = static_cast<double>(segments_of(judged->tiles()));
    std::vector<const void*> lines;
    append_lines(judged->tiles(), lines);
    subject.floor = floor_of(std::move(lines));
    return subject;
}

std::vector<techniques::Query> shuffled(std::vector<techniques::Query> queries) {
    base::Random random(17);
    for (std::size_t i = queries.size(); i > 1; --i) std::swap(queries[i - 1], queries[random.below(i)]);
    return queries;
}

Subject prepare_lookup(const Setting& setting, Order order) {
    const SharedJudged judged = judge(setting);
    const bench::Maps& maps = judged->maps();
    auto queries = std::make_shared<std::vector<techniques::Query>>(judged->queries(side));
    std::vector<const void*> lines;
    std::size_t covered = bench::touched(maps, *queries, most_lines, lines);
    if (lines.empty()) *queries = judged->queries(traced_side);
    if (order == Order::random) {
        *queries = shuffled(std::move(*queries));
        lines.clear();
        covered = bench::touched(maps, *queries, most_lines, lines);
    }
    const auto answers = std::make_shared<std::vector<float>>(queries->size() * maps.channels());

    Subject subject;
    subject.exact = judged->exact();
    subject.lookups = static_cast<double>(queries->size());
    subject.pass = [judged, queries, answers] {
        bench::lookup(judged->maps(), *queries, *answers);
        benchmark::DoNotOptimize(answers->data());
    };
    judged->check_answers(*queries, subject.pass, *answers);
    if (lines.empty()) return subject;
    subject.floor_share = static_cast<double>(covered) / subject.lookups;
    subject.floor = floor_of(std::move(lines));
    return subject;
}

// Values beside the defaults, of whichever row has such a parameter.
const std::multimap<std::string, double> other_values = {
    {"tolerance", 0.005}, {"tolerance", 0.02}, {"nodes", 4.0}, {"nodes", 16.0}};

std::vector<Setting> settings_of(const techniques::Technique& row) {
    std::vector<Setting> settings;
    for (const auto& [map, samples] : {std::pair{32, 16}, {64, 9}, {64, 16}})
        settings.push_back({&row, {}, {}, map, samples});
    for (const techniques::Parameter& parameter : row.parameters) {
        const auto [first, last] = other_values.equal_range(parameter.name);
        for (auto value = first; value != last; ++value)
            settings.push_back({&row, parameter.name, value->second, 64, 16});
    }
    return settings;
}

void add(Kernels& kernels, const Setting& setting) {
    const std::string name = name_of(setting);
    kernels.push_back({"build/" + name, [=] { return prepare_build(setting); }});
    kernels.push_back({"lookup/" + name + "/image", [=] { return prepare_lookup(setting, Order::image); }});
    kernels.push_back({"lookup/" + name + "/random", [=] { return prepare_lookup(setting, Order::random); }});
}

}  // namespace

void add_technique_kernels(Kernels& kernels) {
    for (const techniques::Technique& row : techniques::all())
        for (const Setting& setting : settings_of(row)) add(kernels, setting);
}

}  // namespace shadowbench::kernels

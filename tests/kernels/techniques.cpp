// Every row of the registry: building its map from light rays, and lookups in it.
#include <map>
#include <memory>
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

constexpr std::size_t side = 48;        // side of the grid of lookups
constexpr std::size_t traced_side = 8;  // of a technique that reads no map: shadow rays take microseconds
// A processor learns the branches of a few thousand lookups if they repeat; a deep shadow map then answers in random
// order in half the time. With this many batches there are more lookups than it can remember.
constexpr std::size_t batch_count = 32;
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

void shuffle(std::vector<techniques::Query>& queries) {
    base::Random random(17);
    for (std::size_t i = queries.size(); i > 1; --i) std::swap(queries[i - 1], queries[random.below(i)]);
}

// The lookups of successive passes.
struct Batches {
    std::vector<std::vector<techniques::Query>> queries;
    std::size_t now = 0;
    std::vector<float> answers;
};

std::shared_ptr<Batches> make_batches(const Judged& judged, std::size_t grid, Order order) {
    const auto batches = std::make_shared<Batches>();
    for (std::size_t b = 0; b < batch_count; ++b) {
        batches->queries.push_back(judged.queries(grid, 5 + b));
        if (order == Order::random) shuffle(batches->queries.back());
    }
    batches->answers.resize(batches->queries[0].size() * judged.maps().channels());
    return batches;
}

Subject prepare_lookup(const Setting& setting, Order order) {
    const SharedJudged judged = judge(setting);
    const bool traced = bench::cells(judged->maps()) == techniques::Cells::none;
    const std::shared_ptr<Batches> batches = make_batches(*judged, traced ? traced_side : side, order);
    const auto look_up = [judged, batches](std::size_t batch) {
        bench::lookup(judged->maps(), batches->queries[batch], batches->answers);
        benchmark::DoNotOptimize(batches->answers.data());
    };
    for (std::size_t b = 0; b < batch_count; ++b)
        judged->check_answers(
            batches->queries[b], [&] { look_up(b); }, batches->answers);

    Subject subject;
    subject.exact = judged->exact();
    subject.lookups = static_cast<double>(batches->queries[0].size());
    subject.pass = [batches, look_up] {
        look_up(batches->now);
        batches->now = (batches->now + 1) % batch_count;
    };
    std::vector<const void*> lines;
    double covered = 0.0;
    for (const std::vector<techniques::Query>& queries : batches->queries)
        if (lines.size() < most_lines)
            covered += static_cast<double>(bench::touched(judged->maps(), queries, most_lines, lines));
    if (lines.empty()) return subject;
    subject.floor_share = covered / subject.lookups;
    subject.floor = floor_of(std::move(lines));
    return subject;
}

// Values besides the defaults, for every row that has the parameter.
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

#include "recommend/space.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "techniques/trades.h"

namespace shadowbench::recommend {
namespace {

using techniques::ParameterValues;
using techniques::Technique;
using techniques::Trade;

constexpr int least_side = 16, most_side = 4096;
constexpr int finest_steps = 8;  // an octave
constexpr int sample_sides[] = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16};
constexpr int sample_stride = 3;
constexpr double exact = 1e-6;  // the bound on the curve error of what stores every ray's function

// Multiples of the ratio of sides, in this many steps an octave around the own one; empty if two of them coincide.
std::vector<int> multiples(int own, int least, int most, int steps) {
    std::vector<int> found;
    const auto at = [&](int i) {
        return static_cast<int>(std::lround(own * std::exp2(static_cast<double>(i) / steps)));
    };
    int first = 0;
    while (own * std::exp2(static_cast<double>(first) / steps - 1.0) >= least) first -= steps;  // whole octaves
    for (int i = first; at(i) <= most || i == 0; ++i) {
        if (!found.empty() && found.back() == at(i)) return {};
        found.push_back(at(i));
    }
    return found;
}

struct Resolutions {
    std::vector<base::Vec2i> sides;
    int steps_an_octave = 1;
};

Resolutions resolutions_of(base::Vec2i own) {
    const int common = std::gcd(own.x, own.y);
    const base::Vec2i ratio(own.x / common, own.y / common);
    const int larger = std::max(ratio.x, ratio.y);
    const int least = (least_side + larger - 1) / larger, most = most_side / larger;
    Resolutions found{{}, finest_steps};
    std::vector<int> counts = multiples(common, least, most, finest_steps);
    while (counts.empty()) counts = multiples(common, least, most, found.steps_an_octave /= 2);
    for (const int count : counts) found.sides.emplace_back(ratio.x * count, ratio.y * count);
    return found;
}

std::string text_of(base::Vec2i resolution) {
    return resolution.x == resolution.y ? fmt::format("{}", resolution.x)
                                        : fmt::format("[{},{}]", resolution.x, resolution.y);
}

base::Vec2i resolution_of(const nlohmann::json& value) {
    return value.is_array() ? base::Vec2i(value.at(0).get<int>(), value.at(1).get<int>())
                            : base::Vec2i(value.get<int>(), value.get<int>());
}

std::string text_of(const ParameterValues::Value& value) {
    const double* number = std::get_if<double>(&value);
    return number ? fmt::format("{:g}", *number) : std::get<std::string>(value);
}

// Every combination of the choices, the first of each first.
std::vector<ParameterValues> combinations(const Technique& row) {
    std::vector<ParameterValues> all{techniques::read_parameters(row.parameters, nlohmann::json::object(), "")};
    for (const Trade& trade : row.traits.trades) {
        if (trade.scale != Trade::Scale::choice) continue;
        std::vector<ParameterValues> more;
        for (const ParameterValues& values : all)
            for (const ParameterValues::Value& choice : trade.choices) {
                more.push_back(values);
                more.back().values[trade.parameter] = choice;
            }
        all = std::move(more);
    }
    return all;
}

// The words that answers depend on.
std::string words_of_answers(const Technique& row, const ParameterValues& values) {
    std::string words;
    for (const Trade& trade : row.traits.trades)
        if (trade.scale == Trade::Scale::choice && !trade.only_layout)
            words += text_of(values.values.at(trade.parameter)) + ' ';
    return words;
}

// A name on the command line, not in a file.
void refuse_unknown(const std::string& id) {
    try {
        techniques::find(id, "--only " + id);
    } catch (const base::Error& unknown) {
        throw base::Error(base::ErrorCode::usage, unknown.where(), unknown.message());
    }
}

}  // namespace

std::vector<Axis> Space::Rays::axes() const {
    Axis first{"resolution", {}, resolution_stride}, second{"samples_per_pixel", {}, sample_stride};
    for (const base::Vec2i& resolution : resolutions) first.values.push_back(text_of(resolution));
    for (const int count : samples) second.values.push_back(fmt::format("{}", count));
    return {first, second};
}

Space::Space(const scene::Scenario& scenario, std::span<const std::string> only)
    : own_(scenario.rays.resolution), own_samples_(scenario.rays.samples_per_pixel) {
    const bool fixed = scenario.scene.deep_image.has_value();
    const Rays own{{own_}, {own_samples_}};
    Rays explored = own;
    if (!fixed) {
        const Resolutions found = resolutions_of(own_);
        explored = {found.sides, {}, found.steps_an_octave, sample_stride};
        for (const int side : sample_sides) explored.samples.push_back(side * side);
    }
    for (const std::string& id : only) refuse_unknown(id);
    for (const Technique& row : techniques::all()) {
        if (!only.empty() && std::count(only.begin(), only.end(), row.id) == 0) continue;
        if (row.traits.traces && fixed) continue;  // there is no scene to trace
        add_families(row, row.traits.traces ? own : explored);
    }
    if (families_.empty())
        throw base::Error(base::ErrorCode::usage, "--only",
                          "a deep image has no scene that this technique could trace");
}

void Space::add_families(const Technique& row, const Rays& rays) {
    for (ParameterValues& values : combinations(row)) {
        Family family{row.id, row.id, rays.axes(), {}};
        Choice choice{&row, std::move(values), rays};
        family.mapless = row.traits.traces;
        for (const Trade& trade : row.traits.trades) {
            const std::vector<ParameterValues::Value> steps = techniques::values_of(trade, row.parameters);
            if (trade.scale == Trade::Scale::choice) {
                const ParameterValues::Value& word = choice.values.at(trade.parameter);
                family.words.push_back(
                    {trade.parameter, std::visit([](const auto& v) { return nlohmann::json(v).dump(); }, word)});
                if (steps.size() > 1)
                    family.name += fmt::format(" {}={}", trade.parameter, text_of(choice.values.at(trade.parameter)));
                continue;
            }
            Axis axis{trade.parameter, {}, techniques::coarse_stride(trade, steps.size())};
            for (const ParameterValues::Value& step : steps) axis.values.push_back(text_of(step));
            family.axes.push_back(std::move(axis));
            choice.numbers.emplace_back(trade.parameter, steps);
        }
        family.faithful = family.axes.size() > 2 && !row.traits.traces && !row.promises.opaque_only &&
                          !row.promises.approximate;
        if (!scout_ && !row.promises.opaque_only && !row.traits.traces &&
            row.error_bound(choice.values, rays::MapLayout()) <= exact)
            scout_ = families_.size();
        const std::string answers = words_of_answers(row, choice.values);
        const auto alike = std::find_if(choices_.begin(), choices_.end(), [&](const Choice& other) {
            return other.row == &row && words_of_answers(row, other.values) == answers;
        });
        if (alike != choices_.end()) family.answers_as = static_cast<std::size_t>(alike - choices_.begin());
        families_.push_back(std::move(family));
        choices_.push_back(std::move(choice));
    }
}

Point Space::add(const nlohmann::json& part) {
    nlohmann::json parameters = part.at("techniques").at(0);
    const Technique& row = techniques::find(parameters.at("type").get<std::string>(), "/techniques/0/type");
    parameters.erase("type");
    Choice choice{&row, techniques::read_parameters(row.parameters, parameters, "/techniques/0"),
                  {{own_}, {own_samples_}}};
    if (part.contains("rays") && !row.traits.traces) {
        const nlohmann::json& rays = part["rays"];
        if (rays.contains("resolution")) choice.rays.resolutions = {resolution_of(rays["resolution"])};
        choice.rays.samples = {rays.value("samples_per_pixel", own_samples_)};
    }
    const base::Vec2i sides = choice.rays.resolutions.front();
    if (static_cast<std::int64_t>(sides.x) * own_.y != static_cast<std::int64_t>(sides.y) * own_.x)
        throw base::Error(base::ErrorCode::bad_input, "/rays/resolution",
                          "must have the scenario's ratio of sides, so that the light frames the same part of its plane");
    Family family{row.id, part.dump(), choice.rays.axes(), {}};
    family.mapless = row.traits.traces;
    families_.push_back(std::move(family));
    choices_.push_back(std::move(choice));
    return {families_.size() - 1, {0, 0}};
}

base::Vec2i Space::resolution(const Point& point) const {
    return choices_[point.family].rays.resolutions[static_cast<std::size_t>(point.step[0])];
}

int Space::samples(const Point& point) const {
    return choices_[point.family].rays.samples[static_cast<std::size_t>(point.step[1])];
}

Setting Space::setting(const Point& point) const {
    const Choice& choice = choices_[point.family];
    Setting setting{choice.row, choice.values, resolution(point), samples(point)};
    for (std::size_t i = 0; i < choice.numbers.size(); ++i)
        setting.values.values[choice.numbers[i].first] =
            choice.numbers[i].second[static_cast<std::size_t>(point.step[i + 2])];
    return setting;
}

}  // namespace shadowbench::recommend

#include "techniques/trades.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::techniques {
namespace {

constexpr int steps_an_octave = 4, steps_of_a_line = 16;

const Parameter& find_parameter(std::span<const Parameter> declared, const std::string& name) {
    for (const Parameter& parameter : declared)
        if (parameter.name == name) return parameter;
    throw base::Error(base::ErrorCode::internal, name, "a trade names a parameter that is not declared");
}

double three_digits(double value) {
    return std::stod(fmt::format("{:.3g}", value));
}

}  // namespace

std::vector<ParameterValues::Value> values_of(const Trade& trade, std::span<const Parameter> declared) {
    const bool whole = find_parameter(declared, trade.parameter).kind == ParameterKind::integer;
    if (trade.scale == Trade::Scale::choice) return trade.choices;
    const bool logarithmic = trade.scale == Trade::Scale::logarithmic;
    const double range = std::abs(trade.to - trade.from);
    const int steps = logarithmic
                          ? static_cast<int>(std::ceil(steps_an_octave * std::abs(std::log2(trade.to / trade.from))))
                      : whole ? static_cast<int>(range)
                              : steps_of_a_line;
    std::vector<ParameterValues::Value> values;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        double value = logarithmic ? trade.from * std::pow(trade.to / trade.from, share)
                                   : trade.from + (trade.to - trade.from) * share;
        value = i == steps ? trade.to : whole ? std::round(value) : three_digits(value);
        if (values.empty() || values.back() != ParameterValues::Value(value)) values.emplace_back(value);
    }
    return values;
}

int coarse_stride(const Trade& trade, std::size_t values) {
    const int quarter = std::max(1, static_cast<int>(values) / 4);
    return trade.scale == Trade::Scale::logarithmic ? std::min(steps_an_octave, quarter) : quarter;
}

std::string to_string(const Trade& trade) {
    if (trade.scale != Trade::Scale::choice)
        return fmt::format("{} {:g} to {:g}", trade.parameter, trade.from, trade.to);
    std::string text = trade.parameter;
    const char* before = " ";
    for (const ParameterValues::Value& value : trade.choices) {
        text += before;
        const double* number = std::get_if<double>(&value);
        text += number ? fmt::format("{:g}", *number) : std::get<std::string>(value);
        before = "|";
    }
    return text;
}

}  // namespace shadowbench::techniques

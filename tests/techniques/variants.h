// Settings of a row to test it with.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "techniques/technique.h"

namespace shadowbench::techniques::testing {

inline ParameterValues defaults(const Technique& row) {
    return read_parameters(row.parameters, nlohmann::json::object(), "");
}

// The defaults first; every word with every other one; each number at its least and its greatest, with the default
// words and with the last ones.
inline std::vector<ParameterValues> variants(const Technique& row) {
    std::vector<ParameterValues> found{defaults(row)};
    for (const Parameter& p : row.parameters)
        for (std::size_t i = 0, before = found.size(); i < before; ++i)
            for (const char* word : p.words) {
                if (std::string(word) == p.standard_word) continue;
                found.push_back(found[i]);
                found.back().values[p.name] = std::string(word);
            }
    std::vector<ParameterValues> words{found.front()};
    if (found.size() > 1) words.push_back(found.back());
    for (const ParameterValues& these : words)
        for (const Parameter& p : row.parameters) {
            if (p.kind == ParameterKind::choice) continue;
            for (const double number : {p.min, p.max}) {
                found.push_back(these);
                found.back().values[p.name] = number;
                bool behind = false;  // biases are never less than the one before
                for (const char* bias : row.traits.biases) {
                    behind = behind || p.name == std::string_view(bias);
                    if (behind) found.back().values[bias] = number;
                }
            }
        }
    return found;
}

// The least possible answer of a lookup or a stored function: a function that leaves [0, 1] within a bounded error
// falls below 0 by at most that error, or twice it over mip levels.
inline double least_answer(const Technique& row, const ParameterValues& values, const rays::MapLayout& layout) {
    const double bound = row.error_bound(values, layout);
    return promises(row, values).unit_range || !std::isfinite(bound) ? 0.0 : -2.0 * bound;
}

// Adds nothing to depths.
inline ParameterValues unbiased(const Technique& row, ParameterValues values) {
    for (const char* bias : row.traits.biases) values.values[bias] = 0.0;
    return values;
}

// The most that is added to stored depths.
inline double bias_of(const Technique& row, const ParameterValues& values) {
    return row.traits.biases.empty() ? 0.0 : values.number(row.traits.biases.back());
}

// Settings with which a lookup of width 0 answers the stored function of its cell.
inline ParameterValues pointwise(const Technique& row, const ParameterValues& values) {
    return with(unbiased(row, values), row.traits.pointwise);
}

inline std::string text_of(const Technique& row, const ParameterValues& values) {
    return row.id + (" " + to_string(values, row.parameters, false));
}

// For INSTANTIATE_TEST_SUITE_P.
inline std::vector<const Technique*> rows() {
    std::vector<const Technique*> result;
    for (const Technique& row : all()) result.push_back(&row);
    return result;
}
inline std::string name_of_row(const ::testing::TestParamInfo<const Technique*>& test) {
    return test.param->id;
}

}  // namespace shadowbench::techniques::testing

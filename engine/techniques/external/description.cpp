#include "techniques/external/description.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "techniques/external/external_map.h"

namespace shadowbench::techniques {
namespace {

using base::Error;
using base::ErrorCode;

constexpr std::size_t longest_name = 64;

// What the row points to, for as long as any copy of it lives.
struct Owned {
    Description description;
    std::vector<Parameter> parameters;
    Library library;
    std::shared_ptr<TechniqueCalls> calls;
};

bool is_name(const std::string& text) {
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    return !text.empty() && text.size() <= longest_name && text[0] >= 'a' && text[0] <= 'z' &&
           std::all_of(text.begin(), text.end(), fits);
}

bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// What is wrong with it; empty: nothing.
std::string fault_of(const OutsideParameter& p) {
    if (!is_name(p.name) || p.name == "type")
        return "its name must be of lower-case letters, digits and _, begin with a letter, and not be \"type\"";
    const bool numbers = p.kind != ParameterKind::choice;
    const bool words = p.kind == ParameterKind::choice || p.kind == ParameterKind::number_or_word;
    if (words == p.words.empty()) return words ? "it has no words" : "it has words, but takes only numbers";
    if (has(p.words, "")) return "a word is empty";
    if (numbers && !(std::isfinite(p.min) && std::isfinite(p.max) && p.min <= p.max))
        return fmt::format("its range {:g} to {:g} is none", p.min, p.max);
    if (p.standard_word.empty() && !numbers) return "its default is no word";
    if (!p.standard_word.empty()) return has(p.words, p.standard_word) ? "" : "its default is none of its words";
    if (!(p.standard >= p.min && p.standard <= p.max)) return "its default is out of range";
    const bool whole = p.kind != ParameterKind::integer || p.standard == std::floor(p.standard);
    return whole ? "" : "its default is not a whole number";
}

std::string fault_of(const OutsideTrade& trade, const std::vector<OutsideParameter>& parameters) {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const OutsideParameter& p) { return p.name == trade.parameter; });
    if (found == parameters.end()) return "there is no such parameter";
    if (trade.scale == Trade::Scale::choice) return found->words.empty() ? "the parameter has no words" : "";
    const auto in_range = [&](double value) { return value >= found->min && value <= found->max; };
    if (found->kind == ParameterKind::choice || !in_range(trade.from) || !in_range(trade.to))
        return "its values are not those of the parameter";
    if (found->kind == ParameterKind::integer &&
        (trade.from != std::floor(trade.from) || trade.to != std::floor(trade.to)))
        return "its values are not whole";
    if (trade.scale == Trade::Scale::logarithmic && !(trade.from > 0.0 && trade.to > 0.0))
        return "a logarithmic scale needs values above 0";
    return trade.from == trade.to ? "it has a single value" : "";
}

Parameter parameter_of(const OutsideParameter& p) {
    Parameter parameter{p.name.c_str(), p.kind, p.doc.c_str(), p.standard, p.min, p.max, p.standard_word.c_str(), {}};
    for (const std::string& word : p.words) parameter.words.push_back(word.c_str());
    return parameter;
}

Trade trade_of(const OutsideTrade& t, const Description& description) {
    Trade trade{.parameter = t.parameter.c_str(), .scale = t.scale, .from = t.from, .to = t.to};
    if (t.scale != Trade::Scale::choice) return trade;
    for (const OutsideParameter& p : description.parameters)
        if (p.name == t.parameter) trade.choices.assign(p.words.begin(), p.words.end());
    return trade;
}

// What a row says of a map before it is made must not end a run: a fault is found again when the map begins.
template <class Value, class Call>
Value or_else(Value otherwise, const Call& call) {
    try {
        return call();
    } catch (const Error&) {
        return otherwise;
    }
}

}  // namespace

void check_description(const Description& description, const std::string& where) {
    const auto refuse = [&](const std::string& what, const std::string& fault) {
        if (!fault.empty()) throw Error(ErrorCode::bad_input, where, what + ": " + fault);
    };
    if (!is_name(description.id))
        refuse("technique \"" + description.id + "\"",
               "an id is of lower-case letters, digits and _, begins with a letter, and has at most 64 characters");
    const std::string technique = "technique \"" + description.id + "\"";
    if (description.version < 1) refuse(technique, "its version is below 1");
    if (!(description.promises.leak >= 0.0 && description.promises.leak <= 1.0))
        refuse(technique, "its leak is outside [0, 1]");
    std::set<std::string> names;
    for (const OutsideParameter& p : description.parameters) {
        refuse(technique + ", parameter \"" + p.name + "\"", fault_of(p));
        if (!names.insert(p.name).second) refuse(technique + ", parameter \"" + p.name + "\"", "is declared twice");
    }
    names.clear();
    for (const OutsideTrade& trade : description.trades) {
        refuse(technique + ", trade of \"" + trade.parameter + "\"", fault_of(trade, description.parameters));
        if (!names.insert(trade.parameter).second)
            refuse(technique + ", trade of \"" + trade.parameter + "\"", "is declared twice");
    }
}

Technique make_row(const Outside& technique, const Library& library) {
    const auto owned = std::make_shared<Owned>(Owned{technique.description, {}, library, technique.calls});
    const Description& description = owned->description;
    for (const OutsideParameter& p : description.parameters) owned->parameters.push_back(parameter_of(p));
    Technique row{
        .id = description.id.c_str(),
        .title = description.title.c_str(),
        .paper = description.paper.c_str(),
        .version = description.version,
        .promises = description.promises,
        .parameters = owned->parameters,
        .create = [owned](const ParameterValues& values) -> std::unique_ptr<Map> {
            return std::make_unique<ExternalMap>(owned->calls, values, owned->description.cells);
        },
        .error_bound =
            [owned](const ParameterValues& values, const rays::MapLayout& layout) {
                return or_else(no_bound(values, layout), [&] { return owned->calls->error_bound(values, layout); });
            },
        .least_bytes =
            [owned](const ParameterValues& values, const rays::MapLayout& layout) {
                return or_else(std::size_t{0},
                               [&] { return static_cast<std::size_t>(owned->calls->least_bytes(values, layout)); });
            },
        .library = library};
    for (const OutsideTrade& trade : description.trades) row.traits.trades.push_back(trade_of(trade, description));
    return row;
}

Technique make_broken_row(const std::string& id, const Library& library, const std::string& reason) {
    const auto owned = std::make_shared<Owned>();
    owned->description.id = id;
    owned->description.title = "cannot be used: " + reason;
    owned->library = library;
    owned->library.fault = reason;
    return {.id = owned->description.id.c_str(),
            .title = owned->description.title.c_str(),
            .paper = "from outside",
            .version = 1,
            .create = [owned](const ParameterValues&) -> std::unique_ptr<Map> {
                return std::make_unique<BrokenMap>(owned->library.file, owned->library.fault);
            },
            .library = owned->library};
}

}  // namespace shadowbench::techniques

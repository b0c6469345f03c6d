// "deep:tolerance=0.02" -> a technique and its parameters.
#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/utf8.h"
#include "document/technique_choice.h"

namespace shadowbench::document {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

json read_pairs(const std::string& pairs, const std::string& where) {
    json object = json::object();
    for (std::size_t first = 0; first < pairs.size();) {
        const std::size_t comma = std::min(pairs.find(',', first), pairs.size());
        const std::string pair = pairs.substr(first, comma - first);
        const std::size_t equals = pair.find('=');
        if (equals == std::string::npos || equals == 0)
            throw Error(ErrorCode::usage, where, "expected name=value, as in deep:tolerance=0.02");
        json value = json::parse(pair.substr(equals + 1), nullptr, false);
        if (value.is_discarded()) value = pair.substr(equals + 1);
        if (!object.emplace(pair.substr(0, equals), std::move(value)).second)
            throw Error(ErrorCode::usage, where, pair.substr(0, equals) + " is given twice");
        first = comma + 1;
    }
    return object;
}

std::string place_of(const std::string& text) {
    return "--technique " + text;
}

}  // namespace

TechniqueChoice read_any_technique(const std::string& text) {
    const std::string where = place_of(text);
    if (!base::is_utf8(text)) throw Error(ErrorCode::usage, where, "the text is not UTF-8");
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string pairs = colon < text.size() ? text.substr(colon + 1) : std::string();
    TechniqueChoice choice;
    try {
        choice.row = &techniques::find(text.substr(0, colon), where);
        choice.values = techniques::read_parameters(choice.row->parameters, read_pairs(pairs, where), where);
    } catch (const Error& error) {
        throw Error(ErrorCode::usage, error.where(), error.message());
    }
    return choice;
}

TechniqueChoice read_technique(const std::string& text) {
    TechniqueChoice choice = read_any_technique(text);
    if (!choice.row->from_curves)
        throw Error(ErrorCode::usage, place_of(text),
                    "this technique needs light rays: it cannot take given functions");
    return choice;
}

}  // namespace shadowbench::document

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_pointer.h"
#include "document/document.h"
#include "document/pointer.h"
#include "scene/scenario.h"
#include "techniques/technique.h"

namespace shadowbench::document {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

constexpr std::size_t max_variants = 1000;    // of a scenario
constexpr std::size_t max_techniques = 1000;  // of a variant

struct Sweep {
    std::string text;  // the pointer as written
    json::json_pointer pointer;
    const json* values;
    std::string where;
};

// "/sweeps/~1rays~1seed": the place of a sweep in the document.
std::string sweep_place(const std::string& pointer) {
    return base::append_token("/sweeps", pointer);
}

std::vector<Sweep> read_sweeps(const json& document) {
    std::vector<Sweep> sweeps;
    if (!document.contains("sweeps")) return sweeps;
    for (const auto& [text, values] : document.at("sweeps").items()) {
        const std::string where = sweep_place(text);
        if (!values.is_array() || values.empty())
            throw Error(ErrorCode::bad_input, where, "expected a list of at least one value");
        try {
            sweeps.push_back({text, json::json_pointer(text), &values, where});
        } catch (const json::exception&) {
            throw Error(ErrorCode::bad_input, where, "the key is not a JSON pointer");
        }
    }
    return sweeps;
}

// The technique that a pointer reaches into, or -1.
int technique_of(const json::json_pointer& pointer, std::size_t techniques) {
    json::json_pointer rest = pointer;
    std::vector<std::string> names;
    for (; !rest.empty(); rest.pop_back()) names.insert(names.begin(), rest.back());
    if (names.size() < 3 || names[0] != "techniques") return -1;
    for (std::size_t i = 0; i < techniques; ++i)
        if (names[1] == std::to_string(i)) return static_cast<int>(i);
    return -1;
}

void put(json& document, const Sweep& sweep, const json& value) {
    json* place = find_place(document, sweep.pointer);
    if (!place) throw Error(ErrorCode::bad_input, sweep.where, "the pointer leads to no value of the scenario");
    *place = value;
}

struct Choice {
    json document;
    std::vector<const json*> values;  // one a sweep
};

[[noreturn]] void refuse_many(const Sweep& sweep, std::size_t limit) {
    throw Error(ErrorCode::bad_input, sweep.where,
                fmt::format("the sweeps combine to more than {}; sweep over fewer values", limit));
}

// All combinations of the sweeps' values, the last sweep changing fastest.
std::vector<Choice> combine(const json& document, const std::vector<Sweep>& sweeps, std::size_t limit) {
    std::vector<Choice> choices{{document, {}}};
    for (const Sweep& sweep : sweeps) {
        if (choices.size() * sweep.values->size() > limit) refuse_many(sweep, limit);
        std::vector<Choice> next;
        for (const Choice& choice : choices)
            for (const json& value : *sweep.values) {
                next.push_back(choice);
                put(next.back().document, sweep, value);
                next.back().values.push_back(&value);
            }
        choices = std::move(next);
    }
    return choices;
}

bool is_every(const json& technique) {
    return technique.at("type") == every_technique;
}

// The techniques that "*" stands for in this document.
json every_other_technique(const json& document) {
    const json& listed = document.at("techniques");
    json others = json::array();
    for (const techniques::Technique& row : techniques::all()) {
        const bool named =
            std::any_of(listed.begin(), listed.end(), [&](const json& t) { return t.at("type") == row.id; });
        const bool served = !row.traits.traces || !document.at("scene").contains("deep_image");
        if (!named && served) others.push_back({{"type", row.id}});
    }
    return others;
}

// Throws Error{bad_input} if "*" is listed twice.
void check_every(const json& techniques) {
    bool found = false;
    for (std::size_t i = 0; i < techniques.size(); ++i) {
        if (!is_every(techniques[i])) continue;
        if (found)
            throw Error(ErrorCode::bad_input, fmt::format("/techniques/{}/type", i),
                        "\"*\" stands for all other techniques already: list it once");
        found = true;
    }
}

// Replaces each swept technique by one for each combination of its values, and "*" by the techniques it stands for.
void expand_techniques(Variant& variant, const json& document, const std::vector<std::vector<Sweep>>& sweeps) {
    json expanded = json::array();
    check_every(document.at("techniques"));
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
        std::vector<std::string> names;
        for (const Sweep& sweep : sweeps[i])
            if (sweep.pointer.back() != "type") names.push_back(sweep.pointer.back());
        const std::string where = fmt::format("/techniques/{}", i);
        for (Choice& choice : combine(document, sweeps[i], max_techniques)) {
            json& technique = choice.document.at("techniques").at(i);
            const bool every = is_every(technique) && technique.size() == 1;  // otherwise check_document() refuses it
            for (json& entry : every ? every_other_technique(document) : json::array({technique})) {
                expanded.push_back(std::move(entry));
                variant.technique_where.push_back(where);
                variant.swept.push_back(names);
            }
        }
    }
    json result = document;
    result["techniques"] = std::move(expanded);
    variant.document = std::make_shared<const json>(std::move(result));
}

// A document without its sweeps, and the sweeps: over the parameters of each technique (inner), and over all else
// (outer).
struct Swept {
    json plain;
    std::vector<Sweep> outer;
    std::vector<std::vector<Sweep>> inner;
};

Swept sort_sweeps(const json& document) {
    scene::check_schema(document, scene::scenario_schema());
    const std::size_t techniques = document.at("techniques").size();
    Swept swept{document, {}, std::vector<std::vector<Sweep>>(techniques)};
    swept.plain.erase("sweeps");
    for (const Sweep& sweep : read_sweeps(document)) {
        const int technique = technique_of(sweep.pointer, techniques);
        if (technique < 0)
            swept.outer.push_back(sweep);
        else
            swept.inner[static_cast<std::size_t>(technique)].push_back(sweep);
    }
    // A sweep over the list of techniques would move the places that the other sweeps point to.
    for (const Sweep& sweep : swept.outer)
        if (sweep.text.rfind("/techniques", 0) == 0)
            throw Error(ErrorCode::bad_input, sweep.where,
                        "within the techniques, a sweep can only set a parameter, as in /techniques/0/tolerance");
    return swept;
}

}  // namespace

std::vector<Variant> expand(const json& document) {
    const Swept swept = sort_sweeps(document);
    std::vector<Variant> variants;
    for (const Choice& choice : combine(swept.plain, swept.outer, max_variants)) {
        Variant variant;
        for (std::size_t i = 0; i < swept.outer.size(); ++i)
            variant.settings.push_back({swept.outer[i].text, choice.values[i]->dump()});
        expand_techniques(variant, choice.document, swept.inner);
        check_document(*variant.document, variant.technique_where);
        variants.push_back(std::move(variant));
    }
    return variants;
}

json select_variant(const json& document, std::size_t index) {
    Swept swept = sort_sweeps(document);
    std::size_t count = 1;
    for (const Sweep& sweep : swept.outer) {
        count *= sweep.values->size();
        if (count > max_variants) refuse_many(sweep, max_variants);
    }
    if (index >= count)
        throw Error(ErrorCode::usage, fmt::format("variant={}", index),
                    fmt::format("the scenario has {} variant{}, counted from 0", count, count == 1 ? "" : "s"));
    for (const Sweep& sweep : swept.outer) {
        count /= sweep.values->size();
        put(swept.plain, sweep, sweep.values->at(index / count % sweep.values->size()));
    }
    for (const std::vector<Sweep>& inner : swept.inner)
        for (const Sweep& sweep : inner) swept.plain["sweeps"][sweep.text] = *sweep.values;
    return std::move(swept.plain);
}

}  // namespace shadowbench::document

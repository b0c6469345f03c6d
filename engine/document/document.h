// The scenario document before it becomes a Scenario: changes from outside, checks, sweeps.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "document/setting.h"

namespace shadowbench::document {

// Sets one value: "rays.samples_per_pixel=64" or "/rays/samples_per_pixel=64". The value is read as JSON, or taken as a
// string where it is none. A part of the scenario that the document leaves out (such as "timing") is added; a sweep
// over the same value is dropped. Throws Error{usage}: no '=', or a path whose parent is not there; bad_input where an
// object or array is no JSON.
void set_value(nlohmann::json& document, const std::string& assignment);

// The committed schema with the techniques' parameters, from the registry.
nlohmann::json full_schema();

// The type of a technique that stands for every other one, {"type": "*"}: see expand().
inline constexpr const char* every_technique = "*";

// Checks a document: schema, then each technique's parameters by its own declaration. `technique_where` names the
// techniques in messages; empty: by their place in this document. Throws Error{bad_input}, place: JSON pointer.
void check_document(const nlohmann::json& document, std::span<const std::string> technique_where = {});

// All that can be said against a document that `first` was thrown for: it, then what else the schema and the
// techniques' declarations say; 32 faults at most.
std::vector<base::Error> all_faults(const nlohmann::json& document, const base::Error& first);

// One scenario of a document with sweeps.
struct Variant {
    std::shared_ptr<const nlohmann::json> document;  // without sweeps
    std::vector<Setting> settings;                   // what the sweeps set outside of the techniques
    std::vector<std::string> technique_where;        // JSON pointer into the original document, one a technique
    std::vector<std::vector<std::string>> swept;     // names of the parameters that sweeps set, one list a technique
};

// Replaces "sweeps": {pointer: [values]} by what it stands for. Pointers into /techniques/<i>/ turn that technique into
// one for each combination of its values, in place; any others make one variant for each of their combinations, the
// alphabetically last pointer changing fastest.
//
// {"type": "*"} among the techniques becomes, in place and in the order of the registry, every technique that the list
// does not name elsewhere, each with its defaults; those that trace the scene are left out where there is none but a
// deep_image. It takes no parameters and stands once.
//
// Every variant has passed check_document. Throws Error{bad_input}.
std::vector<Variant> expand(const nlohmann::json& document);

// The document with the values of one combination of its sweeps, counted from 0 as expand() does; sweeps over a
// technique's parameters stay. Throws Error{bad_input}, and Error{usage} for a combination that is not there.
nlohmann::json select_variant(const nlohmann::json& document, std::size_t index);

// Keeps the techniques of these types; none given: all. Throws Error{usage} for a type that the variant does not have.
void keep_only(Variant& variant, std::span<const std::string> types);

}  // namespace shadowbench::document

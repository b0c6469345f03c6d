// The scenario document before it becomes a Scenario: setting values, checking, expanding sweeps.
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

// Sets one value: "rays.samples_per_pixel=64" or "/rays/samples_per_pixel=64". The value is read as JSON; a text that
// is not JSON is a string. A part of the scenario that the document leaves out (such as "timing") is added; a sweep
// over the same value is dropped. Throws Error{usage} if there is no '=' or the parent of the path does not exist, and
// bad_input for an object or array that is not JSON.
void set_value(nlohmann::json& document, const std::string& assignment);

// The committed schema with the techniques' parameters, from the registry.
nlohmann::json full_schema();

// The type of a technique that stands for every technique not listed by name, {"type": "*"}: see expand().
inline constexpr const char* every_technique = "*";

// Checks a document against the schema, then each technique's parameters against its declaration. Messages call the
// techniques by `technique_where`, or if that is empty by their places in this document. Throws Error{bad_input},
// place: JSON pointer.
void check_document(const nlohmann::json& document, std::span<const std::string> technique_where = {});

// All faults of a document that made `first` be thrown: `first`, then the others that the schema and the techniques'
// declarations find. At most 32.
std::vector<base::Error> all_faults(const nlohmann::json& document, const base::Error& first);

// One scenario of a document with sweeps.
struct Variant {
    std::shared_ptr<const nlohmann::json> document;  // without sweeps
    std::vector<Setting> settings;                   // what the sweeps set outside of the techniques
    std::vector<std::string> technique_where;        // JSON pointer into the original document, one a technique
    std::vector<std::vector<std::string>> swept;     // names of the parameters that sweeps set, one list a technique
};

// Expands "sweeps": {pointer: [values]}. A pointer into /techniques/<i>/ replaces that technique, in place, by one for
// each combination of its values. The other pointers make one variant for each combination of their values; the
// alphabetically last pointer changes fastest.
//
// {"type": "*"} among the techniques becomes, in place and in the order of the registry, every technique that the list
// does not name elsewhere, each with its defaults. Techniques that trace the scene are left out if the scene is only a
// deep_image. "*" takes no parameters and may be listed once.
//
// Every variant has passed check_document. Throws Error{bad_input}.
std::vector<Variant> expand(const nlohmann::json& document);

// The document with the values of one combination of its sweeps, counted from 0 as in expand(). Sweeps over a
// technique's parameters stay. Throws Error{bad_input}, and Error{usage} for a combination that does not exist.
nlohmann::json select_variant(const nlohmann::json& document, std::size_t index);

// Keeps only the techniques of these types, or all if no type is given. Throws Error{usage} for a type that the variant
// does not have.
void keep_only(Variant& variant, std::span<const std::string> types);

}  // namespace shadowbench::document

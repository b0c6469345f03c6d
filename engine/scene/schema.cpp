// The only file that includes valijson, which takes long to compile.
// GCC 12 reports uninitialised members in std::regex if a sanitizer is on (GCC bug 105562).
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "base/error.h"
#include "base/json_pointer.h"
#include "scene/scenario.h"
#include "scene/schema_fault.h"
#include "scene/schema_text.h"

namespace shadowbench::scene {
namespace {

// valijson reads whole numbers as signed 64-bit integers: larger ones would pass as negative.
void refuse_large_integers(const nlohmann::json& value, const nlohmann::json::json_pointer& at) {
    constexpr auto largest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > largest)
        throw base::Error(base::ErrorCode::bad_input, at.to_string(),
                          fmt::format("{} is too large for a whole number; the largest is 9223372036854775807",
                                      value.get<std::uint64_t>()));
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (value[i].is_structured() || value[i].is_number_unsigned()) refuse_large_integers(value[i], at / i);
        }
    if (value.is_object())
        for (const auto& [key, child] : value.items()) refuse_large_integers(child, at / key);
}

// Parsing a schema takes longer than checking a document, and a document with sweeps is checked once for each variant,
// so the few schemas are kept.
std::shared_ptr<const valijson::Schema> parsed(const nlohmann::json& schema) {
    constexpr std::size_t most = 4;
    static std::mutex mutex;
    static std::vector<std::pair<nlohmann::json, std::shared_ptr<const valijson::Schema>>> kept;
    const std::lock_guard lock(mutex);
    for (const auto& [source, result] : kept)
        if (source == schema) return result;
    const auto result = std::make_shared<valijson::Schema>();
    valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(schema), *result);
    if (kept.size() == most) kept.erase(kept.begin());
    kept.emplace_back(schema, result);
    return result;
}

// "<root>", "[lights]", "[0]" -> "lights", "0".
std::vector<std::string> path_of(const valijson::ValidationResults::Error& error) {
    std::vector<std::string> path;
    for (std::size_t i = 1; i < error.context.size(); ++i)
        path.push_back(error.context[i].substr(1, error.context[i].size() - 2));
    return path;
}

std::string pointer_of(const std::vector<std::string>& path) {
    std::string pointer;
    for (const std::string& step : path) pointer = base::append_token(std::move(pointer), step);
    return pointer;
}

// Keeps each fault once: the validator repeats it for every enclosing schema.
class Faults {
public:
    bool any_within(const std::string& pointer) const { return around_.contains(pointer); }

    void add(const SchemaFault& fault) {
        if (!told_.emplace(fault.pointer, fault.message).second) return;
        list.push_back(fault);
        std::string at = fault.pointer;
        while (around_.insert(at).second && !at.empty()) at.erase(at.rfind('/'));
    }

    std::vector<SchemaFault> list;

private:
    std::set<std::pair<std::string, std::string>> told_;
    std::set<std::string> around_;  // pointers of all values that contain a fault
};

}  // namespace

const nlohmann::json& scenario_schema() {
    static const nlohmann::json schema = nlohmann::json::parse(scenario_schema_text());
    return schema;
}

std::vector<base::Error> schema_faults(const nlohmann::json& document, const nlohmann::json& schema, std::size_t most) {
    try {
        refuse_large_integers(document, nlohmann::json::json_pointer());
    } catch (const base::Error& error) {
        return {error};
    }
    const std::shared_ptr<const valijson::Schema> rules = parsed(schema);
    const valijson::adapters::NlohmannJsonAdapter target(document);
    valijson::Validator validator;
    // Collecting faults costs time that a valid document, the common case, need not spend.
    if (validator.validate(*rules, target, nullptr)) return {};

    valijson::ValidationResults results;
    validator.validate(*rules, target, &results);
    Faults faults;
    for (const auto& error : results) {  // the innermost value comes first
        if (faults.list.size() >= most) break;
        const std::vector<std::string> path = path_of(error);
        const std::string pointer = pointer_of(path);
        std::vector<SchemaFault> found = explain_faults(document, schema, path, most);
        if (found.empty() && !faults.any_within(pointer)) found.push_back({pointer, error.description});
        for (const SchemaFault& fault : found) faults.add(fault);
    }
    std::vector<base::Error> errors;
    for (const SchemaFault& fault : faults.list) {
        if (errors.size() == most) break;
        // The pointer of a whole document is empty, and an error without a place reads as if its place were unknown.
        const bool whole = fault.pointer.empty() && !document.is_object();
        errors.emplace_back(base::ErrorCode::bad_input, whole ? "/" : fault.pointer, fault.message);
    }
    return errors;
}

void check_schema(const nlohmann::json& document, const nlohmann::json& schema) {
    const std::vector<base::Error> faults = schema_faults(document, schema, 1);
    if (!faults.empty()) throw faults.front();
}

}  // namespace shadowbench::scene

// The only file that includes valijson: it takes long to compile.
// GCC 12 sees uninitialised members in std::regex when a sanitizer is on (GCC bug 105562).
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
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
#include "scene/scenario.h"
#include "scene/schema_fault.h"
#include "scene/schema_text.h"

namespace shadowbench::scene {
namespace {

// valijson takes whole numbers as signed ones of 64 bits: larger ones would pass as negative.
void refuse_large_integers(const nlohmann::json& value, const nlohmann::json::json_pointer& at) {
    constexpr auto largest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > largest)
        throw base::Error(base::ErrorCode::bad_input, at.to_string(),
                          fmt::format("{} is too large for any number here", value.get<std::uint64_t>()));
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (value[i].is_structured() || value[i].is_number_unsigned()) refuse_large_integers(value[i], at / i);
        }
    if (value.is_object())
        for (const auto& [key, child] : value.items()) refuse_large_integers(child, at / key);
}

// A schema takes longer to parse than a document to check, and a document with sweeps is checked once a variant: the
// few schemas that there are, are kept.
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

}  // namespace

const nlohmann::json& scenario_schema() {
    static const nlohmann::json schema = nlohmann::json::parse(scenario_schema_text());
    return schema;
}

void check_schema(const nlohmann::json& document, const nlohmann::json& schema) {
    refuse_large_integers(document, nlohmann::json::json_pointer());
    const std::shared_ptr<const valijson::Schema> rules = parsed(schema);
    const valijson::adapters::NlohmannJsonAdapter target(document);
    valijson::Validator validator;
    // Results collect every fault; a valid document, the common case, does not pay for them.
    if (validator.validate(*rules, target, nullptr)) return;

    valijson::ValidationResults results;
    validator.validate(*rules, target, &results);
    valijson::ValidationResults::Error first;
    std::vector<std::string> path;
    if (results.popError(first))
        // "<root>", "[lights]", "[0]": the innermost value comes first.
        for (std::size_t i = 1; i < first.context.size(); ++i)
            path.push_back(first.context[i].substr(1, first.context[i].size() - 2));
    const SchemaFault fault = explain_fault(document, schema, path, first.description);
    // The pointer of a whole document is empty; a message that begins with nothing reads as if its place were unknown.
    const bool whole = fault.pointer.empty() && !document.is_object();
    throw base::Error(base::ErrorCode::bad_input, whole ? "/" : fault.pointer, fault.message);
}

}  // namespace shadowbench::scene

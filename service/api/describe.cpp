#include "service/api/describe.h"

#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "document/document.h"
#include "scene/named_scenarios.h"
#include "service/api/file_answer.h"
#include "service/api/openapi_text.h"
#include "service/api/problem.h"
#include "service/api/routes.h"
#include "service/api/submit.h"
#include "techniques/technique.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using techniques::Parameter;
using techniques::ParameterKind;

const char* type_of(ParameterKind kind) {
    switch (kind) {
        case ParameterKind::number:
            return "number";
        case ParameterKind::integer:
            return "integer";
        case ParameterKind::choice:
            return "choice";
        case ParameterKind::number_or_word:
            break;
    }
    return "number_or_word";
}

ordered_json describe(const Parameter& parameter) {
    const bool numbers = parameter.kind != ParameterKind::choice;
    const bool word = parameter.standard_word[0] != '\0';
    return {{"name", parameter.name},
            {"type", type_of(parameter.kind)},
            {"default", word ? ordered_json(parameter.standard_word) : ordered_json(parameter.standard)},
            {"minimum", numbers ? ordered_json(parameter.min) : ordered_json(nullptr)},
            {"maximum", numbers ? ordered_json(parameter.max) : ordered_json(nullptr)},
            {"values", parameter.words},
            {"meaning", parameter.doc}};
}

ordered_json describe(const techniques::Technique& row) {
    ordered_json parameters = ordered_json::array();
    for (const Parameter& parameter : row.parameters) parameters.push_back(describe(parameter));
    ordered_json described = {{"id", row.id},
                              {"title", row.title},
                              {"paper", row.paper},
                              {"version", row.version},
                              {"promises",
                               {{"monotone", row.promises.monotone},
                                {"unit_range", row.promises.unit_range},
                                {"opaque_only", row.promises.opaque_only},
                                {"localised", row.promises.localised},
                                {"approximate", row.promises.approximate},
                                {"early", row.promises.early}}},
                              {"parameters", std::move(parameters)}};
    if (!row.library.file.empty()) described["library"] = {{"file", row.library.file}, {"hash", row.library.hash}};
    return described;
}

// The document under this name, or nothing: the file is broken, or another scenario has the name that it gives itself.
std::optional<ordered_json> document_of(const scene::NamedScenario& scenario) {
    if (!scenario.fault.empty()) return std::nullopt;
    ordered_json document = ordered_json::parse(base::read_text(scenario.file), nullptr, false);
    const auto name = document.find("name");
    if (name == document.end() || *name != scenario.name) return std::nullopt;
    return document;
}

// Why the server runs no jobs; empty: it does.
std::string why_not_ready(const Jobs& jobs, const JobStorage& storage) {
    if (jobs.stopping()) return "The server is stopping.";
    if (storage.gone) return "The state folder of the server was removed or replaced; jobs wait until it is back.";
    if (storage.is_low())
        return fmt::format("The disk of the server has {} MiB free and needs {}; jobs wait until it has.",
                           *storage.free >> 20, storage.min_free >> 20);
    return storage.fails ? "The server cannot write its storage; jobs wait until it can." : "";
}

}  // namespace

std::string read_scenarios(const std::vector<fs::path>& folders) {
    std::map<std::string, ordered_json> found;
    for (const scene::NamedScenario& scenario : scene::list_scenarios(folders))
        if (std::optional<ordered_json> document = document_of(scenario))
            found.emplace(scenario.name, ordered_json{{"name", scenario.name},
                                                      {"purpose", scenario.purpose},
                                                      {"document", std::move(*document)}});
    ordered_json list = ordered_json::array();
    for (auto& [name, scenario] : found) list.push_back(std::move(scenario));
    return ordered_json{{"scenarios", std::move(list)}}.dump() + "\n";
}

ApiResponse list_techniques(Context&, const Call& call) {
    ordered_json list = ordered_json::array();
    for (const techniques::Technique& row : techniques::all()) list.push_back(describe(row));
    return text_answer(call.request, "application/json", ordered_json{{"techniques", std::move(list)}}.dump() + "\n");
}

ApiResponse list_scenarios(Context& context, const Call& call) {
    return text_answer(call.request, "application/json", context.scenarios);
}

ApiResponse get_schema(Context&, const Call& call) {
    return text_answer(call.request, "application/json", document::full_schema().dump() + "\n");
}

ApiResponse get_openapi(Context&, const Call& call) {
    return text_answer(call.request, "application/json", openapi_text());
}

ApiResponse validate_scenario(Context& context, const Call& call) {
    auto posted = read_posted(call.request.body);
    if (auto* refusal = std::get_if<ApiResponse>(&posted)) return std::move(*refusal);
    auto examined = examine_posted(context, std::get<PostedScenario>(posted));
    if (auto* refusal = std::get_if<ApiResponse>(&examined)) return std::move(*refusal);
    nlohmann::json answer = std::get<nlohmann::json>(examined);
    answer["valid"] = true;
    return json_answer(200, answer);
}

ApiResponse get_health(Context&, const Call&) {
    return json_answer(200, ordered_json{{"status", "ok"}});
}

ApiResponse get_ready(Context& context, const Call&) {
    const JobStorage storage = context.jobs.storage();
    const std::string why = why_not_ready(context.jobs, storage);
    ordered_json space{{"free_bytes", nullptr}, {"min_free_bytes", storage.min_free}};
    if (storage.free) space["free_bytes"] = *storage.free;
    if (why.empty()) return json_answer(200, ordered_json{{"status", "ready"}, {"storage", std::move(space)}});
    ApiResponse response = problem(503, why, {}, {{"storage", std::move(space)}});
    response.headers.push_back({"Retry-After", "10"});
    return response;
}

ApiResponse get_metrics(Context& context, const Call&) {
    ApiResponse response;
    response.type = "text/plain; version=0.0.4; charset=utf-8";
    response.headers = {{"Cache-Control", "no-store"}};
    response.body = context.metrics.text(context.jobs, *context.streams, context.options.pace);
    return response;
}

}  // namespace shadowbench::service

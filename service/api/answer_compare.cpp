// POST /v1/compare: judges one result against another. Each is a job's, or stands in the request.
#include <optional>
#include <variant>

#include <nlohmann/json.hpp>

#include "base/json_pointer.h"
#include "scene/scenario.h"
#include "service/api/compare.h"
#include "service/api/file_answer.h"
#include "service/api/problem.h"
#include "service/api/routes.h"

namespace shadowbench::service {
namespace {

using nlohmann::json;

// The result that {"job": ID} or {"result": {...}} means, or the answer that refuses it.
std::variant<json, ApiResponse> read_side(const Context& context, json& body, const std::string& name) {
    const std::string pointer = base::append_token("", name);
    const auto refuse = [&](const std::string& detail) { return problem(422, detail, {{pointer, detail}}); };
    const auto side = body.find(name);
    if (side == body.end() || !side->is_object() || side->size() != 1)
        return refuse("must be {\"job\": ID} or {\"result\": {}}");
    if (const auto result = side->find("result"); result != side->end()) return std::move(*result);
    const auto id = side->find("job");
    if (id == side->end() || !id->is_string()) return refuse("must be {\"job\": ID} or {\"result\": {}}");
    const auto file = context.jobs.artifact(id->get<std::string>(), "result.json");
    if (!file) return refuse("there is no such job, or it has no result");
    const ApiResponse answer = file_answer({}, *file);
    if (!answer.file) return refuse("there is no such job, or it has no result");
    return json::parse(read_all(*answer.file));
}

}  // namespace

ApiResponse compare(Context& context, const Call& call) {
    json body;
    try {
        body = scene::parse_json(call.request.body, "body");
    } catch (const base::Error& error) {
        return problem(400, error.what());
    }
    if (!body.is_object()) return problem(422, "The body must be an object.", {{"", "must be an object"}});
    for (const auto& [key, value] : body.items())
        if (key != "baseline" && key != "current")
            return problem(422, "Unknown key \"" + key + "\"; the body has the keys baseline and current.",
                           {{base::append_token("", key), "unknown key"}});
    auto baseline = read_side(context, body, "baseline"), current = read_side(context, body, "current");
    for (auto* side : {&baseline, &current})
        if (auto* refusal = std::get_if<ApiResponse>(side)) return std::move(*refusal);
    return json_answer(200, compare_results(std::get<json>(baseline), std::get<json>(current)));
}

}  // namespace shadowbench::service

// GET /v1/jobs/{id}/curves: the visibility functions of one pixel of a light's map.
#include <charconv>
#include <optional>

#include <nlohmann/json.hpp>

#include "bench/pixel_curves.h"
#include "scene/scenario.h"
#include "service/api/problem.h"
#include "service/api/routes.h"

namespace shadowbench::service {
namespace {

template <class Number>
std::optional<Number> parse_number(const std::string* text) {
    Number value{};
    if (!text) return {};
    const auto [rest, fault] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (fault != std::errc() || rest != text->data() + text->size()) return {};
    return value;
}

}  // namespace

ApiResponse job_curves(Context& context, const Call& call) {
    CurveQuestion question;
    question.job = call.parameter("id");
    if (!context.jobs.find(question.job)) return problem(404, "There is no such job.");
    const auto x = parse_number<int>(call.request.parameter("x")), y = parse_number<int>(call.request.parameter("y"));
    if (!x || !y)
        return problem(400, "The parameters x and y must name a pixel of the light's map, as in ?light=key&x=12&y=34.");
    question.x = *x;
    question.y = *y;
    if (const std::string* light = call.request.parameter("light")) question.light = *light;
    if (const std::string* variant = call.request.parameter("variant")) {
        const auto index = parse_number<std::size_t>(variant);
        if (!index)
            return problem(400,
                           "The parameter variant must be the number of a combination of the sweeps' values, from 0.");
        question.variant = *index;
    }
    ApiResponse response;
    response.type = "application/json";
    response.headers = {{"Cache-Control", "private, max-age=60"}};
    response.body = context.curves.curves(question, [&] {
        std::optional<std::string> scenario = context.jobs.scenario(question.job);
        if (!scenario) throw base::Error(base::ErrorCode::usage, "", "the job was removed");
        bench::check_light(scene::parse_json(*scenario, "scenario"), question.light, question.variant);
        return *scenario;
    });
    return response;
}

}  // namespace shadowbench::service

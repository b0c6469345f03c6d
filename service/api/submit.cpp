#include "service/api/submit.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/json_pointer.h"
#include "recommend/request.h"
#include "scene/scenario.h"
#include "service/api/problem.h"

namespace shadowbench::service {
namespace {

using nlohmann::json;

constexpr std::size_t most_labels = 16, longest_label = 64;
constexpr std::int64_t most_priority = 100;

bool is_label(const json& value) {
    if (!value.is_string()) return false;
    const auto& text = value.get_ref<const std::string&>();
    return !text.empty() && text.size() <= longest_label &&
           std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

// Reads one of the options into `posted`. Returns what is wrong with it; empty: nothing.
std::string read_option(const std::string& key, const json& value, bool pictures, PostedScenario& posted) {
    if (key == "cache" && (value == "reuse" || value == "fresh")) {
        posted.reuse = value == "reuse";
    } else if (key == "pictures" && pictures && value.is_boolean()) {
        posted.pictures = value.get<bool>();
    } else if (key == "labels") {
        if (!value.is_array() || value.size() > most_labels || !std::all_of(value.begin(), value.end(), is_label))
            return fmt::format("must be at most {} texts of 1 to {} bytes, of one line each", most_labels,
                               longest_label);
        posted.labels = value.get<std::vector<std::string>>();
    } else if (key == "priority") {
        const bool is_huge = value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{most_priority};
        if (!value.is_number_integer() || is_huge || value < -most_priority || value > most_priority)
            return fmt::format("must be a whole number from {} to {}", -most_priority, most_priority);
        posted.priority = value.get<int>();
    } else {
        return fmt::format("the options are \"cache\": \"reuse\" or \"fresh\", {}\"labels\", and \"priority\"",
                           pictures ? "\"pictures\": true or false, " : "");
    }
    return "";
}

std::variant<PostedScenario, ApiResponse> read_options(const json& options, PostedScenario posted) {
    const auto refuse = [](const std::string& pointer, const std::string& detail) {
        return problem(422, detail, {{pointer, detail}});
    };
    if (!options.is_object()) return refuse("/options", "must be an object");
    for (const auto& [key, value] : options.items())
        if (const std::string wrong = read_option(key, value, true, posted); !wrong.empty())
            return refuse(base::append_token("/options", key), wrong);
    return posted;
}

// The limits that the estimate exceeds. `time`: what decides about the seconds.
std::vector<ProblemPart> over_limits(const json& estimate, bool pictures, const CostLimits& limits, const char* time) {
    std::vector<ProblemPart> over;
    const double bytes = estimate.at("bytes").get<double>(),
                 drawing = pictures ? estimate.value("picture_seconds", 0.0) : 0.0,
                 seconds = estimate.at("seconds").get<double>() + drawing;
    if (const int side = estimate.at("resolution").get<int>(); side > limits.resolution)
        over.push_back({"/rays/resolution",
                        fmt::format("the map has {} pixels a side; this server accepts {}", side, limits.resolution)});
    if (const int samples = estimate.at("samples_per_pixel").get<int>(); samples > limits.samples_per_pixel)
        over.push_back({"/rays/samples_per_pixel", fmt::format("{} rays a pixel, with those of the reference; this "
                                                               "server accepts {}",
                                                               samples, limits.samples_per_pixel)});
    constexpr double gib = 1 << 30;
    if (bytes > limits.bytes)
        over.push_back({"/rays", fmt::format("it needs at least {:.3g} GiB of memory; this server allows {:.3g}",
                                             bytes / gib, limits.bytes / gib)});
    if (seconds > limits.seconds)
        over.push_back({time, fmt::format("it would run for about {:.3g} s{}; this server allows {:.3g}", seconds,
                                          drawing > 0.0 ? fmt::format(", {:.3g} s of it for pictures", drawing) : "",
                                          limits.seconds)});
    return over;
}

std::variant<json, ApiResponse> read_body(const std::string& body) {
    try {
        return scene::parse_json(body, "body");
    } catch (const base::Error& error) {
        return problem(400, error.what());
    }
}

}  // namespace

std::variant<PostedScenario, ApiResponse> read_posted(const std::string& body) {
    auto read = read_body(body);
    if (auto* refusal = std::get_if<ApiResponse>(&read)) return std::move(*refusal);
    const json& document = std::get<json>(read);
    PostedScenario posted;
    if (!document.is_object() || !document.contains("scenario")) {
        posted.text = document.dump();
        return posted;
    }
    for (const auto& [key, value] : document.items())
        if (key != "scenario" && key != "options")
            return problem(422, "Unknown key \"" + key + "\"; the body has the keys scenario and options.",
                           {{base::append_token("", key), "unknown key"}});
    posted.text = document["scenario"].dump();
    if (!document.contains("options")) return posted;
    return read_options(document["options"], std::move(posted));
}

std::variant<PostedScenario, ApiResponse> read_posted_recommendation(const std::string& body) {
    auto read = read_body(body);
    if (auto* refusal = std::get_if<ApiResponse>(&read)) return std::move(*refusal);
    const json& document = std::get<json>(read);
    PostedScenario posted;
    posted.pictures = false;
    const auto fault = [&](const std::string& pointer, const std::string& detail) {
        posted.faults.emplace_back(base::ErrorCode::bad_input, pointer, detail);
    };
    if (!document.is_object()) return problem(422, "The body must be an object.", {{"", "must be an object"}});
    for (const auto& [key, value] : document.items())
        if (key != "scenario" && key != "recommend" && key != "options")
            fault(base::append_token("", key), "unknown key; the body has the keys scenario, recommend and options");
    json options = document.value("options", json::object());
    if (!options.is_object()) {
        fault("/options", "must be an object");
        options = json::object();
    }
    for (const auto& [key, value] : options.items())
        if (const std::string wrong = read_option(key, value, false, posted); !wrong.empty())
            fault(base::append_token("/options", key), wrong);
    const recommend::Request request =
        recommend::read_request(document.value("recommend", json::object()), "/recommend", posted.faults);
    if (!document.contains("scenario")) {
        fault("/scenario", "is missing");
        return problem_of(posted.faults);
    }
    posted.text = document["scenario"].dump();
    if (posted.faults.empty()) posted.recommend = recommend::to_json(request).dump();
    return posted;
}

std::variant<json, ApiResponse> examine_posted(Context& context, const PostedScenario& posted) {
    auto examined = context.examiner.examine(posted.text, posted.recommend);
    std::vector<base::Error> faults = posted.faults;
    if (const auto* wrong = std::get_if<std::vector<base::Error>>(&examined))
        faults.insert(faults.end(), wrong->begin(), wrong->end());
    if (!faults.empty()) return problem_of(faults);
    json& facts = std::get<json>(examined);
    const json& estimate = facts.at("estimate");
    const std::vector<ProblemPart> over = over_limits(estimate, posted.pictures, context.options.limits,
                                                      posted.recommend.empty() ? "" : "/recommend/budget");
    if (over.empty()) return std::move(facts);
    return problem(422, "The scenario costs more than this server allows: " + over[0].detail + ".", over,
                   {{"estimate", estimate}});
}

}  // namespace shadowbench::service

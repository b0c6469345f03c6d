#include "service/api/helper_side.h"

#include <algorithm>
#include <istream>
#include <limits>
#include <memory>
#include <new>
#include <ostream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/parallel.h"
#include "bench/pixel_curves.h"
#include "bench/run.h"
#include "document/document.h"
#include "recommend/check.h"
#include "render/estimate.h"
#include "scene/scenario.h"
#include "service/api/new_files.h"
#include "service/privacy/hidden_folders.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using nlohmann::json;

using Hidden = std::vector<HiddenFolder>;

Hidden hidden_of(const std::vector<fs::path>& data) {
    std::vector<std::string> names;
    for (const fs::path& folder : data) names.push_back(folder.string());
    return hidden_folders("", names);
}

json to_json(const Error& error, const Hidden& hidden) {
    const Error shown = hide(error, hidden);
    return {{"code", static_cast<int>(shown.code())}, {"where", shown.where()}, {"message", shown.message()}};
}

std::string fault(const Error& error, const Hidden& hidden) {
    return json{{"error", to_json(error, hidden)}}.dump();
}

template <class Answer>
std::string answer_line(const Hidden& hidden, const Answer& answer) {
    try {
        return answer();
    } catch (const Error& error) {
        return fault(error, hidden);
    } catch (const std::bad_alloc&) {
        return fault({ErrorCode::bad_input, "", "it needs more memory than this server allows"}, hidden);
    } catch (const std::exception&) {
        return fault({ErrorCode::internal, "", ""}, hidden);
    }
}

bench::RunOptions options_for(const std::vector<fs::path>& data) {
    bench::RunOptions options;
    options.data = scene::SearchPath::confined_to(data);
    options.limits.all = std::numeric_limits<std::size_t>::max();  // the server judges the estimate
    return options;
}

constexpr double process_start = 0.2;  // seconds: the libraries, and what a job writes at its end

struct Checked {
    bench::Validated facts;
    double picture_seconds = 0.0;  // as facts.seconds
};

std::uint64_t seed_of(const json& document) {
    return document.value(json::json_pointer("/rays/seed"), std::uint64_t{1});
}

// `recommend`: the text of a request; empty: the scenario is to be run.
Checked validate(const json& document, const std::string& recommend, const bench::RunOptions& options) {
    if (recommend.empty()) {
        Checked checked;
        checked.facts = bench::validate(document, options, {}, [&](const bench::VariantWork& first) {
            checked.picture_seconds = render::estimate_pictures(first, base::thread_count());
        });
        return checked;
    }
    std::vector<Error> faults;
    const recommend::Request request =
        recommend::read_request(scene::parse_json(recommend, "recommend"), "/recommend", faults);
    if (!faults.empty()) throw Error(faults.front());
    return {recommend::check(document, options, request, "/recommend"), 0.0};
}

json facts_of(const json& document, const std::string& recommend, const std::vector<fs::path>& data, double pace,
              const Hidden& hidden) {
    const auto [v, picture_seconds] = validate(document, recommend, options_for(data));
    json notes = json::array();
    for (const std::string& note : v.notes) notes.push_back(hide(note, hidden));
    for (const std::string& light : v.blind)
        notes.push_back(fmt::format("light {} sees nothing that casts a shadow", light));
    return {{"name", v.name},
            {"seed", seed_of(document)},
            {"hash", base::hash_text(document.dump())},
            {"variants", v.variants},
            {"lights", v.lights},
            {"techniques", v.techniques},
            {"notes", notes},
            {"estimate",
             {{"seconds", process_start + std::max(v.seconds * pace, v.budget)},
              {"picture_seconds", picture_seconds * pace},
              {"bytes", v.least_bytes},
              {"resolution", v.largest_side},
              {"samples_per_pixel", v.most_samples}}}};
}

std::string examine(const std::string& line, const std::vector<fs::path>& data, double pace, const Hidden& hidden) {
    const std::size_t tab = line.find('\t');
    const json document = scene::parse_json(line.substr(0, tab), "scenario");
    try {
        return facts_of(document, tab == std::string::npos ? "" : line.substr(tab + 1), data, pace, hidden).dump();
    } catch (const Error& error) {
        if (error.code() != ErrorCode::bad_input) throw;
        json faults = json::array();
        for (const Error& each : document::all_faults(document, error)) faults.push_back(to_json(each, hidden));
        return json{{"faults", std::move(faults)}}.dump();
    }
}

}  // namespace

void examine_lines(const std::vector<fs::path>& data, double pace, std::istream& in, std::ostream& out) {
    const Hidden hidden = hidden_of(data);
    for (std::string line; std::getline(in, line);)
        out << answer_line(hidden, [&] {
            return line.starts_with(files_mark) ? scenario_around(line.substr(files_mark.size()), data)
                                                : examine(line, data, pace, hidden);
        }) << std::endl;
}

void curve_lines(const std::vector<fs::path>& data, const std::string& light, std::size_t variant, std::istream& in,
                 std::ostream& out) {
    const Hidden hidden = hidden_of(data);
    std::string scenario;
    std::getline(in, scenario);
    std::unique_ptr<bench::PixelProbe> probe;
    int x = 0, y = 0;
    while (in >> x >> y)
        out << answer_line(hidden, [&] {
            if (!probe)
                probe = std::make_unique<bench::PixelProbe>(scene::parse_json(scenario, "scenario"), options_for(data),
                                                            light, variant);
            return bench::to_json(probe->at(x, y)).dump();
        }) << std::endl;
}

}  // namespace shadowbench::service

#include "compare/history.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "compare/compare.h"
#include "metrics/drift.h"
#include "metrics/statistics.h"

namespace shadowbench::compare {
namespace {

using nlohmann::ordered_json;

struct Run {
    Suite suite;
    std::string file;
};

struct Point {
    const Run* run;
    double value;
    std::optional<metrics::Interval> interval;
    std::string key;  // only points of equal keys are compared
};

struct Series {
    std::string unit;
    bool time = false;
    std::vector<Point> points;
};

using AllSeries = std::map<std::string, std::map<std::string, Series>>;  // by title and measure

std::vector<Run> read_runs(const std::filesystem::path& path) {
    std::vector<Run> runs;
    for (const auto& file : result_files(path)) {
        Measured measured;
        add(measured, read_json(file), file.string());
        for (Suite& suite : measured.suites) runs.push_back({std::move(suite), file.string()});
    }
    if (runs.empty())
        throw base::Error(base::ErrorCode::bad_input, path.string(),
                          "holds no result of shadowbench run or of a kernel program");
    std::stable_sort(runs.begin(), runs.end(),
                     [](const Run& a, const Run& b) { return a.suite.started < b.suite.started; });
    return runs;
}

void add_cell(AllSeries& all, const Run& run, const Cell& cell) {
    const std::string title = title_of(run.suite.name, cell.group, cell.name);
    const std::string key = run.suite.hash + '\n' + cell.version;
    for (const Exact& exact : cell.exact)
        all[title][exact.name].points.push_back({&run, exact.value, std::nullopt, key});
    for (const Timed& timed : cell.timed) {
        const Process& process = timed.processes.at(0);
        const bool floor = !process.ratio.empty();
        const std::vector<double>& samples = floor ? process.ratio : process.raw;
        Series& series = all[title][timed.name];
        series.time = true;
        series.unit = floor ? over_floor : timed.unit;
        series.points.push_back({&run, metrics::median(samples), metrics::median_interval(samples),
                                 key + '\n' + run.suite.machine + '\n' + series.unit});
    }
}

ordered_json number_or_null(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json drift_of(const Series& series, const HistoryOptions& options) {
    std::vector<const Point*> last;
    for (auto point = series.points.rbegin(); point != series.points.rend() && last.size() < options.last; ++point)
        if (std::isfinite(point->value) && point->key == series.points.back().key) last.push_back(&*point);
    std::reverse(last.begin(), last.end());
    std::vector<double> values;
    for (const Point* point : last) values.push_back(point->value);
    const auto line = metrics::drift(values, series.time ? options.effect : 0.0);
    if (!line) return nullptr;
    return {{"from", line->first},
            {"to", line->last},
            {"ratio", line->first == 0.0 ? ordered_json(nullptr) : number_or_null(line->last / line->first)},
            {"since", last.front()->run->suite.started}};
}

ordered_json to_json(const std::string& name, const Series& series, const HistoryOptions& options) {
    ordered_json points = ordered_json::array();
    for (const Point& point : series.points)
        points.push_back({{"run", point.run->suite.started},
                          {"commit", point.run->suite.commit},
                          {"value", number_or_null(point.value)},
                          {"low", point.interval ? number_or_null(point.interval->low) : ordered_json(nullptr)},
                          {"high", point.interval ? number_or_null(point.interval->high) : ordered_json(nullptr)}});
    return {{"name", name}, {"unit", series.unit}, {"points", points}, {"drift", drift_of(series, options)}};
}

}  // namespace

nlohmann::ordered_json history_json(const std::filesystem::path& path, const HistoryOptions& options) {
    const std::vector<Run> runs = read_runs(path);
    AllSeries all;
    ordered_json cells = ordered_json::array(), list = ordered_json::array();
    for (const Run& run : runs) {
        list.push_back({{"started", run.suite.started}, {"commit", run.suite.commit}, {"file", run.file}});
        for (const Cell& cell : run.suite.cells) add_cell(all, run, cell);
    }
    for (const auto& [title, series] : all) {
        ordered_json measures = ordered_json::array();
        for (const auto& [name, points] : series) measures.push_back(to_json(name, points, options));
        cells.push_back({{"title", title}, {"measures", std::move(measures)}});
    }
    return {{"cells", std::move(cells)}, {"runs", std::move(list)}};
}

std::string history_text(const nlohmann::ordered_json& history) {
    std::string text;
    std::size_t measures = 0, drifts = 0;
    for (const ordered_json& cell : history.at("cells"))
        for (const ordered_json& measure : cell.at("measures")) {
            ++measures;
            const ordered_json& drift = measure.at("drift");
            if (drift.is_null()) continue;
            ++drifts;
            const std::string unit = measure.at("unit").get<std::string>();
            text += fmt::format(
                "{}: {} drifts: {:.6g} -> {:.6g}{}{} since {}\n", cell.at("title").get<std::string>(),
                measure.at("name").get<std::string>(), drift.at("from").get<double>(), drift.at("to").get<double>(),
                unit.empty() ? "" : " " + unit,
                drift.at("ratio").is_null() ? "" : fmt::format(" (x{:.3f})", drift.at("ratio").get<double>()),
                drift.at("since").get<std::string>());
        }
    const auto counted = [](std::size_t count, const char* what) {
        return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    return text + fmt::format("{}, {}, {}; {}\n", counted(history.at("runs").size(), "result"),
                              counted(history.at("cells").size(), "cell"), counted(measures, "measure"),
                              counted(drifts, "drift"));
}

}  // namespace shadowbench::compare

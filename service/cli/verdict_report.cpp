#include "service/cli/verdict_report.h"

#include <charconv>
#include <map>
#include <ostream>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_files.h"
#include "compare/report.h"
#include "results/write_result.h"
#include "service/cli/terminal.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

void check_names(const compare::Comparison& comparison) {
    std::set<std::string> known;
    for (const compare::Line& line : comparison.lines)
        if (!line.time && !line.measure.empty() && line.measure != "promises") known.insert(line.measure);
    if (known.empty()) return;
    std::string names;
    for (const std::string& name : known) names += ", " + name;
    for (const auto& [name, value] : comparison.options.tolerance)
        if (known.count(name) == 0)
            throw Error(ErrorCode::usage, "--tolerance " + name,
                        "no cell has such a measure; there are: " + names.substr(2));
}

void check_places(const VerdictArguments& arguments) {
    std::map<std::string, int> uses;
    for (const std::string* place : {&arguments.markdown, &arguments.junit, &arguments.json})
        if (!place->empty() && ++uses[*place] > 1)
            throw Error(ErrorCode::usage, *place,
                        "only one of --markdown, --junit and --json can go there; give the others another file");
}

}  // namespace

compare::Options verdict_options(const VerdictArguments& arguments) {
    check_places(arguments);
    compare::Options options;
    options.effect = arguments.effect / 100.0;
    options.allow_missing = arguments.allow_missing;
    for (const std::string& text : arguments.tolerance) {
        const std::size_t equals = text.find('=');
        double value = -1.0;
        if (equals != std::string::npos && equals > 0) {
            const char *const first = text.data() + equals + 1, *const end = text.data() + text.size();
            const auto [stop, failed] = std::from_chars(first, end, value);
            if (failed != std::errc() || stop != end) value = -1.0;
        }
        if (!(value >= 0.0 && value <= 1e9))
            throw Error(ErrorCode::usage, "--tolerance " + text,
                        "expected measure=relative tolerance, as in lookup_error.rms=0.01");
        options.tolerance[text.substr(0, equals)] = value;
    }
    return options;
}

int report_verdict(const compare::Comparison& comparison, const VerdictArguments& arguments, std::ostream& out) {
    check_names(comparison);
    const std::string json = compare::to_json(comparison).dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::vector<std::pair<std::string, std::string>> forms = {
        {arguments.markdown, compare::to_markdown(comparison)},
        {arguments.junit, compare::to_junit(comparison)},
        {arguments.json, json + "\n"}};
    std::vector<base::NewFile> files;
    bool printed = false;
    for (const auto& [file, content] : forms) {
        if (file == "-") {
            out << content;
            printed = true;
        } else if (!file.empty()) {
            files.push_back({file, content});
        }
    }
    if (!printed)  // elsewhere than on a terminal each verdict is one line, to be found by other programs
        out << compare::to_text(comparison, arguments.all, is_terminal(out) ? line_width(out) : std::string::npos);
    base::write_files(files);
    if (!printed)
        for (const base::NewFile& file : files) out << fmt::format("written: {}\n", file.path.string());
    return compare::exit_code(comparison);
}

}  // namespace shadowbench::service

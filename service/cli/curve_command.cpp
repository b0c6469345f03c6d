#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/functions.h"
#include "curves/functions_file.h"
#include "document/technique_choice.h"
#include "service/cli/commands.h"

namespace shadowbench::service {
namespace {

// FILE for one technique; FILE.1-deep, FILE.2-avsm, ... for several.
std::string dump_name(const std::string& file, const std::vector<bench::FunctionResult>& results, std::size_t i) {
    return results.size() == 1 ? file : fmt::format("{}.{}-{}", file, i + 1, results[i].technique);
}

void print_json(const std::vector<bench::FunctionResult>& results, std::ostream& out) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const bench::FunctionResult& result : results) list.push_back(bench::to_json(result));
    out << nlohmann::ordered_json{{"techniques", std::move(list)}}.dump(1) << "\n";
}

}  // namespace

void curve_command(const CurveArguments& arguments, std::ostream& out) {
    std::vector<document::TechniqueChoice> techniques;
    for (const std::string& text : arguments.techniques) techniques.push_back(document::read_technique(text));
    const std::vector<curves::Curve> functions = curves::read_functions(arguments.functions);
    if (functions.empty())
        throw base::Error(base::ErrorCode::bad_input, arguments.functions, "the file holds no function");
    const std::vector<bench::FunctionResult> results =
        bench::measure_functions(functions, techniques, arguments.repetitions);
    if (!arguments.dump.empty())
        for (std::size_t i = 0; i < results.size(); ++i)
            curves::write_functions(dump_name(arguments.dump, results, i), results[i].stored);
    if (arguments.json)
        print_json(results, out);
    else
        out << bench::to_table(results);
}

}  // namespace shadowbench::service

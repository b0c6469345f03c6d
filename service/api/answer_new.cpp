// /v1/files and /v1/new: the files of the data folders, and scenarios around them.
#include <nlohmann/json.hpp>

#include "scene/scenario.h"
#include "service/api/new_files.h"
#include "service/api/problem.h"
#include "service/api/routes.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t most_listed = 1000;

}  // namespace

ApiResponse list_files(Context& context, const Call&) {
    const DataFiles found = data_files(context.options.data, most_listed, context.options.state);
    nlohmann::json files = nlohmann::json::array();
    for (const NamedFile& file : found.files) files.push_back({{"name", file.name}, {"bytes", file.bytes}});
    return json_answer(200, nlohmann::json{{"files", std::move(files)}, {"more", found.more}});
}

ApiResponse new_scenario(Context& context, const Call& call) {
    std::string request;
    try {
        request = scene::parse_json(call.request.body, "body").dump();
    } catch (const base::Error& error) {
        return problem(400, error.what());
    }
    return json_answer(200, nlohmann::ordered_json::parse(context.examiner.arrange(request)));
}

}  // namespace shadowbench::service

#include <filesystem>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/write_files.h"
#include "results/report.h"
#include "results/write_result.h"
#include "service/cli/commands.h"
#include "service/web/report.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

nlohmann::json read_result(const fs::path& file) {
    const nlohmann::json result = nlohmann::json::parse(base::read_text(file), nullptr, false);
    const auto version = result.is_object() ? result.find("schema_version") : result.end();
    if (!result.is_object() || version == result.end() || !result.contains("variants"))
        throw Error(ErrorCode::bad_input, file.string(), "not a result of run");
    if (*version != results::result_schema_version)
        throw Error(ErrorCode::bad_input, file.string() + "/schema_version",
                    fmt::format("version {}, but this program reads version {}; run the scenario again",
                                version->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace),
                                results::result_schema_version));
    return result;
}

}  // namespace

void report_command(const ReportArguments& arguments, std::ostream& out) {
    const fs::path folder = arguments.folder;
    if (!fs::is_directory(folder))
        throw Error(ErrorCode::no_such_file, arguments.folder,
                    "no such folder; give the one in which run wrote result.json");
    const nlohmann::json result = read_result(folder / "result.json");
    const fs::path images = arguments.images.empty() ? folder / "images" : fs::path(arguments.images);
    if (!arguments.images.empty() && !fs::exists(images / "images.json"))
        throw Error(ErrorCode::no_such_file, (images / "images.json").string(), "no such file; render writes it");
    const fs::path file = arguments.out.empty() ? folder / "report.html" : fs::path(arguments.out);
    const std::string page = report_html(result, images);
    base::write_files({{file, page}});
    out << fmt::format("written: {} ({} KiB{})\n", file.string(), page.size() / 1024,
                       fs::exists(images / "images.json") ? "" : ", without pictures: render makes them");
}

}  // namespace shadowbench::service

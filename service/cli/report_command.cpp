#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/write_files.h"
#include "results/report.h"
#include "results/settled.h"
#include "results/sweep_cell.h"
#include "results/write_result.h"
#include "service/cli/commands.h"
#include "service/web/gallery.h"
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

// "2026-11-30.json".
bool is_of_a_day(const fs::path& file) {
    std::string form = file.filename().string();
    std::replace_if(
        form.begin(), form.end(), [](char c) { return c >= '0' && c <= '9'; }, '0');
    return form == "0000-00-00.json";
}

// The results that lie in the folders of this folder, as results/machines has them, by path; empty if there are none.
std::vector<fs::path> results_of_machines(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const auto& machine : fs::directory_iterator(folder, ignored))
        for (const auto& entry : fs::directory_iterator(machine.path(), ignored))
            if (entry.is_regular_file(ignored) && is_of_a_day(entry.path())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool was_quiet(const results::LightResult& light) {
    const results::Settling found = results::settling(light);
    return found.known() && found.settled();
}

void add_gallery_rows(const fs::path& file, std::vector<GalleryRow>& rows) {
    const results::Result result = results::from_json(read_result(file), file.string());
    for (const results::VariantResult& variant : result.variants) {
        std::string settings;
        for (const document::Setting& setting : variant.settings)
            settings += fmt::format(", {} = {}", setting.pointer, setting.value);
        for (const results::LightResult& light : variant.lights) {
            GalleryRow row{result.name, light.name + settings, file.parent_path().filename().string(),
                           file.stem().string(), results::machine_text(result.machine), result.program.version,
                           was_quiet(light), {}};
            for (const results::Cell& cell : light.cells) {
                if (!cell.times) continue;
                const results::LookupTimes& lookup = cell.times->random_order;
                row.cells.emplace_back(
                    results::title(cell),
                    fmt::format("{:.3g} ns{}", lookup.ns.median,
                                lookup.ratio ? fmt::format(", {:.1f} x floor", lookup.ratio->median) : ""));
            }
            rows.push_back(std::move(row));
        }
    }
}

// The page of results/machines.
void report_machines(const std::vector<fs::path>& files, const fs::path& page, std::ostream& out) {
    std::vector<GalleryRow> rows;
    for (const fs::path& file : files) add_gallery_rows(file, rows);
    base::write_files({{page, gallery_html(rows)}});
    out << fmt::format("written: {} ({} result{})\n", page.string(), files.size(), files.size() == 1 ? "" : "s");
}

}  // namespace

void report_command(const ReportArguments& arguments, std::ostream& out) {
    const fs::path folder = arguments.folder;
    if (!fs::is_directory(folder))
        throw Error(ErrorCode::no_such_file, arguments.folder,
                    "no such folder; give the one in which run wrote result.json");
    if (!fs::exists(folder / "result.json") && arguments.images.empty())
        if (const std::vector<fs::path> machines = results_of_machines(folder); !machines.empty()) {
            report_machines(machines, arguments.out.empty() ? folder / "report.html" : fs::path(arguments.out), out);
            return;
        }
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

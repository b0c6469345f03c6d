#include <charconv>
#include <filesystem>
#include <ostream>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_files.h"
#include "document/document.h"
#include "scene/json_text.h"
#include "scene/new_scenario.h"
#include "service/api/new_files.h"
#include "service/cli/file_commands.h"
#include "service/cli/progress_bar.h"

namespace shadowbench::service {
namespace {

std::variant<std::monostate, std::string, int> name_or_number(const std::string& text) {
    if (text.empty()) return {};
    int number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data(), end, number);
    if (fault == std::errc() && rest == end && number >= 0) return number;
    return text;
}

// The name under which a scenario in the file `out` finds the file: relative to the folder of `out`, except that an
// absolute name stays absolute where it leads out of that folder.
std::string name_from(const std::string& given, const std::string& out) {
    namespace fs = std::filesystem;
    if (out.empty()) return given;
    const fs::path file = given, folder = fs::absolute(out).lexically_normal().parent_path();
    const fs::path name = fs::absolute(file).lexically_normal().lexically_proximate(folder);
    return file.is_absolute() && *name.begin() == ".." ? given : name.string();
}

// A scenario is edited by hand, unlike what other commands write: it is not lost by a name used twice.
void refuse_existing(const NewArguments& arguments) {
    std::error_code ignored;
    if (!arguments.out.empty() && !arguments.force && std::filesystem::is_regular_file(arguments.out, ignored))
        throw base::Error(base::ErrorCode::usage, "--out " + arguments.out,
                          "the file exists; choose another name, or give --force to write over it");
}

// Refuses to write the scenario over a data file.
void check_out(const std::string& out, const std::string& file) {
    std::error_code ignored;
    if (!out.empty() && std::filesystem::equivalent(out, file, ignored))
        throw base::Error(base::ErrorCode::usage, "--out " + out, "this is one of the data files; choose another name");
}

}  // namespace

scene::DataFile read_data(const FileArguments& arguments, const std::string& file, std::ostream& err) {
    scene::FileChoice choice;
    choice.grid = name_or_number(arguments.grid);
    choice.deep.part = name_or_number(arguments.part);
    if (!arguments.layer.empty()) choice.deep.layer = arguments.layer;
    ProgressBar bar(err);
    bar.show({std::filesystem::path(file).filename().string(), "read", 0, 0});
    return scene::read_data_file(file, choice);
}

void new_command(const NewArguments& arguments, std::ostream& out, std::ostream& err) {
    std::vector<scene::DataFile> files;
    std::vector<std::string> names;
    for (const std::string& file : arguments.files) {
        check_out(arguments.out, file);
        files.push_back(read_data(arguments, file, err));
        names.push_back(name_from(file, arguments.out));
    }
    refuse_existing(arguments);
    const scene::UpAxis up = arguments.up == "z" ? scene::UpAxis::z : scene::UpAxis::y;
    const std::string text = scene::in_lines(scene::new_scenario(files, names, fitting_techniques(files), up)) + "\n";
    document::check_document(nlohmann::json::parse(text));
    if (arguments.out.empty()) {
        out << text;
        return;
    }
    base::write_files({base::NewFile{arguments.out, text}});
    out << fmt::format("written: {}\n", arguments.out);
}

}  // namespace shadowbench::service

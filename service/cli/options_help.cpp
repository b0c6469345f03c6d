#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/nearest.h"
#include "base/write_files.h"
#include "service/cli/options_model.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

std::vector<HelpFile> all_help_files(const CLI::App& app) {
    const HelpModel model = help_model(app);
    std::vector<HelpFile> files = manual_pages(model);
    files.push_back(bash_completion(model));
    files.push_back(zsh_completion(model));
    files.push_back(fish_completion(model));
    return files;
}

void print_help_file(const std::vector<HelpFile>& files, const std::string& name, std::ostream& out) {
    std::vector<std::string> names;
    std::string listed;
    for (const HelpFile& file : files) {
        if (file.path == name) {
            out << file.text;
            return;
        }
        names.push_back(file.path);
        listed += (listed.empty() ? "" : ", ") + file.path;
    }
    throw base::Error(base::ErrorCode::usage, "FILE " + name,
                      "there is no such file" + base::perhaps(name, names) + "; there are: " + listed);
}

struct HelpFileArguments {
    std::string name, out;
};

}  // namespace

// Not in --help: the build makes the files of an installation with it.
void add_help_commands(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<HelpFileArguments>();
    CLI::App* files = app.add_subcommand("help-files", "Print a manual page or a shell's completion, or write them all");
    files->group("");
    CLI::Option* name = files->add_option("FILE", arguments->name, "Its path below share/");
    add_folder_option(*files, arguments->out, "Write all files below this folder, which stands for share/");
    files->get_option("--out")->excludes(name);
    commands.push_back({files, [arguments, &app](std::ostream& out, std::ostream&) {
                            const std::vector<HelpFile> all = all_help_files(app);
                            if (arguments->out.empty()) {
                                print_help_file(all, arguments->name, out);
                                return 0;
                            }
                            std::vector<base::NewFile> written;
                            for (const HelpFile& file : all)
                                written.push_back({std::filesystem::path(arguments->out) / file.path, file.text});
                            base::write_files(written);
                            return 0;
                        }});
}

}  // namespace shadowbench::service

// What --help knows about the program, for other forms of it: manual pages and completions of shells.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shadowbench::service {

struct HelpOption {
    std::vector<std::string> names;   // "--set", "-h"; of an argument: "SCENARIO"
    std::string value;                // "TEXT"; empty: a flag
    std::string range;                // "INT in [0 - 4096]"; may be empty
    std::vector<std::string> words;   // that the value must be one of, or is often; may be empty
    std::string text, standard;       // the description, and the value without the option
    bool required = false, repeatable = false;
};

struct HelpCommand {
    std::string name, text, group, footer;
    std::vector<HelpOption> options, arguments;
};

struct HelpModel {
    std::string version;
    HelpCommand program;
    std::vector<HelpCommand> commands;  // in the order of --help, without those that it hides
};

HelpModel help_model(const CLI::App& app);

// A file for a shell or for man, and its place below the share/ folder of an installation.
struct HelpFile {
    std::string path, text;
};
HelpFile bash_completion(const HelpModel& model);
HelpFile zsh_completion(const HelpModel& model);
HelpFile fish_completion(const HelpModel& model);
// One for the program, and one for each command.
std::vector<HelpFile> manual_pages(const HelpModel& model);

// Up to the end of the first sentence, for a line in a list.
std::string first_sentence(const std::string& text);

}  // namespace shadowbench::service

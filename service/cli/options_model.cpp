#include "service/cli/options_model.h"

#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>

#include "results/program.h"
#include "techniques/technique.h"

namespace shadowbench::service {
namespace {

// The words of "TEXT:{rms,max}".
std::vector<std::string> words_of_type(const std::string& type) {
    const std::size_t open = type.find('{'), close = type.rfind('}');
    std::vector<std::string> words;
    if (open == std::string::npos || close == std::string::npos || close < open) return words;
    std::istringstream list(type.substr(open + 1, close - open - 1));
    for (std::string word; std::getline(list, word, ',');) words.push_back(word);
    return words;
}

HelpOption help_option(const CLI::Option& option) {
    HelpOption help;
    if (option.get_positional()) {
        help.names = {option.get_name(true, false)};
    } else {
        for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
    }
    const bool flag = option.get_items_expected_max() == 0;
    const std::string type = flag ? "" : option.get_type_name();
    help.value = type.substr(0, type.find(':'));
    help.words = words_of_type(type);
    if (help.words.empty() && type.find(':') != std::string::npos) help.range = type.substr(type.find(':') + 1);
    const bool of_techniques = option.check_lname("only") || option.check_lname("technique");
    if (of_techniques)
        for (const techniques::Technique& row : techniques::all()) help.words.push_back(row.id);
    help.text = option.get_description();
    help.standard = flag ? "" : option.get_default_str();
    help.required = option.get_required();
    help.repeatable = option.get_items_expected_max() > 1;
    return help;
}

HelpCommand help_command(const CLI::App& app) {
    HelpCommand help{app.get_name(), app.get_description(), app.get_group(), app.get_footer(), {}, {}};
    for (const CLI::Option* option : app.get_options())
        (option->get_positional() ? help.arguments : help.options).push_back(help_option(*option));
    return help;
}

}  // namespace

HelpModel help_model(const CLI::App& app) {
    HelpModel model{results::this_program().version, help_command(app), {}};
    for (const CLI::App* command : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
        model.commands.push_back(help_command(*command));
    return model;
}

std::string first_sentence(const std::string& text) {
    return text.substr(0, std::min(text.find(". "), text.size()));
}

}  // namespace shadowbench::service

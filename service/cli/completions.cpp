#include <algorithm>

#include <fmt/format.h>

#include "service/cli/options_model.h"

namespace shadowbench::service {
namespace {

// The first line of each entry of `list scenarios` begins with the name. bash would run a command that is in one, so
// names with other characters than these are left out.
constexpr const char* scenario_names =
    "shadowbench list scenarios 2>/dev/null | sed -n 's/^\\([A-Za-z0-9_][A-Za-z0-9_./+-]*\\)  .*/\\1/p'";

std::string joined(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, " "));
}

bool takes_scenarios(const HelpCommand& command) {
    return std::any_of(command.arguments.begin(), command.arguments.end(),
                       [](const HelpOption& argument) { return argument.names[0] == "SCENARIO"; });
}

// What the arguments may be, besides files and scenarios.
std::vector<std::string> argument_words(const HelpCommand& command) {
    std::vector<std::string> words;
    for (const HelpOption& argument : command.arguments)
        words.insert(words.end(), argument.words.begin(), argument.words.end());
    return words;
}

std::vector<std::string> option_names(const std::vector<HelpOption>& options) {
    std::vector<std::string> names;
    for (const HelpOption& option : options) names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

// In single quotes, as all three shells take it.
std::string quoted_for_shell(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

// Without the characters that end a part of a specification for zsh.
std::string zsh_text(const std::string& text) {
    std::string plain;
    for (const char c : first_sentence(text)) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') plain += '\\';
        plain += c;
    }
    return plain;
}

std::string bash_case(const HelpCommand& command) {
    std::string values;
    for (const HelpOption& option : command.options) {
        if (option.value.empty()) continue;
        values += fmt::format("                {}) words={}; takes=1 ;;\n", fmt::join(option.names, "|"),
                              quoted_for_shell(joined(option.words)));
    }
    std::string text = fmt::format("        {})\n            options={}\n            names={}\n", command.name,
                                   quoted_for_shell(joined(option_names(command.options))),
                                   quoted_for_shell(joined(argument_words(command))));
    if (takes_scenarios(command)) text += "            scenarios=1\n";
    if (!values.empty()) text += "            case $previous in\n" + values + "            esac\n";
    return text + "            ;;\n";
}

std::string zsh_argument(const HelpOption& argument) {
    const std::string action = argument.names[0] == "SCENARIO" ? "_shadowbench_scenarios"
                               : argument.words.empty()        ? "_files"
                                                               : "(" + joined(argument.words) + ")";
    return quoted_for_shell((argument.repeatable ? "*:" : ":") + argument.names[0] + ":" + action);
}

std::string zsh_option(const HelpOption& option, const std::string& name) {
    const bool is_long = name.rfind("--", 0) == 0;
    std::string text = (option.repeatable ? "*" : "") + name;
    if (!option.value.empty() && is_long) text += "=";
    text += "[" + zsh_text(option.text) + "]";
    if (!option.value.empty())
        text += ":" + option.value + ":" + (option.words.empty() ? "_files" : "(" + joined(option.words) + ")");
    return quoted_for_shell(text);
}

std::string fish_option(const std::string& condition, const HelpOption& option) {
    std::string text = "complete -c shadowbench -n " + condition;
    for (const std::string& name : option.names)
        text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty())
        text += option.words.empty() ? " -r -F" : " -x -a " + quoted_for_shell(joined(option.words));
    return text + " -d " + quoted_for_shell(first_sentence(option.text)) + "\n";
}

}  // namespace

HelpFile bash_completion(const HelpModel& model) {
    std::vector<std::string> first = option_names(model.program.options);
    for (const HelpCommand& command : model.commands) first.push_back(command.name);
    std::string text = R"bash(# Completion of shadowbench for bash.
_shadowbench() {
    local current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD - 1]}"
    local options= names= words= takes= scenarios=
    # bash takes the = of --option=value for a word of its own.
    if [[ $current == = ]]; then
        current=
    elif [[ $previous == = ]]; then
        previous="${COMP_WORDS[COMP_CWORD - 2]}"
    fi
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
)bash";
    text += fmt::format("        COMPREPLY=($(compgen -W {} -- \"$current\"))\n", quoted_for_shell(joined(first)));
    text += "        return\n    fi\n    case ${COMP_WORDS[1]} in\n";
    for (const HelpCommand& command : model.commands) text += bash_case(command);
    text += fmt::format(R"bash(    esac
    if [[ $takes ]]; then
        names=$words
    elif [[ $current == -* ]]; then
        names=$options
    elif [[ $scenarios ]]; then
        names="$names $({})"
    fi
    COMPREPLY=($(compgen -W "$names" -- "$current"))
}}
complete -o default -F _shadowbench shadowbench
)bash",
                        scenario_names);
    return {"bash-completion/completions/shadowbench", text};
}

HelpFile zsh_completion(const HelpModel& model) {
    std::string text = "#compdef shadowbench\n# Completion of shadowbench for zsh.\n_shadowbench_scenarios() {\n";
    text += fmt::format("    local -a names\n    names=($({}))\n", scenario_names);
    text += "    compadd -a names\n    _files\n}\n_shadowbench() {\n    local -a commands\n    commands=(\n";
    for (const HelpCommand& command : model.commands)
        text += "        " + quoted_for_shell(command.name + ":" + first_sentence(command.text)) + "\n";
    text +=
        "    )\n    if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then\n        _describe command commands\n"
        "        return\n    fi\n    if ((CURRENT == 2)); then\n        _arguments";
    for (const HelpOption& option : model.program.options)
        for (const std::string& name : option.names) text += " " + zsh_option(option, name);
    text += "\n        return\n    fi\n    shift words\n    ((CURRENT--))\n    case $words[1] in\n";
    for (const HelpCommand& command : model.commands) {
        text += "        " + command.name + ")\n            _arguments";
        for (const HelpOption& option : command.options)
            for (const std::string& name : option.names) text += " \\\n                " + zsh_option(option, name);
        for (const HelpOption& argument : command.arguments) text += " \\\n                " + zsh_argument(argument);
        text += "\n            ;;\n";
    }
    return {"zsh/site-functions/_shadowbench", text + "    esac\n}\n_shadowbench \"$@\"\n"};
}

HelpFile fish_completion(const HelpModel& model) {
    std::string text = "# Completion of shadowbench for fish.\n";
    for (const HelpOption& option : model.program.options) text += fish_option("__fish_use_subcommand", option);
    for (const HelpCommand& command : model.commands)
        text += "complete -c shadowbench -n __fish_use_subcommand -f -a " + command.name + " -d " +
                quoted_for_shell(first_sentence(command.text)) + "\n";
    for (const HelpCommand& command : model.commands) {
        const std::string condition = "'__fish_seen_subcommand_from " + command.name + "'";
        for (const HelpOption& option : command.options) text += fish_option(condition, option);
        if (takes_scenarios(command))
            text += "complete -c shadowbench -n " + condition + " -a " +
                    quoted_for_shell("(" + std::string(scenario_names) + ")") + "\n";
        if (const std::vector<std::string> words = argument_words(command); !words.empty())
            text += "complete -c shadowbench -n " + condition + " -f -a " + quoted_for_shell(joined(words)) + "\n";
    }
    return {"fish/vendor_completions.d/shadowbench.fish", text};
}

}  // namespace shadowbench::service

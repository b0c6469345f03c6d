#include <fmt/format.h>

#include "compare/measured.h"

namespace shadowbench::compare {
namespace {

// A word for the shell, in quotes if it needs them.
std::string quoted(const std::string& text) {
    const char* const plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_./=:,+@%";
    if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

std::string regex_escaped(const std::string& name) {
    std::string result;
    for (const char c : name) {
        if (std::string("\\^$.|?*+()[]{}").find(c) != std::string::npos) result += '\\';
        result += c;
    }
    return result;
}

std::vector<std::string> kernel_arguments(const std::vector<Rerun>& reruns) {
    std::string names;
    for (const Rerun& rerun : reruns) names += (names.empty() ? "" : "|") + regex_escaped(rerun.source);
    std::vector<std::string> arguments{fmt::format("--benchmark_filter=^({})$", names)};
    arguments.insert(arguments.end(), reruns[0].given.begin(), reruns[0].given.end());
    return arguments;
}

}  // namespace

std::vector<std::string> arguments_of(const std::vector<Rerun>& reruns) {
    const Rerun& first = reruns.at(0);
    if (first.kernel) return kernel_arguments(reruns);
    std::vector<std::string> arguments{"run", first.source};
    arguments.insert(arguments.end(), first.given.begin(), first.given.end());
    std::string techniques;
    for (const Rerun& rerun : reruns) {
        if (rerun.technique.empty()) {
            // The technique's parameters are not known: run all of its type.
            arguments.insert(arguments.end(), {"--only", rerun.only});
            return arguments;
        }
        techniques += (techniques.empty() ? "" : ",") + rerun.technique;
    }
    arguments.insert(arguments.end(), {"--set", "techniques=[" + techniques + "]"});
    if (!first.sweeps.empty()) arguments.insert(arguments.end(), {"--set", "sweeps=" + first.sweeps});
    return arguments;
}

std::string command_of(const Rerun& rerun) {
    if (rerun.counted)
        return fmt::format("shadowbench instructions --kernels {} --filter {} --out counts.json", quoted(rerun.program),
                           quoted("^" + regex_escaped(rerun.source) + "$"));
    std::string line = quoted(rerun.program);
    for (const std::string& argument : arguments_of({rerun})) line += " " + quoted(argument);
    return line;
}

}  // namespace shadowbench::compare

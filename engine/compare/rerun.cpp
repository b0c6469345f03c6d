#include <fmt/format.h>

#include "base/shell_word.h"
#include "compare/measured.h"

namespace shadowbench::compare {
namespace {

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
        return fmt::format("shadowbench instructions --kernels {} --filter {} --out counts.json",
                           base::shell_word(rerun.program), base::shell_word("^" + regex_escaped(rerun.source) + "$"));
    std::string line = base::shell_word(rerun.program);
    for (const std::string& argument : arguments_of({rerun})) line += " " + base::shell_word(argument);
    return line;
}

}  // namespace shadowbench::compare

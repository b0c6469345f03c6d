#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>

#include "service/cli/options_model.h"

namespace shadowbench::service {
namespace {

// Text as roff shows it: a hyphen stays one that can be copied, and no line is taken for a request.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n'))
            escaped += std::string("\\&") + c;
        else
            escaped += c;
    }
    return escaped;
}

std::string bold(const std::string& text) {
    return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + roff(text) + "\\fR";
}

std::string section(const char* name) {
    return fmt::format(".SH {}\n", name);
}

std::string option_text(const HelpOption& option) {
    std::string head;
    for (const std::string& name : option.names) head += (head.empty() ? "" : ", ") + bold(name);
    if (!option.value.empty() && option.names[0][0] == '-') head += " " + italic(option.value);
    std::string text = option.text;
    if (!option.standard.empty()) text += " [" + option.standard + "]";
    if (!option.range.empty()) text += ". " + option.range;
    if (option.repeatable && option.names[0][0] == '-') text += ". May be given several times";
    return ".TP\n" + head + "\n" + roff(text) + ".\n";
}

std::string list_of(const char* name, const std::vector<HelpOption>& options) {
    if (options.empty()) return "";
    std::string text = section(name);
    for (const HelpOption& option : options) text += option_text(option);
    return text;
}

// The examples of a footer stay lines as they are; the notes after them become paragraphs.
std::string footer_text(const std::string& footer) {
    std::string examples, notes;
    std::istringstream lines(footer);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("Example", 0) == 0 && line.back() == ':') continue;
        if (line.rfind("  ", 0) == 0)
            examples += roff(line.substr(2)) + "\n";
        else if (!line.empty())
            notes += (notes.empty() || line.rfind("Exit codes", 0) != 0 ? "" : ".PP\n") + roff(line) + "\n";
    }
    return (notes.empty() ? "" : section("NOTES") + notes) +
           (examples.empty() ? "" : section("EXAMPLES") + ".nf\n" + examples + ".fi\n");
}

std::string page_name(const HelpModel& model, const HelpCommand& command) {
    return model.program.name + "-" + command.name;
}

std::string heading(const HelpModel& model, const std::string& page, const std::string& text) {
    std::string upper = page;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return fmt::format(".TH {} 1 \"\" \"{} {}\" \"{}\"\n", roff(upper), model.program.name, model.version,
                       model.program.name) +
           section("NAME") + roff(page) + " \\- " + roff(first_sentence(text)) + "\n";
}

HelpFile page_file(const std::string& name, std::string text) {
    return {"man/man1/" + name + ".1", std::move(text)};
}

HelpFile program_page(const HelpModel& model) {
    const HelpCommand& program = model.program;
    std::string text = heading(model, program.name, program.text) + section("SYNOPSIS") + bold(program.name) + " " +
                       italic("COMMAND") + " [" + italic("OPTION") + "]...\n" + section("DESCRIPTION") +
                       roff(program.text) + "\n" + section("COMMANDS");
    std::string group;
    for (const HelpCommand& command : model.commands) {
        if (command.group != group) text += ".SS " + roff(command.group) + "\n";
        group = command.group;
        text += ".TP\n" + bold(command.name) + "\n" + roff(command.text) + ".\n";
    }
    text += list_of("OPTIONS", program.options) + footer_text(program.footer) + section("SEE ALSO");
    for (const HelpCommand& command : model.commands)
        text += fmt::format(".BR {} (1){}\n", roff(page_name(model, command)),
                            &command == &model.commands.back() ? "" : ",");
    return page_file(program.name, text);
}

HelpFile command_page(const HelpModel& model, const HelpCommand& command) {
    std::string text = heading(model, page_name(model, command), command.text) + section("SYNOPSIS") +
                       bold(model.program.name + " " + command.name) + " [" + italic("OPTION") + "]...";
    for (const HelpOption& argument : command.arguments) {
        const std::string name = italic(argument.names[0]) + (argument.repeatable ? "..." : "");
        text += argument.required ? " " + name : " [" + name + "]";
    }
    text += "\n" + section("DESCRIPTION") + roff(command.text) + ".\n" + list_of("ARGUMENTS", command.arguments) +
            list_of("OPTIONS", command.options) + footer_text(command.footer) + section("SEE ALSO") + ".BR " +
            roff(model.program.name) + " (1)\n";
    return page_file(page_name(model, command), text);
}

}  // namespace

std::vector<HelpFile> manual_pages(const HelpModel& model) {
    std::vector<HelpFile> pages{program_page(model)};
    for (const HelpCommand& command : model.commands) pages.push_back(command_page(model, command));
    return pages;
}

}  // namespace shadowbench::service

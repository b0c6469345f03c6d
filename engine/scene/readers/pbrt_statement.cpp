#include "scene/readers/pbrt_statement.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"

namespace shadowbench::scene {
namespace {

// What follows a word: texts, numbers, then parameters.
struct Form {
    std::string_view word;
    std::size_t texts, numbers;
    bool parameters;
};
constexpr std::array forms{
    Form{"Accelerator", 1, 0, true},
    Form{"ActiveTransform", 1, 0, false},  // its text is a bare word
    Form{"AreaLightSource", 1, 0, true},
    Form{"Attribute", 1, 0, true},
    Form{"AttributeBegin", 0, 0, false},
    Form{"AttributeEnd", 0, 0, false},
    Form{"Camera", 1, 0, true},
    Form{"ColorSpace", 1, 0, false},
    Form{"ConcatTransform", 0, 16, false},
    Form{"CoordSysTransform", 1, 0, false},
    Form{"CoordinateSystem", 1, 0, false},
    Form{"Film", 1, 0, true},
    Form{"Identity", 0, 0, false},
    Form{"Import", 1, 0, false},
    Form{"Include", 1, 0, false},
    Form{"Integrator", 1, 0, true},
    Form{"LightSource", 1, 0, true},
    Form{"LookAt", 0, 9, false},
    Form{"MakeNamedMaterial", 1, 0, true},
    Form{"MakeNamedMedium", 1, 0, true},
    Form{"Material", 1, 0, true},
    Form{"MediumInterface", 1, 0, false},  // or two texts
    Form{"NamedMaterial", 1, 0, false},
    Form{"ObjectBegin", 1, 0, false},
    Form{"ObjectEnd", 0, 0, false},
    Form{"ObjectInstance", 1, 0, false},
    Form{"Option", 0, 0, true},
    Form{"PixelFilter", 1, 0, true},
    Form{"ReverseOrientation", 0, 0, false},
    Form{"Rotate", 0, 4, false},
    Form{"Sampler", 1, 0, true},
    Form{"Scale", 0, 3, false},
    Form{"Shape", 1, 0, true},
    Form{"SurfaceIntegrator", 1, 0, true},
    Form{"Texture", 3, 0, true},
    Form{"Transform", 0, 16, false},
    Form{"TransformBegin", 0, 0, false},
    Form{"TransformEnd", 0, 0, false},
    Form{"TransformTimes", 0, 2, false},
    Form{"Translate", 0, 3, false},
    Form{"VolumeIntegrator", 1, 0, true},
    Form{"WorldBegin", 0, 0, false},
    Form{"WorldEnd", 0, 0, false},
};

constexpr std::size_t most_numbers = 3 * max_mesh_elements;  // of a parameter

std::string_view shown(std::string_view text) {
    return text.substr(0, 40);
}

[[noreturn]] void fail_at(const std::string& file, std::size_t line, const std::string& message) {
    throw base::Error(base::ErrorCode::bad_input, fmt::format("{}:{}", file, line), message);
}

}  // namespace

const PbrtParameter* PbrtStatement::find(std::string_view name) const {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const PbrtParameter& each) { return each.name == name; });
    return found == parameters.end() ? nullptr : &*found;
}

double PbrtStatement::number(std::string_view name, double otherwise) const {
    const PbrtParameter* parameter = find(name);
    if (!parameter) return otherwise;
    if (parameter->numbers.size() != 1) fail(fmt::format("\"{}\" needs one number", name));
    return parameter->numbers[0];
}

std::string PbrtStatement::text(std::string_view name, const std::string& otherwise) const {
    const PbrtParameter* parameter = find(name);
    if (!parameter) return otherwise;
    if (parameter->texts.size() != 1) fail(fmt::format("\"{}\" needs one text", name));
    return parameter->texts[0];
}

void PbrtStatement::fail(const std::string& message) const {
    fail_at(*file, line, message);
}

void PbrtStatements::fail(const std::string& message) const {
    fail_at(file_, line_, message);
}

void PbrtStatements::skip_space() {
    while (!left_.empty()) {
        if (left_[0] == '#') left_.remove_prefix(std::min(left_.find_first_of("\r\n"), left_.size()));
        if (left_.empty() || std::string_view(" \t\r\n\v\f").find(left_[0]) == std::string_view::npos) return;
        line_ += left_[0] == '\n';
        left_.remove_prefix(1);
    }
}

PbrtStatements::Kind PbrtStatements::peek() {
    skip_space();
    if (left_.empty()) return Kind::end;
    if (left_[0] == '"') return Kind::text;
    if (left_[0] == '[') return Kind::open;
    if (left_[0] == ']') return Kind::close;
    return std::string_view("+-.0123456789").find(left_[0]) == std::string_view::npos ? Kind::word : Kind::number;
}

PbrtStatements::Token PbrtStatements::take() {
    const Kind kind = peek();
    if (kind == Kind::end) return {};
    if (kind == Kind::text) return take_quoted();
    if (kind == Kind::word || kind == Kind::number) return take_bare();
    left_.remove_prefix(1);
    return {kind, {}, 0.0};
}

// A backslash keeps the quote that follows it from ending the text.
PbrtStatements::Token PbrtStatements::take_quoted() {
    std::size_t end = 1;
    while (end < left_.size() && left_[end] != '"' && left_[end] != '\n') end += left_[end] == '\\' ? 2 : 1;
    if (end >= left_.size() || left_[end] != '"') fail("a quotation mark has no other one on its line");
    const Token token{Kind::text, left_.substr(1, end - 1), 0.0};
    left_.remove_prefix(end + 1);
    return token;
}

PbrtStatements::Token PbrtStatements::take_bare() {
    const std::string_view word = left_.substr(0, std::min(left_.find_first_of(" \t\r\n\v\f\"[]#"), left_.size()));
    Token token{peek(), word, 0.0};
    left_.remove_prefix(word.size());
    if (token.kind == Kind::word) return token;
    const char* const begin = word.data() + (word[0] == '+');
    const auto [stop, fault] = std::from_chars(begin, word.data() + word.size(), token.number);
    if (fault != std::errc() || stop != word.data() + word.size() || !std::isfinite(token.number))
        fail(fmt::format("\"{}\" is not a finite number", shown(word)));
    return token;
}

// With or without brackets around them.
void PbrtStatements::take_numbers(std::size_t count, PbrtStatement& statement) {
    const bool bracketed = count > 0 && peek() == Kind::open;
    if (bracketed) take();
    for (std::size_t i = 0; i < count; ++i) {
        if (peek() != Kind::number) fail(fmt::format("{} needs {} numbers", statement.word, count));
        statement.numbers.push_back(take().number);
    }
    if (bracketed && take().kind != Kind::close) fail(fmt::format("{} needs {} numbers", statement.word, count));
}

void PbrtStatements::take_value(const Token& token, PbrtParameter& parameter) {
    if (token.kind == Kind::number) {
        if (parameter.numbers.size() >= most_numbers) fail(fmt::format("over {} numbers in a list", most_numbers));
        parameter.numbers.push_back(token.number);
    } else if (token.kind == Kind::text ||
               (token.kind == Kind::word && (token.text == "true" || token.text == "false"))) {
        parameter.texts.emplace_back(token.text);
    } else {
        fail(fmt::format("\"{}\" has a value that is neither a number nor a text", shown(parameter.name)));
    }
}

void PbrtStatements::take_parameters(PbrtStatement& statement) {
    while (peek() == Kind::text) {
        std::string_view declared = take().text;
        PbrtParameter parameter;
        const auto word = [&] {
            declared.remove_prefix(std::min(declared.find_first_not_of(" \t"), declared.size()));
            const std::size_t end = std::min(declared.find_first_of(" \t"), declared.size());
            const std::string_view text = declared.substr(0, end);
            declared.remove_prefix(end);
            return std::string(text);
        };
        parameter.type = word();
        parameter.name = word();
        if (parameter.name.empty() || !word().empty())
            fail("a parameter begins with its type and its name, as \"float radius\"");
        if (peek() == Kind::open) {
            take();
            for (Token token = take(); token.kind != Kind::close; token = take()) {
                if (token.kind == Kind::end) fail("a list of values has no end");
                take_value(token, parameter);
            }
        } else {
            take_value(take(), parameter);
        }
        statement.parameters.push_back(std::move(parameter));
    }
}

bool PbrtStatements::next(PbrtStatement& statement) {
    statement = {};
    statement.file = &file_;
    if (peek() == Kind::end) return false;
    statement.line = line_;
    const Token token = take();
    if (token.kind != Kind::word) fail("a statement begins with a word, such as Shape");
    const auto form =
        std::find_if(forms.begin(), forms.end(), [&](const Form& each) { return each.word == token.text; });
    if (form == forms.end())
        fail(fmt::format("\"{}\" is not a statement of pbrt: the file is damaged, or not a pbrt scene",
                         shown(token.text)));
    statement.word = form->word;
    statement.takes_parameters = form->parameters;
    const Kind wanted = form->word == "ActiveTransform" ? Kind::word : Kind::text;
    for (std::size_t i = 0; i < form->texts; ++i) {
        if (peek() != wanted) fail(fmt::format("{} needs a text", form->word));
        statement.texts.emplace_back(take().text);
    }
    if (form->word == "MediumInterface" && peek() == Kind::text) statement.texts.emplace_back(take().text);
    take_numbers(form->numbers, statement);
    if (form->parameters) take_parameters(statement);
    return true;
}

}  // namespace shadowbench::scene

// The statements of a scene in pbrt's text format (pbrt.org/fileformat-v4), checked for their form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::scene {

// "float radius" [ 2 ]: a type, a name, and values, which are numbers or texts. Booleans are the texts true and false.
struct PbrtParameter {
    std::string type, name;
    std::vector<double> numbers;
    std::vector<std::string> texts;
};

struct PbrtStatement {
    std::string_view word;  // "Shape"
    std::vector<std::string> texts;
    std::vector<double> numbers;
    std::vector<PbrtParameter> parameters;
    const std::string* file = nullptr;
    std::size_t line = 0;
    bool takes_parameters = false;

    // Null if there is none of this name.
    const PbrtParameter* find(std::string_view name) const;
    // The only value of a parameter. Throws if it has others.
    double number(std::string_view name, double otherwise) const;
    std::string text(std::string_view name, const std::string& otherwise) const;

    // Throws Error{bad_input} at the line.
    [[noreturn]] void fail(const std::string& message) const;
};

// The statements of one text. Throws Error{bad_input} with the line for a word that pbrt does not know, and for what
// follows it in another form than it must have. Numbers are finite.
class PbrtStatements {
public:
    // `file` names it in messages. Both must live as long as the statements.
    PbrtStatements(const std::string& file, std::string_view text) : file_(file), left_(text) {}

    // Replaces the statement by the next one; false at the end.
    bool next(PbrtStatement& statement);
    bool at_end() { return peek() == Kind::end; }
    // Adds the parameters that stand here, which may belong to the last statement of an included file.
    void take_parameters(PbrtStatement& statement);

private:
    enum class Kind { word, text, number, open, close, end };
    struct Token {
        Kind kind = Kind::end;
        std::string_view text;  // of a word, or of a text without its quotes
        double number = 0.0;
    };

    Token take();
    Token take_quoted();
    Token take_bare();
    void skip_space();
    Kind peek();
    void take_numbers(std::size_t count, PbrtStatement& statement);
    void take_value(const Token& token, PbrtParameter& parameter);
    [[noreturn]] void fail(const std::string& message) const;

    const std::string& file_;
    std::string_view left_;
    std::size_t line_ = 1;
};

}  // namespace shadowbench::scene

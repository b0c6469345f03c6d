// Parameters of techniques. Each technique declares its own as a list, which JSON, command lines, the schema and
// reports read.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace shadowbench::techniques {

enum class ParameterKind { number, integer, choice, number_or_word };

struct Parameter {
    const char* name;
    ParameterKind kind;
    const char* doc;
    double standard = 0.0;                // default; for choice and word kinds only if `standard_word` is empty
    double min = 0.0, max = 0.0;          // range of numbers, inclusive
    const char* standard_word = "";       // default word
    std::vector<const char*> words = {};  // choice: all values; number_or_word: the words besides numbers
};

// The complete values of one technique's parameters: every declared parameter has one. Asking for an unknown name or
// for the wrong kind is a fault of the program: Error{internal} that lists the names, or shows the value.
class ParameterValues {
public:
    using Value = std::variant<double, std::string>;

    double number(std::string_view name) const;  // number and integer kinds
    int integer(std::string_view name) const;
    const std::string& word(std::string_view name) const;  // choice kind
    bool is_word(std::string_view name) const;             // number_or_word kind
    const Value& at(std::string_view name) const;          // any kind

    std::map<std::string, Value, std::less<>> values;
};

// Reads a JSON object. Throws Error{bad_input}, place `where`/name, for an unknown name (the message lists the known
// ones), a wrong type, or a value out of range.
ParameterValues read_parameters(std::span<const Parameter> declared, const nlohmann::json& object,
                                const std::string& where);

// {"type": id, each parameter: its value}; and the draft-07 schema of that object.
nlohmann::json to_json(const ParameterValues& values);
nlohmann::json parameter_schema(const char* id, std::span<const Parameter> declared);

// "tolerance=0.02 filter=point": the values that differ from the defaults, or all.
std::string to_string(const ParameterValues& values, std::span<const Parameter> declared, bool all);

// Parameters that a text names whatever their values: some before all others, some in their places.
struct Named {
    std::vector<std::string> first, in_place;
};
// The values that differ from the defaults, and the named ones. Throws Error{internal} for an unknown name in `first`.
std::string to_string(const ParameterValues& values, std::span<const Parameter> declared, const Named& named);

}  // namespace shadowbench::techniques
